// Depth maps, surfaces and errors against what can be computed by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "reconstruction/desync_pattern.h"
#include "reconstruction/libraries/set_reconstruction.h"
#include "reconstruction/primitives.h"
#include "reconstruction/subject.h"
#include "tests/reconstruction/box.h"
#include "tests/reconstruction/studio_scenario.h"

namespace simbench::reconstruction {
namespace {

// Small images and wide point spacing: for quick tests.
scenarios::Scenario small_studio() {
  scenarios::Scenario scenario = studio_scenario();
  scenario.cameras.streams[0].width = 424;
  scenario.cameras.streams[0].height = 240;
  scenario.studio->point_spacing_mm = 10;
  scenario.studio->visibility_spread_px = 2;
  return scenario;
}

// Its cameras are ideal.
scenarios::Scenario ideal_studio() {
  scenarios::Scenario scenario = small_studio();
  scenarios::Studio& studio = *scenario.studio;
  studio.calibration_translation_sigma_mm = 0;
  studio.calibration_rotation_sigma_deg = 0;
  studio.subpixel_error_px = 0;
  studio.missing_share = 0;
  studio.max_incidence_deg = 89;
  return scenario;
}

std::unique_ptr<Subject> standing(TriangleMesh mesh, const scenarios::Scenario& scenario,
                                  float up_m) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += up_m;
  return make_rigid_subject(std::move(mesh), scenario.studio->subject, 1.0);
}

struct Outcome {
  TriangleMesh mesh;
  ErrorSummary errors;
};

Outcome reconstruct(const scenarios::Scenario& scenario, const Subject& subject,
                    double desync_ms = 0, std::uint64_t seed = 1) {
  SetReconstruction studio(scenario, subject, seed);
  ErrorStatistics errors;
  const auto surface =
      studio.reconstruct(desynchronised_set(scenario, seed, desync_ms, 0, 0), errors);
  return {surface ? surface->mesh : TriangleMesh{}, errors.summary()};
}

// The share of the vertices within `within_m` of a surface.
double share_within(const TriangleMesh& mesh, double within_m,
                    const std::function<double(const Eigen::Vector3d&)>& distance) {
  const auto near =
      std::count_if(mesh.vertices.begin(), mesh.vertices.end(), [&](const Eigen::Vector3f& vertex) {
        return std::abs(distance(vertex.cast<double>())) < within_m;
      });
  return static_cast<double>(near) / static_cast<double>(mesh.vertices.size());
}

TEST(SetReconstruction, AStillSphereComesBackAsThatSphere) {
  const scenarios::Scenario scenario = ideal_studio();
  const auto sphere = standing(make_sphere(0.4, 2e-4), scenario, 0.9F);
  const Outcome outcome = reconstruct(scenario, *sphere);
  ASSERT_FALSE(outcome.mesh.triangles.empty());
  // Poisson's cells are 3.4 mm: a cube of 0.88 m in 256.
  const auto distance = [](const Eigen::Vector3d& at) {
    return (at - Eigen::Vector3d(0, 0, 0.9)).norm() - 0.4;
  };
  EXPECT_GT(share_within(outcome.mesh, 0.003, distance), 0.99);
  EXPECT_LT(outcome.errors.median_cm, 0.5);  // half a pixel's width at 2 m
  EXPECT_LT(outcome.errors.mean_cm, 1.0);
}

TEST(SetReconstruction, AStillBoxComesBackAsThatBox) {
  const scenarios::Scenario scenario = ideal_studio();
  const Eigen::Vector3d sizes(0.5, 0.4, 0.6);
  const auto box = standing(make_box(sizes), scenario, 0.9F);
  const Outcome outcome = reconstruct(scenario, *box);
  ASSERT_FALSE(outcome.mesh.triangles.empty());
  const auto distance = [&](const Eigen::Vector3d& at) {
    const Eigen::Vector3d beyond = (at - Eigen::Vector3d(0, 0, 0.9)).cwiseAbs() - sizes / 2;
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
  };
  // Poisson rounds edges off, and no camera sees the bottom.
  EXPECT_GT(share_within(outcome.mesh, 0.005, distance), 0.80);
  EXPECT_LT(outcome.errors.median_cm, 0.5);
}

TEST(SetReconstruction, ErrorsGrowWithTheCalibrationError) {
  scenarios::Scenario scenario = ideal_studio();
  scenario.studio->heights_m = {0.9};
  scenario.cameras.count = 6;
  const auto sphere = standing(make_sphere(0.4, 1e-3), scenario, 0.9F);
  double before_cm = 0;
  for (const double sigma_mm : {0.0, 10.0, 30.0}) {
    scenario.studio->calibration_translation_sigma_mm = sigma_mm;
    const double mean_cm = reconstruct(scenario, *sphere).errors.mean_cm;
    EXPECT_GT(mean_cm, before_cm) << sigma_mm;
    before_cm = mean_cm;
  }
}

// The disparity noise of a flat wall is what its depth points are off by: E|N(0, s)| = 0.8 s.
TEST(SetReconstruction, ErrorsOfAWallWithNoiseAreTheNoise) {
  scenarios::Scenario scenario = ideal_studio();
  scenario.studio->azimuth_step_deg = 2;
  scenario.studio->heights_m = {0.9};
  scenario.cameras.count = 6;
  scenario.studio->subpixel_error_px = 0.08;
  const auto wall = standing(make_box({0.02, 1.2, 1.2}), scenario, 0.9F);
  const Outcome outcome = reconstruct(scenario, *wall);
  const double sigma_cm = 100 * 0.08 * 1.99 * 1.99 / (215 * 0.095);
  EXPECT_NEAR(outcome.errors.mean_cm, 0.8 * sigma_cm, 0.25 * sigma_cm);
}

// A plate that moves along x at v, seen from ahead by hosts that expose up to dt apart: wherever
// the surface comes to lie between the earliest and the latest plate, a camera's points are off by
// the distance from its own plate to that surface, so all together by no less than the mean
// distance of the plates from their median, and by no more than from an outermost one.
TEST(SetReconstruction, ErrorsOfAMovingPlateAreSpeedTimesDesynchronisation) {
  scenarios::Scenario scenario = ideal_studio();
  scenario.hosts.count = 2;
  scenario.cameras.count = 6;
  scenario.studio->azimuth_step_deg = 1;
  scenario.studio->heights_m = {0.9};
  scenario.studio->subject.motion = scenarios::MotionScript::kWalk;
  scenario.studio->subject.walk_speed_m_per_s = 1.0;
  TriangleMesh plate = make_box({0.02, 1.2, 1.2});
  const auto subject = standing(plate, scenario, 0.9F);
  const double still_cm = reconstruct(scenario, *subject, 0).errors.mean_cm;
  EXPECT_LT(still_cm, 0.47);  // half a pixel
  for (const double desync_ms : {30.0, 100.0}) {
    // Half of the cameras see it at -d/2, half at +d/2: their mean distance from any surface
    // between the two is d/2.
    const double d_cm = 100 * 1.0 * desync_ms * 1e-3;
    const double mean_cm = reconstruct(scenario, *subject, desync_ms).errors.mean_cm;
    EXPECT_NEAR(mean_cm, d_cm / 2, 0.1 * d_cm + still_cm) << desync_ms;
  }
}

TEST(SetReconstruction, GivesTheSameNumbersForTheSameSeedAndOthersForAnother) {
  scenarios::Scenario scenario = small_studio();
  scenario.studio->heights_m = {0.9};
  scenario.cameras.count = 6;
  const auto sphere = standing(make_sphere(0.4, 1e-3), scenario, 0.9F);
  const Outcome first = reconstruct(scenario, *sphere, 0, 1);
  const Outcome again = reconstruct(scenario, *sphere, 0, 1);
  const Outcome other = reconstruct(scenario, *sphere, 0, 2);
  EXPECT_EQ(first.errors.mean_cm, again.errors.mean_cm);
  EXPECT_EQ(first.errors.count, again.errors.count);
  EXPECT_NE(first.errors.mean_cm, other.errors.mean_cm);
}

TEST(SetReconstruction, DoesWithWhatThereIsWhenCamerasAreMissing) {
  scenarios::Scenario scenario = ideal_studio();
  const auto sphere = standing(make_sphere(0.4, 1e-3), scenario, 0.9F);
  SetReconstruction studio(scenario, *sphere, 1);
  evaluation::ExposureSet set = desynchronised_set(scenario, 1, 0, 0, 0);
  for (std::size_t camera = 0; camera < 18; ++camera) {
    if (camera % 3 != 1) set.cameras[camera].reset();
  }
  ErrorStatistics errors;
  EXPECT_TRUE(studio.reconstruct(set, errors).has_value());
  EXPECT_GT(errors.summary().count, 1000);
  for (auto& camera : set.cameras) camera.reset();
  ErrorStatistics none;
  EXPECT_FALSE(studio.reconstruct(set, none).has_value());
  EXPECT_EQ(none.summary().count, 0);
}

}  // namespace
}  // namespace simbench::reconstruction

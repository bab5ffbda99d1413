#include "reconstruction/studio.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/nonempty.h"
#include "tests/reconstruction/angles.h"
#include "tests/reconstruction/studio_scenario.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

std::vector<StudioCamera> cameras_of(const scenarios::Scenario& scenario, std::uint64_t seed) {
  return StudioRig(scenario, seed).cameras();
}

Vector2d pixel_of(const StudioCamera& camera, const Vector3d& point) {
  return camera.intrinsics.pixel_of(camera.world_from_camera.inverse() * point);
}

TEST(StudioRig, CamerasStandAtSixAnglesAndThreeHeights) {
  const StudioRig studio(studio_scenario(), 1);
  ASSERT_EQ(studio.cameras().size(), 18U);
  for (std::size_t j = 0; j < 18; ++j) {
    SCOPED_TRACE(j);
    const Vector3d position = studio.cameras()[j].world_from_camera.translation();
    const std::size_t angle = j / 3;
    const double azimuth = 60.0 * static_cast<double>(angle) * kDegree;
    EXPECT_NEAR(position.x(), 2 * std::cos(azimuth), 1e-12);
    EXPECT_NEAR(position.y(), 2 * std::sin(azimuth), 1e-12);
    EXPECT_DOUBLE_EQ(position.z(), 0.5 + 0.5 * static_cast<double>(j % 3));
  }
}

TEST(StudioRig, CamerasOfAHostShareAnAzimuth) {
  const scenarios::Scenario scenario = studio_scenario();
  const StudioRig studio(scenario, 1);
  const auto azimuth = [&](std::size_t j) {
    const Vector3d position = studio.cameras()[j].world_from_camera.translation();
    return std::atan2(position.y(), position.x());
  };
  for (std::size_t a = 0; a < 18; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const bool same_host = scenario.host_of(static_cast<std::int64_t>(a)) ==
                             scenario.host_of(static_cast<std::int64_t>(b));
      EXPECT_EQ(std::abs(azimuth(a) - azimuth(b)) < 1e-9, same_host) << a << " and " << b;
    }
  }
}

TEST(StudioRig, CamerasLookAtTheCentre) {
  for (const bool portrait : {false, true}) {
    scenarios::Scenario scenario = studio_scenario();
    scenario.studio->portrait = portrait;
    for (const StudioCamera& camera : nonempty(cameras_of(scenario, 1))) {
      const Vector3d centre(0, 0, 0.9);
      EXPECT_NEAR((pixel_of(camera, centre) - Vector2d(423.5, 239.5)).norm(), 0, 1e-9);
      const Vector3d seen = camera.world_from_camera.inverse() * centre;
      EXPECT_NEAR(seen.z(), std::hypot(2, camera.world_from_camera.translation().z() - 0.9), 1e-12);
      const Eigen::Matrix3d axes = camera.world_from_camera.linear();
      EXPECT_NEAR((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
      EXPECT_NEAR(axes.determinant(), 1, 1e-12);  // a mirror image would be -1
    }
  }
}

// What is above the centre is above it in the image, what is to the camera's right is to the right.
TEST(StudioRig, LandscapeIsUpright) {
  scenarios::Scenario scenario = studio_scenario();
  scenario.studio->portrait = false;
  for (const StudioCamera& camera : nonempty(cameras_of(scenario, 1))) {
    const Vector2d above = pixel_of(camera, {0, 0, 1.0});
    EXPECT_NEAR(above.x(), 423.5, 1e-9);
    EXPECT_LT(above.y(), 239.5 - 10);
    const Vector3d position = camera.world_from_camera.translation();
    const Vector3d right = Vector3d(-position.y(), position.x(), 0) * 0.05;  // facing the centre
    EXPECT_GT(pixel_of(camera, Vector3d(0, 0, 0.9) + right).x(), 423.5 + 10);
  }
}

TEST(StudioRig, PortraitHasTheVerticalAlongItsRows) {
  for (const StudioCamera& camera : nonempty(cameras_of(studio_scenario(), 1))) {
    const Vector2d above = pixel_of(camera, {0, 0, 1.0});
    EXPECT_NEAR(above.y(), 239.5, 1e-9);
    EXPECT_LT(above.x(), 423.5 - 10);
    const Vector3d position = camera.world_from_camera.translation();
    const Vector3d right = Vector3d(-position.y(), position.x(), 0) * 0.05;
    EXPECT_LT(pixel_of(camera, Vector3d(0, 0, 0.9) + right).y(), 239.5 - 10);
  }
}

// All of a standing person is in the image of every camera.
TEST(StudioRig, PortraitSeesAPersonFromHeadToFoot) {
  for (const StudioCamera& camera : nonempty(cameras_of(studio_scenario(), 1))) {
    for (const double height : {0.0, 1.75}) {
      const Vector2d pixel = pixel_of(camera, {0, 0, height});
      EXPECT_GT(pixel.x(), 0);
      EXPECT_LT(pixel.x(), 847);
    }
  }
}

TEST(StudioRig, IntrinsicsAreTheProfiles) {
  for (const StudioCamera& camera : nonempty(cameras_of(studio_scenario(), 1))) {
    EXPECT_EQ(camera.intrinsics.width, 848);
    EXPECT_EQ(camera.intrinsics.height, 480);
    EXPECT_EQ(camera.intrinsics.focal_px, 430);
    EXPECT_EQ(camera.intrinsics.centre_x_px, 423.5);
  }
  scenarios::Scenario small = studio_scenario();
  small.cameras.streams[0].width = 424;
  small.cameras.streams[0].height = 240;
  EXPECT_EQ(StudioRig(small, 1).cameras()[7].intrinsics.focal_px, 215);
  EXPECT_EQ(StudioRig(small, 1).cameras()[7].intrinsics.height, 240);
}

TEST(StudioRig, OtherStreamsDoNotMatter) {
  scenarios::Scenario scenario = studio_scenario();
  scenarios::Stream colour = scenario.cameras.streams[0];
  colour.kind = scenarios::StreamKind::kColour;
  colour.width = 1280;
  colour.height = 720;
  scenario.cameras.streams.insert(scenario.cameras.streams.begin(), colour);
  EXPECT_EQ(StudioRig(scenario, 1).cameras()[0].intrinsics.width, 848);
}

TEST(StudioRig, FewerCamerasThanPlaces) {
  scenarios::Scenario scenario = studio_scenario();
  scenario.cameras.count = 5;
  const StudioRig studio(scenario, 1);
  ASSERT_EQ(studio.cameras().size(), 5U);
  const StudioRig all(studio_scenario(), 1);
  for (std::size_t j = 0; j < 5; ++j) {  // and they are those that they were, errors and all
    EXPECT_TRUE(studio.cameras()[j].believed.isApprox(all.cameras()[j].believed, 0));
  }
}

// The errors of every camera and seed, in the camera's frame: three shifts in m, three angles in
// rad.
using Errors = std::vector<std::vector<double>>;
Errors calibration_errors(const scenarios::Scenario& scenario, std::uint64_t seeds) {
  Errors errors(6);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const StudioCamera& camera : cameras_of(scenario, seed)) {
      const Eigen::Isometry3d error = camera.world_from_camera.inverse() * camera.believed;
      const Eigen::AngleAxisd rotation(error.linear());
      for (int axis = 0; axis < 3; ++axis) {
        errors[static_cast<std::size_t>(axis)].push_back(error.translation()[axis]);
        errors[static_cast<std::size_t>(axis) + 3].push_back(rotation.angle() *
                                                             rotation.axis()[axis]);
      }
    }
  }
  return errors;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

// 7200 draws of each: a standard deviation is within 0.8 % (one sigma), a correlation within 0.012.
TEST(StudioRig, CalibrationErrorsHaveTheirSigmaAndAreIndependent) {
  const Errors errors = calibration_errors(studio_scenario(), 400);
  const auto sigma = [](std::size_t i) { return i < 3 ? 0.010 : 0.29 * kDegree; };
  for (std::size_t i = 0; i < errors.size(); ++i) {
    SCOPED_TRACE(i);
    const std::vector<double> ones(errors[i].size(), 1.0);
    EXPECT_NEAR(mean_product(errors[i], ones) / sigma(i), 0, 0.05);
    EXPECT_NEAR(std::sqrt(mean_product(errors[i], errors[i])) / sigma(i), 1, 0.035);
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_NEAR(mean_product(errors[i], errors[k]) / (sigma(i) * sigma(k)), 0, 0.05) << k;
    }
    // From one camera to the next, and from one seed to the next.
    for (const std::ptrdiff_t lag : {1, 18}) {
      const std::vector<double> earlier(errors[i].begin(), errors[i].end() - lag);
      const std::vector<double> later(errors[i].begin() + lag, errors[i].end());
      EXPECT_NEAR(mean_product(earlier, later) / (sigma(i) * sigma(i)), 0, 0.05) << lag;
    }
  }
}

TEST(StudioRig, WithoutSigmaTheCalibrationIsRight) {
  scenarios::Scenario scenario = studio_scenario();
  scenario.studio->calibration_translation_sigma_mm = 0;
  scenario.studio->calibration_rotation_sigma_deg = 0;
  for (const StudioCamera& camera : nonempty(cameras_of(scenario, 1))) {
    EXPECT_TRUE(camera.believed.isApprox(camera.world_from_camera, 0));
  }
}

// Errors of one kind are the same whatever the sigma of the other: all draws are always made.
TEST(StudioRig, SigmasDoNotMoveEachOthersDraws) {
  const scenarios::Scenario both = studio_scenario();
  scenarios::Scenario moved = both;
  moved.studio->calibration_rotation_sigma_deg = 0;
  scenarios::Scenario rotated = both;
  rotated.studio->calibration_translation_sigma_mm = 0;
  for (std::size_t j = 0; j < 18; ++j) {
    const Eigen::Isometry3d believed = StudioRig(both, 3).cameras()[j].believed;
    EXPECT_TRUE(StudioRig(moved, 3).cameras()[j].believed.translation().isApprox(
        believed.translation(), 1e-15));
    EXPECT_TRUE(
        StudioRig(rotated, 3).cameras()[j].believed.linear().isApprox(believed.linear(), 1e-15));
  }
}

TEST(StudioRig, TheSameSeedIsTheSameStudio) {
  const StudioRig once(studio_scenario(), 5);
  const StudioRig again(studio_scenario(), 5);
  const StudioRig other(studio_scenario(), 6);
  for (std::size_t j = 0; j < 18; ++j) {
    EXPECT_TRUE(once.cameras()[j].believed.isApprox(again.cameras()[j].believed, 0));
    EXPECT_FALSE(once.cameras()[j].believed.isApprox(other.cameras()[j].believed, 1e-6));
    EXPECT_TRUE(
        once.cameras()[j].world_from_camera.isApprox(other.cameras()[j].world_from_camera, 0));
  }
}

TEST(StudioRig, AScenarioWithoutOneIsRefused) {
  scenarios::Scenario scenario = studio_scenario();
  scenario.studio.reset();
  EXPECT_THAT([&] { const StudioRig studio(scenario, 1); },
              testing::ThrowsMessage<scenarios::InputError>(
                  AllOf(HasSubstr("/studio"), HasSubstr("18cam_6host_30fps_studio"))));
}

}  // namespace
}  // namespace simbench::reconstruction

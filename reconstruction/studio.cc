#include "reconstruction/studio.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "algorithms/ports/assert.h"
#include "scenarios/camera_profile.h"
#include "scenarios/loader.h"
#include "sim/engine/random.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using scenarios::StreamKind;

constexpr double kRadPerDegree = std::numbers::pi / 180;

// A scenario with a studio was loaded only if its depth images have a focal length.
Pinhole depth_camera(const scenarios::Scenario& scenario) {
  const scenarios::Stream* depth = scenario.cameras.stream(StreamKind::kDepth);
  const scenarios::CameraProfile* model = scenarios::find_camera_profile(scenario.cameras.model);
  SIMBENCH_ASSERT(depth != nullptr && model != nullptr, "a studio has depth cameras");
  const double focal_px =
      model->stream(StreamKind::kDepth)->find_size(depth->width, depth->height)->focal_px;
  return centred_pinhole(static_cast<int>(depth->width), static_cast<int>(depth->height), focal_px);
}

// From `position` towards the point `target`, upright or rolled.
Isometry3d looking_at(const Vector3d& position, const Vector3d& target, bool portrait) {
  const Vector3d ahead = (target - position).normalized();
  const Vector3d right = ahead.cross(Vector3d::UnitZ()).normalized();
  const Vector3d down = ahead.cross(right);
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() << (portrait ? down : right), (portrait ? Vector3d(-right) : down), ahead;
  pose.translation() = position;
  return pose;
}

// The error of a calibration, in the camera's frame.
Isometry3d calibration_error(const scenarios::Studio& studio, std::uint64_t seed,
                             std::size_t camera) {
  static constexpr sim::ComponentKey kCalibration("studio calibration");
  sim::RandomStream draws(seed, kCalibration, camera);
  Vector3d moved;
  Vector3d rotated;
  for (double& component : moved) {
    component = draws.normal(studio.calibration_translation_sigma_mm) * 1e-3;
  }
  for (double& component : rotated) {
    component = draws.normal(studio.calibration_rotation_sigma_deg) * kRadPerDegree;
  }
  const double angle = rotated.norm();
  const Vector3d axis = angle > 0 ? Vector3d(rotated / angle) : Vector3d::UnitX();
  return Eigen::Translation3d(moved) * Eigen::AngleAxisd(angle, axis);
}

}  // namespace

StudioRig::StudioRig(const scenarios::Scenario& scenario, std::uint64_t seed) {
  if (!scenario.studio) {
    fail_at(scenario, "/studio",
            "found none, allowed: an object that states where the depth cameras stand and what "
            "they look at; 18cam_6host_30fps_studio has one");
  }
  const scenarios::Studio& studio = *scenario.studio;
  const Pinhole intrinsics = depth_camera(scenario);
  const std::size_t heights = studio.heights_m.size();
  for (std::size_t j = 0; j < static_cast<std::size_t>(scenario.cameras.count); ++j) {
    const std::size_t angle = j / heights;
    const double azimuth = studio.azimuth_step_deg * static_cast<double>(angle) * kRadPerDegree;
    const Vector3d position(studio.radius_m * std::cos(azimuth),
                            studio.radius_m * std::sin(azimuth), studio.heights_m[j % heights]);
    const Isometry3d pose = looking_at(position, {0, 0, studio.look_at_height_m}, studio.portrait);
    cameras_.push_back({intrinsics, pose, pose * calibration_error(studio, seed, j)});
  }
}

}  // namespace simbench::reconstruction

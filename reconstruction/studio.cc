#include "reconstruction/studio.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "scenarios/camera_profile.h"
#include "scenarios/loader.h"
#include "sim/engine/random.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using scenarios::StreamKind;

constexpr double kRadPerDegree = std::numbers::pi / 180;

// The focal length of this size of depth image by the camera model's profile; 0: unknown.
double known_focal_px(const std::string& model, const scenarios::Stream& stream) {
  const scenarios::CameraProfile* profile = scenarios::find_camera_profile(model);
  const scenarios::StreamProfile* depth =
      profile != nullptr ? profile->stream(StreamKind::kDepth) : nullptr;
  const scenarios::ImageSize* size =
      depth != nullptr ? depth->find_size(stream.width, stream.height) : nullptr;
  return size != nullptr ? size->focal_px : 0;
}

Pinhole depth_camera(const scenarios::Scenario& scenario) {
  const auto& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const scenarios::Stream& stream = streams[i];
    if (stream.kind != StreamKind::kDepth) continue;
    const double focal_px = known_focal_px(scenario.cameras.model, stream);
    if (focal_px > 0) {
      return centred_pinhole(static_cast<int>(stream.width), static_cast<int>(stream.height),
                             focal_px);
    }
    fail_at(scenario, fmt::format("/cameras/streams/{}", i),
            fmt::format("found depth of {}x{} by {}, whose focal length is not known; the profile "
                        "of a camera model (simbench list cameras) states it as focal_px of a size",
                        stream.width, stream.height, scenario.cameras.model));
  }
  fail_at(scenario, "/cameras/streams", "found no depth stream, which the studio's cameras need");
}

void check_room(const scenarios::Scenario& scenario, const scenarios::Studio& studio) {
  const auto heights = static_cast<std::int64_t>(studio.heights_m.size());
  const auto angles = static_cast<std::int64_t>(std::floor(360 / studio.azimuth_step_deg + 1e-9));
  if (scenario.cameras.count <= angles * heights) return;
  fail_at(scenario, "/cameras/count",
          fmt::format("found {}, allowed at most {} in this studio: {} angles (every {} degrees) "
                      "x {} heights",
                      scenario.cameras.count, angles * heights, angles, studio.azimuth_step_deg,
                      heights));
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

Studio::Studio(const scenarios::Scenario& scenario, std::uint64_t seed) {
  if (!scenario.studio) {
    fail_at(scenario, "/studio",
            "found none, allowed: an object that states where the depth cameras stand and what "
            "they look at; 18cam_6host_30fps_studio has one");
  }
  const scenarios::Studio& studio = *scenario.studio;
  const Pinhole intrinsics = depth_camera(scenario);
  check_room(scenario, studio);
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

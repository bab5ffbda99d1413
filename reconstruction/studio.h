// The studio: the true and the believed poses of the depth cameras, and their intrinsics.
//
// Cameras stand on a circle of `radius_m` about the vertical through the origin and look at the
// point at `look_at_height_m` on it. Camera j has the azimuth j / heights and the height j %
// heights: the cameras of a host share an azimuth if there are as many heights as cameras per host.
// Azimuths run counter-clockwise seen from above, beginning on the x axis. Pixels: the scenario's
// depth stream, with the focal length of the camera model's profile. In portrait the camera is
// rolled by 90 degrees so that its image's x axis points down (in landscape y does); its image
// keeps its size.
//
// Calibration: the believed pose is the true one, moved by N(calibration_translation_sigma_mm) per
// axis and rotated by N(calibration_rotation_sigma_deg) about each axis of the camera, drawn once
// per (seed, camera). The user's reconstruction knows believed poses only.
//
// Throws scenarios::InputError if the scenario has no studio. A loaded scenario with one has a
// depth stream of known focal length, and room for its cameras.
//
// Source: section 4 of the paper (6 angles, 3 heights), docs/reference/calibration.md section 6.
//
//   const StudioRig studio(scenario, seed);          // throws scenarios::InputError
//   studio.cameras()[3].world_from_camera;
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "reconstruction/depth_map.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

struct StudioCamera {
  Pinhole intrinsics;
  Eigen::Isometry3d world_from_camera;  // true
  Eigen::Isometry3d believed;           // as calibrated
};

class StudioRig {
 public:
  StudioRig(const scenarios::Scenario& scenario, std::uint64_t seed);
  const std::vector<StudioCamera>& cameras() const { return cameras_; }

 private:
  std::vector<StudioCamera> cameras_;
};

}  // namespace simbench::reconstruction

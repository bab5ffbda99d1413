// The noise of a stereo depth camera: it grows with the square of the distance, and some pixels
// have no value.
//
// A disparity error of s pixels (subpixel_error_px, standard deviation) is a depth error of
//
//   sigma(z) = s * z^2 / (f * B)
//
// with the focal length f in pixels and the baseline B (stereo_baseline_mm). For a D455 at 848x480
// (f = 430, B = 95 mm, s = 0.08) it is 0.00196 z^2: 8 mm at 2 m. A pixel is missing where the
// surface is nearer than min_distance_m or farther than max_distance_m, met at more than
// max_incidence_deg, or by chance (missing_share), or where the error would put it at or behind the
// camera. Pixels are independent of each other, although real stereo noise is correlated over its
// matching window.
//
//   const DepthMap depth = measured_depth(seen, studio, focal_px, {seed, camera, frame});
//
// Draws depend on (seed, camera, frame) only, so one frame looks the same to every pipeline.
//
// Source: docs/reference/calibration.md section 6; the law: triangulation (z = f B / disparity).
#pragma once

#include <cstdint>

#include "reconstruction/depth_map.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

struct NoiseKey {
  std::uint64_t seed = 1;
  std::uint32_t camera = 0;
  std::int64_t frame = 0;
};

DepthMap measured_depth(const SeenDepth& seen, const scenarios::Studio& studio, double focal_px,
                        const NoiseKey& key);

}  // namespace simbench::reconstruction

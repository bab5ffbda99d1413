#include "reconstruction/depth_noise.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "sim/engine/random.h"

namespace simbench::reconstruction {

// Every pixel that sees something draws, also a missing one, so that limits change no other pixel.
DepthMap measured_depth(const SeenDepth& seen, const scenarios::Studio& studio, double focal_px,
                        const NoiseKey& key) {
  static constexpr sim::ComponentKey kDepthNoise("depth noise");
  sim::RandomStream draws(key.seed, kDepthNoise, key.camera, static_cast<std::uint64_t>(key.frame));
  boost::random::normal_distribution<double> standard_normal;
  // The factor of z^2, in metres for z in metres.
  const double factor = studio.subpixel_error_px / (focal_px * studio.stereo_baseline_mm * 1e-3);
  const double least_cos = std::cos(studio.max_incidence_deg * std::numbers::pi / 180);
  DepthMap measured(seen.depth.width, seen.depth.height);
  for (std::size_t i = 0; i < seen.depth.depth_m.size(); ++i) {
    const double depth = seen.depth.depth_m[i];
    if (!(depth > 0)) continue;
    const double noise = standard_normal(draws) * factor * depth * depth;
    const bool missing_by_chance = draws.chance(studio.missing_share);
    if (missing_by_chance || depth < studio.min_distance_m || depth > studio.max_distance_m ||
        seen.cos_incidence[i] < least_cos || depth + noise <= 0) {
      continue;
    }
    measured.depth_m[i] = static_cast<float>(depth + noise);
  }
  return measured;
}

}  // namespace simbench::reconstruction

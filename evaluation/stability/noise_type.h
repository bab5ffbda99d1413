// The power-law noise that a series of time errors shows at an averaging time. The spectrum of the
// fractional frequency goes with f^alpha:
//
//   id               alpha   noise
//   white_pm             2   white phase: time stamps with independent errors
//   flicker_pm           1   flicker phase
//   white_fm             0   white frequency: the phase is a random walk
//   flicker_fm          -1   flicker frequency
//   random_walk_fm      -2   the frequency is a random walk
//
// Method: the phase at every m-th point is differenced until its correlation with the next one, r,
// shows a stationary noise: delta = r / (1 + r) < 0.25, or twice at most. With d differences its
// power law is alpha = 2 - 2 (delta + d), to the nearest whole number. A constant offset, an offset
// of the frequency and its linear drift do not disturb this, since differences take them away.
//
// Over gaps: neighbours of all pieces count together, about the mean of all pieces, and none
// reaches over a gap: r = 2 sum(z_i z_(i+1)) / sum(z_i^2 + z_(i+1)^2), which lies from -1 to 1 also
// where pieces are short. Fewer than kFewestNoisePairs neighbours tell nothing.
//
// Complexity: O(N / m). Memory: N / m numbers.
//
// Sources: W. J. Riley and C. A. Greenhall, "Power law noise identification using the lag 1
// autocorrelation", EFTF 2004; W. J. Riley, NIST SP 1065, 2008, section 5.5.
//
//   TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = {0, 1e-6, 3e-6}}}};
//   const std::optional<NoiseType> noise = noise_type_at(series, 4);
//   const auto types = noise_types_over_octaves(series, 10);   // at m = 1, 2, 4 ... 512
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/stability/time_error.h"

namespace simbench::evaluation {

enum class NoiseType : std::int8_t {
  kRandomWalkFm = -2,
  kFlickerFm = -1,
  kWhiteFm = 0,
  kFlickerPm = 1,
  kWhitePm = 2
};

// "white_pm" and so on, as above.
const char* noise_id(NoiseType noise);

inline constexpr std::int64_t kFewestNoisePairs = 30;

// At m intervals, m >= 1. Nothing where too few points are left, or none differ.
std::optional<NoiseType> noise_type_at(const TimeErrorSeries& series, std::int64_t m);

// At m = 1, 2, 4 ..., so many of them: where there are too few points, the type at the nearest
// shorter time; nothing if that has none.
std::vector<std::optional<NoiseType>> noise_types_over_octaves(const TimeErrorSeries& series,
                                                               std::size_t octaves);

}  // namespace simbench::evaluation

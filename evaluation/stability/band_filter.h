// Time errors behind the first-order filters of 0.1 Hz by which Recommendation ITU-T G.8273.2
// divides the dynamic time error: below it dTE_L, above it dTE_H.
//
// The low-pass is the bilinear image of 1 / (1 + s / w), warped so that 0.1 Hz is passed with
// 1 / sqrt(2); the high-pass is what it leaves. Each piece is filtered by itself: the filter begins
// as if its first point had always been, and kSettlingS (five time constants) of points are left
// out until that is forgotten. Points that are more than kLongestFilteredS apart have no band above
// 0.1 Hz that could be told.
//
// A low-pass only averages: MTIE, TDEV and the largest error behind it are at most what they are
// before it. Behind the high-pass a swing may be up to twice as large.
//
// Complexity: O(N).
//
//   TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0, .x_s = {0, 1e-6, 3e-6}}}};
//   const std::optional<TimeErrorSeries> low = filtered(series, Band::kLow);
#pragma once

#include <cstdint>
#include <optional>

#include "evaluation/stability/time_error.h"

namespace simbench::evaluation {

enum class Band : std::uint8_t { kAll, kLow, kHigh };

inline constexpr double kBandEdgeHz = 0.1;
inline constexpr double kLongestFilteredS = 2.5;
inline constexpr double kSettlingS = 8;

// kAll: the series itself. Nothing if its points are too far apart. Pieces that are shorter than
// the settling are left out.
std::optional<TimeErrorSeries> filtered(const TimeErrorSeries& series, Band band);

}  // namespace simbench::evaluation

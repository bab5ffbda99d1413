#include "evaluation/stability/band_filter.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace simbench::evaluation {
namespace {

std::vector<double> low_passed(std::span<const double> x, double warped_edge) {
  std::vector<double> low;
  double state = 0;
  double before = 0;
  for (const double value : x) {
    if (low.empty()) {
      state = before = value;
    } else {
      // About the point before, so that an offset of the clock costs no digits.
      state += warped_edge * ((value - state) + (before - state)) / (1 + warped_edge);
      before = value;
    }
    low.push_back(state);
  }
  return low;
}

}  // namespace

std::optional<TimeErrorSeries> filtered(const TimeErrorSeries& series, Band band) {
  check_series(series);
  if (band == Band::kAll) return series;
  if (series.interval_s > kLongestFilteredS) return std::nullopt;
  const double warped_edge = std::tan(std::numbers::pi * kBandEdgeHz * series.interval_s);
  const auto settling = static_cast<std::size_t>(std::ceil(kSettlingS / series.interval_s));
  TimeErrorSeries passed{.interval_s = series.interval_s};
  for (const TimeErrorPiece& piece : series.pieces) {
    if (piece.x_s.size() <= settling) continue;
    std::vector<double> low = low_passed(piece.x_s, warped_edge);
    if (band == Band::kHigh) {
      for (std::size_t i = 0; i < low.size(); ++i) low[i] = piece.x_s[i] - low[i];
    }
    low.erase(low.begin(), low.begin() + static_cast<std::ptrdiff_t>(settling));
    passed.pieces.push_back(
        {.start_s = piece.start_s + static_cast<double>(settling) * series.interval_s,
         .x_s = std::move(low)});
  }
  return passed;
}

}  // namespace simbench::evaluation

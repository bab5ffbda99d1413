// A picture as small as a word, in a cell of a table: how values are distributed, or how they go.
//
// It belongs to a number in the same cell and adds its shape; only HTML shows it. A distribution is
// a stroke for each value, the median longer; a series is a line. Each is drawn on its own linear
// scale, so rows compare by their numbers, not by their pictures. `words` say the same to who does
// not see it.
//
//   const Sparkline amd = seeds_sparkline(row.amd_ms);
//   cell += svg(amd);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

struct Sparkline {
  enum class Kind : std::uint8_t { kDistribution, kSeries };
  Kind kind = Kind::kDistribution;
  std::vector<double> values{};  // NaN: none, left out
  std::string words{};
};

// The values by seed, of milliseconds: "12 seeds from 1.52 ms to 2.81 ms, median 2.25 ms".
Sparkline seeds_sparkline(const evaluation::Series& series_ms);

// An inline SVG; "" of fewer than three values, whose shape the numbers say. O(n log n).
std::string svg(const Sparkline& sparkline);

}  // namespace simbench::reports

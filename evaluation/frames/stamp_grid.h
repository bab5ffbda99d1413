// The even grid that the stamps of a stream lie on: its period, the point of each frame, and where
// the grid itself moves.
//
// A camera exposes on a grid. A frame that is lost, skipped or dropped by a reader leaves its point
// empty, so that the mean interval says how many frames came, and not which grid they are of. The
// period is therefore the longest one of which nearly all intervals are whole multiples: that of
// the median interval, or a whole fraction of it (down to a quarter) that occurs among the
// intervals, where too few of them fit that, or a period that is given: that of other cameras of
// the rig.
//
// Points follow from the intervals where most of these are whole periods. Stamps that scatter more
// than that (of a program, with the jitter of its arrivals) are placed by the median phase of the
// frames before them, so that no two errors add up.
//
// There is no grid where few intervals are whole periods and none takes back what the one before
// was longer: jitter about a grid has a correlation of -0.5 from one interval to the next,
// intervals that vary by themselves (automatic exposure, no trigger) have none.
//
// A step is a lasting move of the grid by less than a whole period: what comes after lies between
// the points of what came before. It counts from a twentieth of a period on, from kStepSigmas times
// the scatter, and from six times what the phase usually moves within some frames.
//
//   const std::optional<StampGrid> grid = stamp_grid(unwrapped(recorded.streams[0].frames));
//   if (grid) print(grid->period_ms, grid->points.back());
//
// Errors: nothing if the stamps do not advance. Complexity: O(n log n).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kStepSigmas = 3;
inline constexpr double kMostOnGrid = 0.9;  // of the intervals: a grid that is shown

struct GridStep {
  std::size_t frame = 0;  // the first one after it
  double step_ms = 0;     // positive: later than the grid before; within half a period
};

struct StampGrid {
  double period_ms = 0;              // by the stamps' own clock
  bool exists = true;                // else intervals vary by themselves: no point is empty
  std::vector<std::int64_t> points;  // of each frame, from 0 on
  // Deviations of the intervals from whole periods: their standard deviation, that of one stamp by
  // their median (which outliers leave alone), and the share of the intervals that deviate by less
  // than a tenth of a period.
  double interval_jitter_ms = 0;
  double scatter_ms = 0;
  double on_grid_share = 0;
  std::vector<std::int64_t> missing;  // empty points before each frame, since the one before it
  std::vector<GridStep> steps;
};

// Frames in order of delivery, stamps unwrapped (camera_statistics.h). `other_period_ms`: of
// cameras that may have the same grid, by a clock within 2000 ppm of this one.
std::optional<StampGrid> stamp_grid(std::span<const StampedFrame> frames,
                                    std::optional<double> other_period_ms = {});

}  // namespace simbench::evaluation

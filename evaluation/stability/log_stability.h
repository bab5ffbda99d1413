// The stability of a measured clock: a log on an even grid, and what evaluation/stability/
// stability.h says of it.
//
// The interval is the median distance of neighbouring points, or the one that is stated. From the
// last point taken, the next one is that which comes one interval later, to within kGridShare of
// it; points that come earlier are left out, and where none comes there is a gap: a new piece
// begins with the next point. Pauses and other polling intervals thus separate pieces, and nothing
// is interpolated or moved. The interval of the result is the mean distance of neighbours within
// the pieces.
//
// Errors: scenarios::InputError for a log of a single point. Complexity: O(N log N).
//
//   const LogStability found = stability_of_log(read_clock_log("tracking.log"), {});
//   const double worst_ms = found.stability.time_error.max_te_ms;
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/stability/clock_log.h"
#include "evaluation/stability/stability.h"

namespace simbench::evaluation {

inline constexpr double kGridShare = 0.2;

struct EvenSeries {
  TimeErrorSeries series{};  // times since the first point
  std::int64_t left_out = 0;
  double longest_gap_s = 0;  // between the points on either side; 0 without a gap
};
// `points`: at least two, in order of time.
EvenSeries evenly_spaced(const std::vector<ClockLogPoint>& points,
                         std::optional<double> interval_s);

struct LogStabilityOptions {
  std::optional<double> interval_s{};
  bool remove_frequency = false;
};

struct LogStability {
  std::string file{};
  std::string format{};
  double first_s = 0;                        // when the first point is, on the log's own scale
  std::int64_t left_out = 0;                 // points between those of the grid
  double longest_gap_s = 0;                  // the number of gaps: pieces - 1
  std::optional<double> frequency_offset{};  // without a unit; if it was removed
  Stability stability{};                     // times of steps: since the first point
  std::vector<std::string> notes{};          // "FILE: ..."
};
LogStability stability_of_log(const ClockLog& log, const LogStabilityOptions& options);

}  // namespace simbench::evaluation

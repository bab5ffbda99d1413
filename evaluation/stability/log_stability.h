// The stability of a measured clock: a log on an even grid, and what evaluation/stability/
// stability.h says of it.
//
// All points count in the time error: its size, percentiles and steps. Deviations need even
// intervals. The interval is the median distance of neighbouring points, or the one that is stated.
// From the last point taken, the next one is that which comes one interval later, to within
// kGridShare of it and nearest to that; others are left out of the deviations, and where none comes
// there is a gap: a new piece begins with the next point. Pauses thus separate pieces, and nothing
// is interpolated or moved. Points of one time count as their mean. The interval of the result is
// the mean distance of neighbours within the pieces.
//
// Where fewer than kEvenShare of the neighbours are one interval apart and none is stated, the log
// is uneven, and a note says how it was taken: distances that vary (a poll with jitter) to within
// kUnevenShare of the interval, as if they were even; of distances that differ by octaves (a poll
// that grows), where another covers twice as much of the log as the median, the shortest one that
// covers nearly as much as any.
//
// The start of a log often is one of a clock that is not set yet. The first points are such a start
// if they lie farther than kStartScatters times the scatter of the second half from its median,
// until kSettledPoints in order do not. The result says how it is with and without.
//
// A log of summaries has no signs: only the largest and the RMS time error exist, and no start is
// found.
//
// Errors: scenarios::InputError for a log of a single point, or none in the asked time. Complexity:
// O(N log N).
//
//   const LogStability found = stability_of_log(read_clock_log("tracking.log"), {});
//   const double worst_ms = found.stability.time_error.max_te_ms;
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/stability/clock_log.h"
#include "evaluation/stability/stability.h"

namespace simbench::evaluation {

inline constexpr double kGridShare = 0.2;
inline constexpr double kUnevenShare = 0.5;
inline constexpr double kEvenShare = 0.8;
inline constexpr double kStartScatters = 10;
inline constexpr std::size_t kSettledPoints = 10;

// A stretch of a log: points in order of time, with the begins of the segments behind the first.
struct LogPoints {
  std::vector<ClockLogPoint> points{};
  std::vector<std::size_t> segments{};
};

struct EvenSeries {
  TimeErrorSeries series{};  // times since the first point
  std::int64_t left_out = 0;
  std::int64_t neighbours = 0;  // pairs that are one interval apart
  double longest_gap_s = 0;     // between the points on either side; 0 without a gap
};
// `log`: at least two points of different times. `share`: of the interval, how far a neighbour may
// be off.
EvenSeries evenly_spaced(const LogPoints& log, std::optional<double> interval_s,
                         double share = kGridShare);

// A time in a log: seconds since its first point, where a restart takes as long as points are
// apart, or on its own scale.
struct LogTime {
  double time_s = 0;
  bool since_first = true;
};

struct LogStabilityOptions {
  std::optional<double> interval_s{};
  bool remove_frequency = false;
  std::optional<LogTime> from{};
  std::optional<LogTime> until{};
  bool settle = false;  // without the start
};

// The first points, of a clock that was not set yet.
struct LogStart {
  std::int64_t points = 0;
  double until_s = 0;  // since the first point: when the first settled one is
  double largest_ms = 0;
  TimeErrorSummary settled{};  // without them
};

struct LogStability {
  std::string file{};
  std::string format{};
  std::string series{};                      // of a file that has several
  double first_s = 0;                        // when the first point is, on the log's own scale
  std::int64_t samples = 0;                  // all points; `stability` has those of the grid
  std::int64_t left_out = 0;                 // points between those of the grid
  double longest_gap_s = 0;                  // the number of gaps: pieces - 1
  std::optional<double> frequency_offset{};  // without a unit; if it was removed
  bool are_summaries = false;                // only the largest and the RMS time error exist
  std::optional<LogStart> start{};           // if there is one, left out or not
  bool settled = false;                      // it was left out
  Stability stability{};                     // times of steps: since the first point
  std::vector<std::string> notes{};          // "FILE: ..."
};
LogStability stability_of_log(ClockLog log, const LogStabilityOptions& options);

}  // namespace simbench::evaluation

// The clock of a host as its log has it, on the time scale of the recording's arrivals.
//
// Logs count from 1970 or from a boot (ptp4l[5374018.735]), arrivals from 1970, a boot or a zero of
// their own. A log from a boot whose lines have dates (ClockLog::boots) counts from 1970 by these.
// A log is placed, in this order:
// - as it is, where both count from 1970 or neither does, and they overlap;
// - by a time zone, where both count from 1970: the shift by a zone in use that brings the overlap;
//  of several, the one that puts most steps of the log on jumps of the arrivals, then the longest
//  overlap, then the smallest shift. It also replaces an overlap if it matches more steps;
// - by its steps: the shift that puts most of them on jumps of equal size, if there is one such
//  (of the 30 largest steps and jumps);
// - nowhere.
//
// A log whose times jump by an hour, forth or back, between points that otherwise are evenly spaced
// is in local time across a change of daylight saving: its later part is moved by that hour. A log
// of up to an hour before the change loses this trace, since the reader sorts its parts.
//
// A log from the boot that has several parts is of several boots: the part that overlaps most is
// taken, or the last one.
//
// Complexity: O(n log n) in the points, times the number of zones.
//
//   const TimeRange arrivals = {.first_s = 1.7e9, .last_s = 1.7e9 + 60};
//   LoggedClock clock = logged_clock({.log = read_clock_log("tracking.log")}, arrivals);
//   place(clock, arrivals, jumps);
//   const double ahead_s = clock.error_at(arrivals.first_s);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/diagnosis/camera_delays.h"
#include "evaluation/stability/clock_log.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

// A log, and whose clock it is.
struct HostLog {
  std::string host{};  // empty: not said
  ClockLog log{};
};

enum class LogPlacing : std::uint8_t { kNowhere, kAsIs, kByZone, kBySteps };

// A step of the clock between two points, or a slew over several.
//
// A difference of neighbouring points is large if it is beyond ten robust deviations of all of them
// and 10 us. One or two large ones in a row are a step; three or more of one sign, at a rate of
// more than 200 ppm, which no crystal has, are a slew. Gaps have neither.
struct LoggedChange {
  double at_s = 0;     // the last point before it
  double until_s = 0;  // the first one behind it
  double by_s = 0;
  double before_s = 0;  // the errors there
  double after_s = 0;
  bool is_slew = false;
  bool lasts = false;  // more than half of it is there in the median of the next three points
  bool away = false;   // the error is larger behind it: no servo does that
};

// A step of the log that the arrivals show, which tell its time better than two points of the log.
struct SeenStep {
  std::size_t change = 0;  // in LoggedClock::changes
  double at_s = 0;         // the last arrival before it
};

// Times in a log that jump by an hour while it goes on.
struct DaylightSaving {
  double at_s = 0;  // on the log's own scale, the last point before it
  double by_s = 0;  // 3600 or -3600
};

struct LoggedClock {
  std::string host{};  // whose cameras it is for, if there is such a one
  bool has_host = false;
  std::string said_host{};  // HostLog::host
  std::string file{};
  std::string series{};
  std::string format{};
  LogPlacing placing = LogPlacing::kNowhere;
  double shift_s = 0;            // what was added to the log's times
  bool other_zones_fit = false;  // as well as the one that was taken
  bool from_1970 = false;        // the log's times
  bool are_summaries = false;    // root mean squares without a sign: only within_s is of use
  std::optional<DaylightSaving> daylight_saving{};
  std::vector<double> time_s{};   // ascending, of the arrivals' scale once it is placed
  std::vector<double> error_s{};  // positive: ahead
  std::vector<double> largest_s{};
  std::vector<LoggedChange> changes{};
  std::vector<SeenStep> seen{};  // filled in by who matches them
  double large_s = kNan;         // a difference of neighbours is large beyond that
  double interval_s = kNan;      // the median distance of points

  bool is_placed() const { return placing != LogPlacing::kNowhere; }
  double first_s() const { return time_s.front(); }
  double last_s() const { return time_s.back(); }
  // Between the points on either side; about a step that was seen, as before or behind it. NaN
  // outside, in gaps of more than five intervals, of summaries, and for times that a clock which
  // was set back had twice.
  double error_at(double at_s) const;
  // The error about a step that was seen; nothing at other times.
  std::optional<double> error_beside_step(double at_s) const;
  // The largest error from the one time to the other, or over the whole log if it is not placed;
  // NaN without a point there.
  double within_s(double begin_s, double end_s) const;
};

struct TimeRange {
  double first_s = kNan;
  double last_s = kNan;
};

// Whether times so large count from 1970 rather than from a boot: 20 years and more.
bool is_from_1970(double time_s);

// Not placed yet. `of_arrivals`: those of the cameras on the host, for a log of several boots.
LoggedClock logged_clock(const HostLog& log, const TimeRange& of_arrivals);

// `jumps`: of the arrivals of cameras on that host.
void place(LoggedClock& clock, const TimeRange& of_arrivals, std::span<const DelayJump> jumps);

// Whether a change of the log and a jump of the arrivals may be one: within two intervals of the
// log and a second, and alike in size to within 20 %.
bool may_be_one(const LoggedClock& clock, const LoggedChange& change, const DelayJump& jump,
                double shift_s = 0);

}  // namespace simbench::evaluation

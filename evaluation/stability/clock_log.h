// Measured time errors of a clock from the files that other programs write, recognised by content:
//
// - linuxptp: what ptp4l, phc2sys and ts2phc print or log ("ptp4l[5374018.735]: master offset -23
//   s2 freq ..."), nanoseconds, positive: the clock is ahead of its source. Also behind the heads
//   of syslog, journalctl (short, short-iso, cat, json, export), Docker, Kubernetes, and of both at
//   once, and their summaries ("rms 67 max 73 freq ...").
// - chrony: tracking.log (7th column, positive: fast), statistics.log (5th, positive: fast),
//   measurements.log (12th, positive: slow), refclocks.log (raw offset, positive: slow), and
//   `chronyc -c tracking` in a loop (last offset, positive: fast).
// - ntpd: loopstats (3rd column), peerstats (5th), sntp's output, positive: slow; rawstats
//   (four stamps of an exchange). ntpshmmon: the clock minus the reference's time.
// - others: w32tm /stripchart (also /rdtsc), positive: slow. Debug lines of systemd-timesyncd,
//   positive: slow. The statistics of ptpd: offset from master, positive: fast.
// - a TICC's time stamps of the pulses of a clock, once a second by each channel: early pulses are
//   of a clock that is ahead; errors count from the first pulse on.
// - csv: tables (recording/table.h) of time and time error, see below.
//
// The format is that of most lines: what is no measurement (banners, changes of state, other
// programs) is skipped, and counted in the notes. Signs are turned so that positive is a clock that
// is ahead.
//
// A table has a column of times and one of errors, which is found by its heading, is the only other
// one, or is named (`series`). Times are seconds, of the heading's unit, or ISO 8601; a table of
// one column needs the interval. The unit of errors is that of the heading, else the option's;
// without both it is a guess that is said (small fractions are seconds), or there is none: whole
// numbers may be anything. Empty cells and NaN are gaps, counted.
//
// A file may have several series (hosts, processes, interfaces, sources, columns): one is named, or
// it is the only one. Processes of one program that follow one another are one series. Where times
// go back (a restart, a clock that was set) a new segment begins; segments of a scale that counts
// from 1970 and do not overlap (rotated files) are put in order. Points of equal times are kept. A
// last line without its line end may be cut in mid-number: it is left out, with a note.
//
// Errors: scenarios::InputError, "FILE:LINE: found ..., allowed: ...": unreadable, empty, of
// another program, a damaged line, no finite number, errors beyond kLargestErrorS, a unit that the
// file contradicts or nothing states, more than kMostLogSeries series, no point at all. Complexity:
// linear in the text. Memory: 16 bytes a point of every series.
//
// Sources: chrony.conf(5), chronyc(1), clock.c, phc2sys.c and print.c of linuxptp, monitoring
// options of ntpd's documentation, sntp(1), ntpshmmon(1), ptpd2(8), w32tm's help,
// timesyncd-manager.c of systemd, the TICC's manual (tapr.org).
//
//   const ClockLog log = read_clock_log("/var/log/chrony/tracking.log");
//   const double first_s = log.points.front().error_s;
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/time.h"
#include "recording/stamp_unit.h"

namespace simbench::evaluation {

// A clock that is off by more, 317 years, never was set; one that began at 1970 is off by less.
inline constexpr double kLargestErrorS = 1e10;
inline constexpr std::size_t kMostLogSeries = 1000;

struct ClockLogOptions {
  std::optional<StampUnit> unit{};       // of a table's errors
  std::optional<StampUnit> time_unit{};  // of its times
  std::string series{};                  // which, of a file that has several; empty: the only one
  std::optional<double> interval_s{};    // of a table of one column
  bool frequencies =
      false;            // a table has fractional frequencies: what its errors change by a second
  bool locked = false;  // without the points before the servo locked (linuxptp's s0, s1)
};

struct ClockLogPoint {
  Microseconds time{};
  double error_s = 0;  // local clock minus reference
};

struct ClockLog {
  std::string path{};
  std::string format{};  // "chrony_tracking", "ptp4l", "csv" ...
  std::string series{};  // its name; empty: the only one
  // At least one; in order of time within each segment.
  std::vector<ClockLogPoint> points{};
  // Summaries in place of points: `error_s` is the root mean square over the time since the last
  // one, and this the largest, both without a sign.
  std::vector<double> largest_s{};
  // Where a segment begins, but the first.
  std::vector<std::size_t> segments{};
  // When the boot was that times count from, by the dates that a collector of logs (journald,
  // syslog, Docker) put before the first line of each segment; none without such dates.
  struct Boot {
    std::size_t point = 0;  // the first of its segment
    double at_s = 0;        // since 1970
    bool has_year = true;   // else of the year kYearOfSyslog (log_entry.h)
  };
  std::vector<Boot> boots{};
  std::size_t unlocked = 0;          // points before the servo locked
  std::vector<std::string> notes{};  // what was left out or taken for granted, "FILE: ..." each

  bool are_summaries() const { return !largest_s.empty(); }
};

// What a file has.
struct ClockLogSeries {
  std::string name{};
  std::string format{};
  std::size_t points = 0;
  Microseconds first{};
  Microseconds last{};
};

ClockLog read_clock_log(const std::string& path, const ClockLogOptions& options = {});
// Reads text as if it were the content of `path`.
ClockLog parse_clock_log(std::string_view text, const std::string& path,
                         const ClockLogOptions& options = {});
// In order of occurrence; a table's are the columns that may be named.
std::vector<ClockLogSeries> clock_log_series(const std::string& path,
                                             const ClockLogOptions& options = {});

}  // namespace simbench::evaluation

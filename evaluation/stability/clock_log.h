// Measured time errors of a clock from the files that other programs write, recognised by content:
//
//   csv                seconds, time error; see below
//   chrony_tracking    chrony's tracking.log: date, time (UTC), source, stratum, frequency, skew,
//                      offset (7th column, seconds, positive: the local clock is fast) ...; lines
//                      of an unsynchronised clock (leap status '?') are left out
//   chrony_statistics  chrony's statistics.log: date, time (UTC), source, standard deviation,
//                      estimated offset (5th column, seconds, positive: the local clock is fast)
//                      ...
//   ptp4l, phc2sys     what these print or log: "ptp4l[5374018.735]: master offset -23 s2 freq
//   ...",
//                      "phc2sys[..]: CLOCK_REALTIME phc offset 12 s2 freq ...", nanoseconds,
//                      positive: the clock is ahead of its source; also behind syslog's host,
//                      program and process. The summaries that they print instead with a summary
//                      interval
//                      ("rms 12 max 34 freq ...") have no series in them and are refused
//   loopstats          ntpd's: modified Julian day, seconds of it (UTC), offset (3rd column,
//   seconds,
//                      positive: the local clock is slow, so the sign is turned here) ...
//
// A CSV has two columns, or names the one to take (`series`); a first line of names is allowed, and
// lines that begin with '#'. Times are seconds. A name that ends in a unit ("error_ms", "TE [ns]")
// states that of the errors; else it is the option's, else seconds.
//
// A file with several series (columns, sources of statistics.log, ports of ptp4l, clocks of
// phc2sys) needs the name of one. Times are those of the file, as exact microseconds, and ascend:
// chrony's and ntpd's since 1970 (UTC), linuxptp's of its monotonic clock. Lines that are no
// measurement (banners, changes of state, other programs in a syslog) are skipped; what that leaves
// out is said in the notes. A last line without its line end may be cut in mid-number: it is left
// out, with a note.
//
// Errors: scenarios::InputError, "FILE:LINE: found ..., allowed: ...": unreadable, empty, of
// another program, a damaged or unordered line, no finite number, errors beyond kLargestErrorS, a
// unit that the file contradicts, no point at all. Complexity: linear in the text. Memory: 16 bytes
// a point.
//
// Sources: chrony.conf(5), the log directive; clock.c and phc2sys.c of linuxptp; monitoring options
// of ntpd's documentation.
//
//   const ClockLog log = read_clock_log("/var/log/chrony/tracking.log");
//   const double first_s = log.points.front().error_s;
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::evaluation {

enum class ErrorUnit : std::uint8_t { kS, kMs, kUs, kNs };

// A clock that is off by more, 31 years, was never set.
inline constexpr double kLargestErrorS = 1e9;

struct ClockLogOptions {
  std::optional<ErrorUnit> unit{};  // of a CSV
  std::string series{};             // which, of a file that has several; empty: the only one
};

struct ClockLogPoint {
  Microseconds time{};
  double error_s = 0;  // local clock minus reference
};

struct ClockLog {
  std::string path{};
  std::string format{};                 // a name of the list above
  std::vector<ClockLogPoint> points{};  // at least one
  std::vector<std::string> notes{};     // what was left out, "FILE: ..." each
};

ClockLog read_clock_log(const std::string& path, const ClockLogOptions& options = {});
// Reads text as if it were the content of `path`.
ClockLog parse_clock_log(std::string_view text, const std::string& path,
                         const ClockLogOptions& options = {});

}  // namespace simbench::evaluation

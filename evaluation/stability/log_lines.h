// The lines of each kind of clock log (evaluation/stability/clock_log.h), one at a time.
//
//   const std::string path = "errors.csv";
//   const LogPlace place{path, 1};
//   const std::unique_ptr<LogLines> lines = lines_of_format("0,1e-6", place, {});
//   const std::optional<LogLine> point = lines->read("0,1e-6", place);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/stability/clock_log.h"

namespace simbench::evaluation {

// A place in a file, for messages.
struct LogPlace {
  const std::string& path;
  std::size_t line = 0;

  // Throws scenarios::InputError.
  [[noreturn]] void fail(const std::string& problem) const;
  [[noreturn]] void fail(std::string_view what, std::string_view found,
                         const std::string& allowed) const;
};

struct LogLine {
  std::string_view series;  // empty where the format has only one
  ClockLogPoint point;
};

class LogLines {
 public:
  virtual ~LogLines() = default;
  virtual const char* format() const = 0;
  // Nothing for a line that is no measurement. The result is valid as long as the line.
  virtual std::optional<LogLine> read(std::string_view line, const LogPlace& place) = 0;
  // What was skipped and may be missed.
  virtual std::vector<std::string> notes() const { return {}; }
};

// The format that this line shows; none for a line that any may begin with (a comment, a rule).
// Throws for a line that no format has.
std::unique_ptr<LogLines> lines_of_format(std::string_view line, const LogPlace& place,
                                          const ClockLogOptions& options);

// For the readers of the formats.
std::vector<std::string_view> words_of(std::string_view line);
// A finite number within `largest` either way.
double finite_of(std::string_view text, const char* what, double largest, const LogPlace& place);
// Seconds up to 4e11 (12,000 years) either way, to the microsecond.
std::optional<Microseconds> microseconds_of(std::string_view seconds);

std::unique_ptr<LogLines> csv_lines(const ClockLogOptions& options);
std::unique_ptr<LogLines> chrony_lines(bool tracking);
std::unique_ptr<LogLines> linuxptp_lines(const char* program);
std::unique_ptr<LogLines> loopstats_lines();

// Which of chrony's logs a line is of, by its heading or its columns.
enum class ChronyLog : std::uint8_t { kNone, kTracking, kStatistics, kOther };
ChronyLog chrony_log_of(std::string_view line);

}  // namespace simbench::evaluation

// The lines of each kind of clock log (evaluation/stability/clock_log.h), one at a time.
//
//   const std::string path = "tracking.log";
//   const LogPlace place{path, 1};
//   for (const LogFormat& format : log_formats()) {
//     const std::unique_ptr<LogLines> lines = format.make();
//     const std::optional<LogLine> point = lines->read("...", place);
//   }
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

// A measurement, and whose it is; texts are valid as long as the line.
struct LogLine {
  const char* format = "";
  std::string_view host{};
  std::string_view process{};
  std::string_view tag{};   // of a configuration
  std::string_view name{};  // of a clock, an interface, a source
  ClockLogPoint point{};
  std::optional<double> largest_s{};  // of a summary; the point is its RMS
  bool locked = true;
  // What may be the date at which a collector of logs had the line, where times count from a boot.
  std::string_view written{};
  // What an exchange has besides (stability/exchange_log.h): its delay, or its four stamps; and
  // whether the point is a pulse, of which the clock's reading is known.
  std::optional<double> delay_s{};
  std::optional<std::array<HostTime, 4>> stamps{};
  bool is_pulse = false;
};

class LogLines {
 public:
  virtual ~LogLines() = default;
  // Nothing for a line that is no measurement. Throws for one that is a damaged one.
  virtual std::optional<LogLine> read(std::string_view line, const LogPlace& place) = 0;
  // What was skipped and may be missed, and how many lines that were of this log.
  virtual std::vector<std::string> notes() const { return {}; }
  std::uint64_t skipped() const { return skipped_; }
  // Times count from 1970.
  virtual bool absolute() const { return true; }
  // A line that is no measurement and needs no mention: a rule, a heading, a change of state.
  virtual bool is_expected(std::string_view line) const;

 protected:
  // Counts a line of this log that has no measurement.
  std::optional<LogLine> skip() {
    ++skipped_;
    return std::nullopt;
  }

 private:
  std::uint64_t skipped_ = 0;
};

struct LogFormat {
  const char* text;  // for messages
  std::unique_ptr<LogLines> (*make)();
};
std::span<const LogFormat> log_formats();
// What a file is that has no time errors which can be read, and what would; nothing if unknown.
std::optional<std::string> known_other_log(std::string_view line);

// For the readers of the formats.
std::vector<std::string_view> words_of(std::string_view line);
// Refuses a line that stops early: `allowed` is how many columns its log has.
void check_width(const std::vector<std::string_view>& words, std::size_t fewest,
                 const std::string& allowed, const LogPlace& place);
// A finite number within `largest` either way.
double finite_of(std::string_view text, const char* what, double largest, const LogPlace& place);
// 12,000 years either way, so that differences of times fit, too.
inline constexpr Microseconds kLargestLogTime{400'000'000'000'000'000};
// Seconds up to that, to the microsecond.
std::optional<Microseconds> microseconds_of(std::string_view seconds);

std::unique_ptr<LogLines> chrony_tracking_lines();
std::unique_ptr<LogLines> chrony_statistics_lines();
std::unique_ptr<LogLines> chrony_measurements_lines();
std::unique_ptr<LogLines> chrony_refclocks_lines();
std::unique_ptr<LogLines> chronyc_tracking_lines();
std::unique_ptr<LogLines> linuxptp_lines();
std::unique_ptr<LogLines> loopstats_lines();
std::unique_ptr<LogLines> peerstats_lines();
std::unique_ptr<LogLines> rawstats_lines();
std::unique_ptr<LogLines> sntp_lines();
std::unique_ptr<LogLines> ntpshmmon_lines();
std::unique_ptr<LogLines> w32tm_lines();
std::unique_ptr<LogLines> w32tm_rdtsc_lines();
std::unique_ptr<LogLines> timesyncd_lines();
std::unique_ptr<LogLines> ptpd_lines();
std::unique_ptr<LogLines> ticc_lines();

}  // namespace simbench::evaluation

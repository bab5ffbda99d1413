#include "evaluation/stability/log_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "recording/number_in.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr const char* kFormats =
    "CSV (seconds, error), tracking.log or statistics.log of chrony, output of ptp4l or phc2sys, "
    "loopstats of ntpd";
constexpr std::int64_t kFirstDay = 10'000;  // of loopstats: 1886
constexpr std::int64_t kLastDay = 200'000;  // 2406
constexpr std::int64_t kUnixDay = 40'587;   // the modified Julian day of 1970-01-01
constexpr std::int64_t kDaySeconds = 86'400;

bool is_loopstats(const std::vector<std::string_view>& words) {
  if (words.size() < 3 || words.size() > 7) return false;
  const std::optional<std::int64_t> day = number_in<std::int64_t>(words[0]);
  return day && *day >= kFirstDay && *day <= kLastDay && microseconds_of(words[1]);
}

// "day seconds offset drift ..."; later versions have more columns.
class LoopstatsLines final : public LogLines {
 public:
  const char* format() const override { return "loopstats"; }
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    if (line.starts_with('#')) return std::nullopt;
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() < 5 || words.size() > 7) {
      place.fail(
          fmt::format("found {} columns, allowed: 5 to 7, as loopstats has; is the line "
                      "complete?",
                      words.size()));
    }
    const std::optional<std::int64_t> day = number_in<std::int64_t>(words[0]);
    if (!day || *day < kFirstDay || *day > kLastDay) {
      place.fail("day", words[0],
                 fmt::format("a modified Julian day from {} to {}", kFirstDay, kLastDay));
    }
    const std::optional<Microseconds> second = microseconds_of(words[1]);
    if (!second || *second < Microseconds(0) || *second >= std::chrono::seconds(kDaySeconds + 1)) {
      place.fail("second", words[1], "seconds of a day, from 0 to 86401");
    }
    // ntpd's offset is what has to be added to the clock.
    const double offset_s = finite_of(words[2], "offset", kLargestErrorS, place);
    const Microseconds midnight = std::chrono::seconds((*day - kUnixDay) * kDaySeconds);
    return LogLine{{}, {midnight + *second, 0 - offset_s}};
  }
};

}  // namespace

void LogPlace::fail(const std::string& problem) const {
  throw scenarios::InputError(fmt::format("{}:{}: {}", path, line, problem));
}

void LogPlace::fail(std::string_view what, std::string_view found,
                    const std::string& allowed) const {
  fail(fmt::format("{}: found {}, allowed: {}", what, quoted_bytes(found), allowed));
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

double finite_of(std::string_view text, const char* what, double largest, const LogPlace& place) {
  std::string_view digits = text;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  const std::optional<double> value = number_in<double>(digits);
  if (value && std::abs(*value) <= largest) return *value;
  place.fail(what, text, fmt::format("a number up to {:g}", largest));
}

std::optional<Microseconds> microseconds_of(std::string_view seconds) {
  constexpr std::int64_t kLargest = 400'000'000'000;
  // A second has as many microseconds as a millisecond nanoseconds.
  const std::optional<Nanoseconds> found = parse_ms(seconds, kLargest);
  if (!found) return std::nullopt;
  return Microseconds(found->count());
}

std::unique_ptr<LogLines> loopstats_lines() { return std::make_unique<LoopstatsLines>(); }

std::unique_ptr<LogLines> lines_of_format(std::string_view line, const LogPlace& place,
                                          const ClockLogOptions& options) {
  // Comments, chrony's rules, the first line of journalctl.
  if (line.starts_with('#') || line.starts_with("===") || line.starts_with("-- ")) return nullptr;
  std::unique_ptr<LogLines> lines;
  for (const char* program : {"ptp4l", "phc2sys"}) {
    const bool named = line.find(fmt::format("{}[", program)) != std::string_view::npos ||
                       line.find(fmt::format("{}: [", program)) != std::string_view::npos;
    if (named && !lines) lines = linuxptp_lines(program);
  }
  const ChronyLog chrony = chrony_log_of(line);
  if (!lines && chrony == ChronyLog::kOther) {
    place.fail("log of chrony", line, "its tracking.log or statistics.log");
  }
  if (!lines && chrony != ChronyLog::kNone) lines = chrony_lines(chrony == ChronyLog::kTracking);
  if (!lines && is_loopstats(words_of(line))) lines = loopstats_lines();
  if (!lines && line.find(',') != std::string_view::npos) return csv_lines(options);
  if (!lines) place.fail(fmt::format("found {}, allowed: {}", quoted_bytes(line), kFormats));
  if (options.unit) {
    place.fail(
        fmt::format("--unit: found a file of the format {}, which has a unit of its own; "
                    "allowed: with CSV files",
                    lines->format()));
  }
  return lines;
}

}  // namespace simbench::evaluation

#include "evaluation/stability/log_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "recording/number_in.h"
#include "recording/stamp_unit.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr LogFormat kFormats[] = {
    {"output of ptp4l, phc2sys or ts2phc", linuxptp_lines},
    {"tracking.log of chrony", chrony_tracking_lines},
    {"statistics.log of chrony", chrony_statistics_lines},
    {"measurements.log of chrony", chrony_measurements_lines},
    {"refclocks.log of chrony", chrony_refclocks_lines},
    {"`chronyc -c tracking` in a loop", chronyc_tracking_lines},
    {"peerstats of ntpd", peerstats_lines},
    {"loopstats of ntpd", loopstats_lines},
    {"rawstats of ntpd", rawstats_lines},
    {"output of sntp", sntp_lines},
    {"output of ntpshmmon", ntpshmmon_lines},
    {"w32tm /stripchart", w32tm_lines},
    {"w32tm /stripchart /rdtsc", w32tm_rdtsc_lines},
    {"debug lines of systemd-timesyncd", timesyncd_lines},
    {"statistics of ptpd", ptpd_lines},
    {"time stamps of a TICC", ticc_lines},
};

struct OtherLog {
  std::string_view text;  // somewhere in a line
  const char* what;       // and what would help
};
constexpr auto kOthers = std::to_array<OtherLog>({
    {"Freq Skew  Offset  Std Dev",
     "chronyc sourcestats, which has no times of its own; allowed: chronyd's statistics.log (`log "
     "statistics` in chrony.conf)"},
    {"MS Name/IP address",
     "chronyc sources, which has no times of its own; allowed: chronyd's measurements.log or "
     "statistics.log (`log measurements statistics` in chrony.conf)"},
    {"Reference ID    :",
     "chronyc tracking for people; allowed: `chronyc -c tracking` in a loop, or chronyd's "
     "tracking.log (`log tracking` in chrony.conf)"},
    {"st t when poll reach",
     "ntpq -p, which has no times of its own; allowed: ntpd's peerstats or loopstats (`statistics "
     "loopstats peerstats` in ntp.conf)"},
    {"Date (UTC) Time",
     "another log of chronyd; allowed: its tracking.log, statistics.log, measurements.log or "
     "refclocks.log"},
    {"System clock synchronized:",
     "timedatectl, which has no time error; allowed: systemd-timesyncd's "
     "debug lines, or the log of another daemon"},
});

}  // namespace

std::span<const LogFormat> log_formats() { return kFormats; }

std::optional<std::string> known_other_log(std::string_view line) {
  for (const OtherLog& other : kOthers) {
    if (line.find(other.text) != std::string_view::npos) return other.what;
  }
  return std::nullopt;
}

bool LogLines::is_expected(std::string_view line) const {
  return line.starts_with('=') || line.starts_with('#') || line.starts_with("-- ") ||
         line.find("Date (UTC)") != std::string_view::npos;
}

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
  words.reserve(16);
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

void check_width(const std::vector<std::string_view>& words, std::size_t fewest,
                 const std::string& allowed, const LogPlace& place) {
  if (words.size() >= fewest) return;
  place.fail(
      fmt::format("found {} columns, allowed: {}; is the line complete?", words.size(), allowed));
}

double finite_of(std::string_view text, const char* what, double largest, const LogPlace& place) {
  std::string_view digits = text;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  const std::optional<double> value = number_in<double>(digits);
  if (value && std::abs(*value) <= largest) return *value;
  place.fail(what, text, fmt::format("a number up to {:g}", largest));
}

std::optional<Microseconds> microseconds_of(std::string_view seconds) {
  // A second has as many microseconds as a millisecond nanoseconds.
  const std::optional<Nanoseconds> found = time_in(seconds, kMillisecondUnit);
  if (!found || std::abs(found->count()) > kLargestLogTime.count()) return std::nullopt;
  return Microseconds(found->count());
}

}  // namespace simbench::evaluation

// Reads what ntpd, sntp, ntpshmmon, w32tm, systemd-timesyncd and ptpd write.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"
#include "recording/date_time.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kFirstDay = 10'000;  // of ntpd's statistics: 1886
constexpr std::int64_t kLastDay = 200'000;  // 2406
constexpr std::int64_t kUnixDay = 40'587;   // the modified Julian day of 1970-01-01
constexpr std::int64_t kDaySeconds = 86'400;
constexpr std::chrono::hours kDay{24};

Microseconds microseconds(Nanoseconds time) {
  return std::chrono::duration_cast<Microseconds>(time);
}

bool is_whole(std::string_view word) { return number_in<std::int64_t>(word).has_value(); }

// "day seconds", a modified Julian day and the seconds of it (UTC).
bool begins_with_day(const std::vector<std::string_view>& words) {
  if (words.size() < 3 || !is_whole(words[0])) return false;
  const std::int64_t day = *number_in<std::int64_t>(words[0]);
  return day >= kFirstDay && day <= kLastDay && microseconds_of(words[1]);
}

Microseconds statistics_time_of(const std::vector<std::string_view>& words, const LogPlace& place) {
  const Microseconds second = *microseconds_of(words[1]);
  if (second < Microseconds(0) || second >= std::chrono::seconds(kDaySeconds + 1)) {
    place.fail("second", words[1], "seconds of a day, from 0 to 86401");
  }
  const std::int64_t day = *number_in<std::int64_t>(words[0]) - kUnixDay;
  return std::chrono::seconds(day * kDaySeconds) + second;
}

// "day seconds offset drift ..."; later versions have more columns. An offset is what has to be
// added to the clock.
class LoopstatsLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    if (!begins_with_day(words) || words.size() > 7) return std::nullopt;
    check_width(words, 5, "5 to 7, as loopstats has", place);
    const double offset_s = finite_of(words[2], "offset", kLargestErrorS, place);
    return LogLine{.format = "loopstats",
                   .point = {statistics_time_of(words, place), 0 - offset_s}};
  }
};

// "day seconds source status offset delay dispersion jitter"
class PeerstatsLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    const bool has_source =
        words.size() > 3 && begins_with_day(words) && words[3].size() == 4 &&
        words[2].find_first_of(".:(") != std::string_view::npos &&
        words[3].find_first_not_of("0123456789abcdef") == std::string_view::npos &&
        (!number_in<double>(words[2]) || words.size() >= 8);
    if (!has_source) return std::nullopt;
    check_width(words, 7, "7 or 8, as peerstats has", place);
    const double offset_s = finite_of(words[4], "offset", kLargestErrorS, place);
    return LogLine{.format = "peerstats",
                   .name = words[2],
                   .point = {statistics_time_of(words, place), 0 - offset_s}};
  }
};

// "day seconds source own t1 t2 t3 t4 ...", the stamps in seconds since 1900; later versions have
// more columns. A stamp that is missing is 0, as t1 of a broadcast.
class RawstatsLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() < 5 || !begins_with_day(words) ||
        words[2].find_first_of(".:(") == std::string_view::npos || number_in<double>(words[2]) ||
        words[3].find_first_of(".:(") == std::string_view::npos) {
      return std::nullopt;
    }
    check_width(words, kWords, "at least 8, as rawstats has", place);
    std::array<HostTime, 4> stamps;
    bool is_whole = true;
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      const std::optional<Nanoseconds> stamp = time_in(words[4 + i], kSecondUnit);
      if (!stamp || *stamp < Nanoseconds(0)) {
        place.fail("stamp", words[4 + i], "seconds since 1900");
      }
      is_whole &= *stamp != Nanoseconds(0);
      stamps[i] = HostTime(*stamp - k1900To1970);
    }
    if (!is_whole || stamps[3] < stamps[0] || stamps[2] < stamps[1]) return skip();
    const double late_s = to_seconds(stamps[1] - stamps[0]) + to_seconds(stamps[2] - stamps[3]);
    return LogLine{.format = "ntpd_rawstats",
                   .name = words[2],
                   .point = {statistics_time_of(words, place), 0 - late_s / 2},
                   .stamps = stamps};
  }

  std::vector<std::string> notes() const override {
    if (skipped() == 0) return {};
    return {counted(skipped(), "exchange") + " without all stamps in order left out"};
  }

 private:
  static constexpr std::size_t kWords = 8;
  static constexpr std::chrono::seconds k1900To1970{2'208'988'800};
};

// "2018-09-29 19:00:00.448103 (-0200) +0.000064 +/- 0.018346 host address s2 no-leap"
class SntpLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() < 5 || !words[2].starts_with('(') || !words[2].ends_with(')') ||
        words[4] != "+/-") {
      return std::nullopt;
    }
    const std::string stamp =
        fmt::format("{} {}{}", words[0], words[1], words[2].substr(1, words[2].size() - 2));
    const std::optional<Nanoseconds> time = date_time_in(stamp);
    if (!time) place.fail("time", stamp, "a day, a time and a zone");
    const double offset_s = finite_of(words[3], "offset", kLargestErrorS, place);
    return LogLine{.format = "sntp",
                   .name = words.size() > 6 ? words[6] : std::string_view(),
                   .point = {microseconds(*time), 0 - offset_s}};
  }
};

// "sample NTP2 seen clock reference leap precision"
class NtpshmmonLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() < 5 || words[0] != "sample") return std::nullopt;
    const std::optional<Nanoseconds> clock = time_in(words[3], kSecondUnit);
    const std::optional<Nanoseconds> reference = time_in(words[4], kSecondUnit);
    const auto good = [](const std::optional<Nanoseconds>& time) {
      return time && std::abs(time->count()) <= kLargestTime.count() / 2;
    };
    if (!good(clock) || !good(reference)) {
      place.fail("time", good(clock) ? words[4] : words[3], "seconds since 1970");
    }
    return LogLine{.format = "ntpshmmon",
                   .name = words[1],
                   .point = {microseconds(*reference),
                             1e-9 * static_cast<double>((*clock - *reference).count())}};
  }
};

// "06:39:15, +0000.0000640s" and "06:39:15, d:+00.0001s o:+00.0000640s ...": local times of the
// day, without the day.
class W32tmLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::size_t comma = line.find(", ");
    if (comma == std::string_view::npos) return std::nullopt;
    const std::optional<Nanoseconds> time = time_of_day_in(line.substr(0, comma));
    if (!time) return std::nullopt;
    std::string_view value = line.substr(comma + 2);
    if (const std::size_t at = value.find("o:"); at != std::string_view::npos) {
      value.remove_prefix(at + 2);
    }
    if (value.starts_with("error")) {
      return skip();
    }
    value = value.substr(0, value.find('s'));
    if (!value.starts_with('+') && !value.starts_with('-')) return std::nullopt;
    if (last_ && *time < *last_ - kDay / 2) days_ += kDay;
    last_ = *time;
    const double offset_s = finite_of(value, "offset", kLargestErrorS, place);
    return LogLine{.format = "w32tm", .point = {days_ + microseconds(*time), 0 - offset_s}};
  }

  std::vector<std::string> notes() const override {
    if (skipped() == 0) return {};
    return {counted(skipped(), "sample") + " that failed left out"};
  }
  bool absolute() const override { return false; }

 private:
  std::optional<Nanoseconds> last_{};
  Microseconds days_{};
};

// "RdtscStart, RdtscEnd, FileTime, RoundtripDelay, NtpOffset": two counts of the processor, local
// time in 100 ns since 1601, and seconds.
class W32tmRdtscLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    if (!is_whole(take_cell(line)) || !is_whole(take_cell(line))) return std::nullopt;
    const auto file_time = number_in<std::int64_t>(take_cell(line));
    if (!file_time || *file_time < kYear1970) return std::nullopt;
    finite_of(take_cell(line), "RoundtripDelay", kLargestErrorS, place);
    const double offset_s = finite_of(take_cell(line), "NtpOffset", kLargestErrorS, place);
    return LogLine{.format = "w32tm",
                   .point = {Microseconds((*file_time - kYear1970) / 10), 0 - offset_s}};
  }
  bool is_expected(std::string_view line) const override {
    return line.starts_with("RdtscStart") || LogLines::is_expected(line);
  }

 private:
  static constexpr std::int64_t kYear1970 = 116'444'736'000'000'000;
};

// "Sep 03 10:32:22 host systemd-timesyncd[412]: interval/delta/delay/jitter/drift
// 64s/+0.000s/0.012s/0.000s/+12ppm": times without a year, of one that has no leap day.
class TimesyncdLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    constexpr std::string_view kMark = "interval/delta/delay/jitter/drift ";
    const std::size_t mark = line.find(kMark);
    if (mark == std::string_view::npos) return std::nullopt;
    const std::string_view values = line.substr(mark + kMark.size());
    const std::size_t slash = std::min(values.find('/'), values.size());
    const std::string_view delta = values.substr(std::min(slash + 1, values.size()));
    const std::vector<std::string_view> head = words_of(line.substr(0, mark));
    const std::optional<Microseconds> time = time_of(head);
    if (!time) place.fail("time", line, "a line of syslog or journalctl -o short-iso");
    const double offset_s =
        finite_of(delta.substr(0, delta.find('s')), "delta", kLargestErrorS, place);
    return LogLine{.format = "timesyncd",
                   .host = head.size() > 2 ? head[head.size() - 2] : std::string_view(),
                   .point = {*time, 0 - offset_s}};
  }

 private:
  std::optional<Microseconds> time_of(const std::vector<std::string_view>& head) {
    constexpr std::array<std::string_view, 12> kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    if (head.empty()) return std::nullopt;
    if (const auto stamp = date_time_in(head[0])) return microseconds(*stamp);
    if (head.size() < 3) return std::nullopt;
    const auto month = std::ranges::find(kMonths, head[0]);
    const auto day = number_in<int>(head[1].substr(head[1].starts_with('0') ? 1 : 0));
    const auto time = time_of_day_in(head[2]);
    if (month == kMonths.end() || !day || *day < 1 || *day > 31 || !time) return std::nullopt;
    const auto number = static_cast<unsigned>(month - kMonths.begin()) + 1;
    if (number < month_) ++year_;
    month_ = number;
    if (year_ > kLastYear) return std::nullopt;
    const std::chrono::sys_days date = std::chrono::year(year_) / static_cast<int>(number) / *day;
    return microseconds(date.time_since_epoch() + *time);
  }

  static constexpr int kLastYear = 2200;
  int year_ = 1970;
  unsigned month_ = 0;
};

// "2014-03-12 12:34:56.123456, slv, clock, one way delay, offset from master, ..."
class PtpdLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    std::array<std::string_view, 5> cells;
    for (std::string_view& cell : cells) cell = take_cell(line);
    if (cells[1] != "slv") return std::nullopt;
    const std::optional<Nanoseconds> time = date_time_in(cells[0]);
    if (!time) return std::nullopt;
    // Before the first measurement the cell is empty.
    if (cells[4].empty()) return std::nullopt;
    return LogLine{.format = "ptpd",
                   .point = {microseconds(*time),
                             finite_of(cells[4], "offset from master", kLargestErrorS, place)}};
  }
};

}  // namespace

std::unique_ptr<LogLines> loopstats_lines() { return std::make_unique<LoopstatsLines>(); }
std::unique_ptr<LogLines> peerstats_lines() { return std::make_unique<PeerstatsLines>(); }
std::unique_ptr<LogLines> rawstats_lines() { return std::make_unique<RawstatsLines>(); }
std::unique_ptr<LogLines> sntp_lines() { return std::make_unique<SntpLines>(); }
std::unique_ptr<LogLines> ntpshmmon_lines() { return std::make_unique<NtpshmmonLines>(); }
std::unique_ptr<LogLines> w32tm_lines() { return std::make_unique<W32tmLines>(); }
std::unique_ptr<LogLines> w32tm_rdtsc_lines() { return std::make_unique<W32tmRdtscLines>(); }
std::unique_ptr<LogLines> timesyncd_lines() { return std::make_unique<TimesyncdLines>(); }
std::unique_ptr<LogLines> ptpd_lines() { return std::make_unique<PtpdLines>(); }

}  // namespace simbench::evaluation

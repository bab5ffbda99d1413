// Reads chrony's tracking.log and statistics.log.
#include <fmt/format.h>

#include <chrono>

#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"
#include "recording/number_in.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kTrackingWords = 9;  // the fewest, of the oldest version that has the offset
constexpr std::size_t kStatisticsWords = 12;  // the fewest

bool is_leap_status(std::string_view word) {
  return word.size() == 1 && std::string_view("N+-?").find(word[0]) != std::string_view::npos;
}

std::optional<std::chrono::sys_days> day_of(std::string_view word) {
  if (word.size() != 10 || word[4] != '-' || word[7] != '-') return std::nullopt;
  const auto year = number_in<std::int64_t>(word.substr(0, 4));
  const auto month = number_in<std::int64_t>(word.substr(5, 2));
  const auto day = number_in<std::int64_t>(word.substr(8, 2));
  if (!year || !month || !day || *year < 1900 || *month < 1 || *day < 1) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  std::chrono::sys_days days{date};
  return days;
}

std::optional<Microseconds> time_of_day(std::string_view word) {
  if (word.size() < 8 || word[2] != ':' || word[5] != ':') return std::nullopt;
  const auto hour = number_in<std::int64_t>(word.substr(0, 2));
  const auto minute = number_in<std::int64_t>(word.substr(3, 2));
  const auto second = microseconds_of(word.substr(6));
  if (!hour || !minute || !second) return std::nullopt;
  const bool in_day = *hour >= 0 && *hour < 24 && *minute >= 0 && *minute < 60;
  // 60: a leap second.
  if (!in_day || *second < Microseconds(0) || *second >= std::chrono::seconds(61))
    return std::nullopt;
  return std::chrono::hours(*hour) + std::chrono::minutes(*minute) + *second;
}

class ChronyLines final : public LogLines {
 public:
  explicit ChronyLines(bool tracking) : tracking_(tracking) {}

  const char* format() const override {
    return tracking_ ? "chrony_tracking" : "chrony_statistics";
  }

  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    if (line.starts_with("===") || line.starts_with('#')) return std::nullopt;
    const std::vector<std::string_view> words = words_of(line);
    if (words[0] == "Date") {
      const ChronyLog wanted = tracking_ ? ChronyLog::kTracking : ChronyLog::kStatistics;
      if (chrony_log_of(line) != wanted) place.fail("heading", line, "that of the first lines");
      return std::nullopt;
    }
    check_words(words, place);
    const auto day = day_of(words[0]);
    if (!day) place.fail("date", words[0], "a day such as 2024-05-31");
    const auto time = time_of_day(words[1]);
    if (!time) place.fail("time", words[1], "a time of the day such as 12:34:56");
    const Microseconds since_1970 = day->time_since_epoch() + *time;
    const double error_s = finite_of(words[tracking_ ? 6 : 4], "offset", kLargestErrorS, place);
    if (tracking_ && words[7] == "?") {
      ++unsynchronised_;
      return std::nullopt;
    }
    return LogLine{tracking_ ? std::string_view() : words[2], {since_1970, error_s}};
  }

  std::vector<std::string> notes() const override {
    if (unsynchronised_ == 0) return {};
    return {counted(unsynchronised_, "line") + " of an unsynchronised clock left out"};
  }

 private:
  void check_words(const std::vector<std::string_view>& words, const LogPlace& place) const {
    const std::size_t fewest = tracking_ ? kTrackingWords : kStatisticsWords;
    if (words.size() < fewest) {
      place.fail(fmt::format("found {} columns, allowed: at least {}; is the line complete?",
                             words.size(), fewest));
    }
    if (tracking_ && !is_leap_status(words[7])) {
      place.fail("leap status", words[7], "N, +, - or ? in the 8th column of tracking.log");
    }
  }

  bool tracking_;
  std::uint64_t unsynchronised_ = 0;
};

}  // namespace

ChronyLog chrony_log_of(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() < 3) return ChronyLog::kNone;
  if (words[0] == "Date" && words[1] == "(UTC)") {
    if (line.find("Est offset") != std::string_view::npos) return ChronyLog::kStatistics;
    const bool tracking = line.find("Freq ppm") != std::string_view::npos &&
                          line.find("Offset") != std::string_view::npos;
    return tracking ? ChronyLog::kTracking : ChronyLog::kOther;
  }
  if (!day_of(words[0]) || !time_of_day(words[1])) return ChronyLog::kNone;
  if (words.size() >= kTrackingWords && number_in<std::int64_t>(words[3]) &&
      is_leap_status(words[7])) {
    return ChronyLog::kTracking;
  }
  const bool statistics = words.size() >= kStatisticsWords &&
                          words[3].find_first_of(".e") != std::string_view::npos &&
                          words[4].find_first_of(".e") != std::string_view::npos;
  return statistics ? ChronyLog::kStatistics : ChronyLog::kOther;
}

std::unique_ptr<LogLines> chrony_lines(bool tracking) {
  return std::make_unique<ChronyLines>(tracking);
}

}  // namespace simbench::evaluation

// Reads chrony's logs: columns by blanks, a day and a time of day (UTC) first.
#include <fmt/format.h>

#include <chrono>

#include "evaluation/stability/log_lines.h"
#include "recording/counted.h"
#include "recording/date_time.h"
#include "recording/number_in.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kTrackingWords = 9;  // the fewest, of the oldest version that has the offset
constexpr std::size_t kStatisticsWords = 12;
constexpr std::size_t kMeasurementsWords = 17;
constexpr std::size_t kRefclocksWords = 9;

bool is_leap_status(std::string_view word) {
  return word.size() == 1 && std::string_view("N+-?").find(word[0]) != std::string_view::npos;
}

bool is_real(std::string_view word) {
  return word.find_first_of(".e") != std::string_view::npos && number_in<double>(word).has_value();
}

// The time at the beginning of a line.
std::optional<Microseconds> chrony_time_of(const std::vector<std::string_view>& words) {
  if (words.size() < 3) return std::nullopt;
  const auto day = day_in(words[0]);
  const auto time = day ? time_of_day_in(words[1]) : std::nullopt;
  if (!time) return std::nullopt;
  return std::chrono::duration_cast<Microseconds>(day->time_since_epoch() + *time);
}

void check_chrony_width(const std::vector<std::string_view>& words, std::size_t fewest,
                        const LogPlace& place) {
  check_width(words, fewest, fmt::format("at least {}", fewest), place);
}

class TrackingLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    const std::optional<Microseconds> time = chrony_time_of(words);
    if (!time || words.size() < 4 || !number_in<std::int64_t>(words[3])) {
      return std::nullopt;
    }
    if (words.size() > 4 && !number_in<double>(words[4])) return std::nullopt;
    check_chrony_width(words, kTrackingWords, place);
    if (!is_leap_status(words[7])) {
      place.fail("leap status", words[7], "N, +, - or ? in the 8th column of tracking.log");
    }
    const double error_s = finite_of(words[6], "offset", kLargestErrorS, place);
    if (words[7] == "?") {
      return skip();
    }
    return LogLine{.format = "chrony_tracking", .point = {*time, error_s}};
  }

  std::vector<std::string> notes() const override {
    if (skipped() == 0) return {};
    return {counted(skipped(), "line") + " of an unsynchronised clock left out"};
  }
};

class StatisticsLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    const std::optional<Microseconds> time = chrony_time_of(words);
    if (!time || words.size() < 4 || !is_real(words[3])) return std::nullopt;
    check_chrony_width(words, kStatisticsWords, place);
    return LogLine{.format = "chrony_statistics",
                   .name = words[2],
                   .point = {*time, finite_of(words[4], "offset", kLargestErrorS, place)}};
  }
};

class MeasurementsLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    const std::optional<Microseconds> time = chrony_time_of(words);
    if (!time || words.size() < 8 || !is_leap_status(words[3]) || words[5].size() != 3 ||
        words[6].size() != 3) {
      return std::nullopt;
    }
    check_chrony_width(words, kMeasurementsWords, place);
    const double theta_s = finite_of(words[11], "offset", kLargestErrorS, place);
    // A failed test (0) is no measurement that chronyd used.
    if (line.substr(0, static_cast<std::size_t>(words[8].data() - line.data()))
            .find_first_of('0', static_cast<std::size_t>(words[5].data() - line.data())) !=
        std::string_view::npos) {
      return skip();
    }
    return LogLine{.format = "chrony_measurements",
                   .name = words[2],
                   .point = {*time, 0 - theta_s},
                   .delay_s = finite_of(words[12], "peer delay", kLargestErrorS, place)};
  }

  std::vector<std::string> notes() const override {
    if (skipped() == 0) return {};
    return {counted(skipped(), "measurement") + " that chronyd's tests refused left out"};
  }
};

class RefclocksLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    const std::vector<std::string_view> words = words_of(line);
    const std::optional<Microseconds> time = chrony_time_of(words);
    if (!time || words.size() < 6 || !is_leap_status(words[4]) ||
        (words[5] != "0" && words[5] != "1" && words[5] != "-")) {
      return std::nullopt;
    }
    check_chrony_width(words, kRefclocksWords, place);
    if (words[6] == "-") {
      return skip();
    }
    const double offset_s = finite_of(words[6], "raw offset", kLargestErrorS, place);
    return LogLine{.format = "chrony_refclocks",
                   .name = words[2],
                   .point = {*time, 0 - offset_s},
                   .is_pulse = words[5] == "1"};
  }

  std::vector<std::string> notes() const override {
    if (skipped() == 0) return {};
    return {counted(skipped(), "filtered sample") + " left out: the raw ones are taken"};
  }
};

// "D5B8E5A1,192.0.2.1,2,1725359542.123456789,system time,last offset,RMS offset ..."
class ChronycLines final : public LogLines {
 public:
  std::optional<LogLine> read(std::string_view line, const LogPlace& place) override {
    constexpr std::size_t kChronycCells = 14;
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0; begin <= line.size() && cells.size() <= kChronycCells;) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      cells.push_back(line.substr(begin, end - begin));
      begin = end + 1;
    }
    // A time may stand before each line of the loop.
    if (!cells.empty()) cells[0] = cells[0].substr(cells[0].find_last_of(" \t") + 1);
    if (cells.size() != kChronycCells || cells[0].size() != 8 ||
        cells[0].find_first_not_of("0123456789ABCDEF") != std::string_view::npos) {
      return std::nullopt;
    }
    const std::optional<Microseconds> time = microseconds_of(cells[3]);
    if (!time) place.fail("reference time", cells[3], "seconds since 1970");
    if (cells[13] != "Normal" && !cells[13].ends_with(" second")) {
      return skip();
    }
    // Between two updates chronyc repeats the last one.
    if (last_ == *time) return std::nullopt;
    last_ = *time;
    return LogLine{.format = "chronyc_tracking",
                   .point = {*time, finite_of(cells[5], "last offset", kLargestErrorS, place)}};
  }

  std::vector<std::string> notes() const override {
    if (skipped() == 0) return {};
    return {counted(skipped(), "line") + " of an unsynchronised clock left out"};
  }

 private:
  std::optional<Microseconds> last_{};
};

}  // namespace

std::unique_ptr<LogLines> chrony_tracking_lines() { return std::make_unique<TrackingLines>(); }
std::unique_ptr<LogLines> chrony_statistics_lines() { return std::make_unique<StatisticsLines>(); }
std::unique_ptr<LogLines> chrony_measurements_lines() {
  return std::make_unique<MeasurementsLines>();
}
std::unique_ptr<LogLines> chrony_refclocks_lines() { return std::make_unique<RefclocksLines>(); }
std::unique_ptr<LogLines> chronyc_tracking_lines() { return std::make_unique<ChronycLines>(); }

}  // namespace simbench::evaluation

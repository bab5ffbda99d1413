#include "evaluation/stability/clock_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "evaluation/stability/log_lines.h"
#include "evaluation/stability/log_series.h"
#include "evaluation/stability/table_log.h"
#include "recording/counted.h"
#include "recording/line_reader.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kSampleLines = 50'000;  // a syslog in which the daemon speaks late
constexpr std::size_t kSampleBytes = std::size_t{8} << 20;
constexpr std::size_t kSampleRows = 200;  // rows of numbers that are of no program: a table
constexpr std::size_t kEnough = 10;       // measurements

std::string_view without_end(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t\r");
  return line.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

bool reads(LogLines& lines, std::string_view line, const LogPlace& place) {
  try {
    return lines.read(line, place).has_value();
  } catch (const scenarios::InputError&) {
    return false;
  }
}

// The first lines of a file, to find out whose it is.
struct Sample {
  const LogFormat* format = nullptr;   // of most lines; none: of no program
  std::optional<std::string> other{};  // what it is instead
  std::size_t other_line = 0;
  bool any = false;
  std::string first{};  // the first line that is not blank
};

Sample sample_of(LineReader& reader) {
  std::vector<std::pair<std::unique_ptr<LogLines>, std::size_t>> found;
  for (const LogFormat& format : log_formats()) found.emplace_back(format.make(), 0);
  Sample sample;
  std::size_t rows = 0;
  std::size_t bytes = 0;
  std::size_t most = 0;
  for (std::size_t i = 0; i < kSampleLines && bytes < kSampleBytes && most < kEnough; ++i) {
    const std::optional<std::string_view> next = reader.next();
    if (!next) break;
    bytes += next->size();
    const std::string_view line = without_end(*next);
    if (!line.empty() && !std::exchange(sample.any, true)) sample.first = line;
    if (!sample.other && (sample.other = known_other_log(line))) sample.other_line = reader.line();
    const LogPlace place{reader.path(), reader.line()};
    for (auto& [lines, count] : found) {
      if (reads(*lines, line, place)) most = std::max(most, ++count);
    }
    const char begin = line.empty() ? ' ' : line.front();
    if (std::string_view("0123456789+-.\"").find(begin) != std::string_view::npos) ++rows;
    if (most == 0 && rows >= kSampleRows) break;
  }
  const auto best = std::ranges::max_element(found, {}, [](const auto& f) { return f.second; });
  if (best->second > 0)
    sample.format = &log_formats()[static_cast<std::size_t>(best - found.begin())];
  return sample;
}

// One file as it is read.
class LogReading {
 public:
  // `lists`: what series there are is asked, not their points.
  LogReading(LineReader lines, const ClockLogOptions& options, bool lists)
      : path_(lines.path()),
        lines_(std::move(lines)),
        options_(options),
        lists_(lists),
        set_(options) {
    lines_.mark();
    const Sample sample = sample_of(lines_);
    if (!sample.any) fail_empty();
    lines_.rewind();
    if (sample.format != nullptr) {
      read_lines(*sample.format);
    } else {
      if (sample.other) {
        LogPlace{path_, sample.other_line}.fail(fmt::format("found {}", *sample.other));
      }
      read_table(sample.first);
    }
  }

  ClockLog take() {
    if (table_) return std::move(*table_);
    if (set_.empty()) current_place().fail("the file ends without a time error");
    ClockLog log = set_.take(current_place(), absolute_);
    std::ranges::move(notes_, std::back_inserter(log.notes));
    return log;
  }

  std::vector<ClockLogSeries> list() { return set_.empty() ? table_series_ : set_.list(); }

 private:
  LogPlace current_place() const { return {path_, lines_.line()}; }

  [[noreturn]] void fail_empty() const {
    if (!lines_.torn()) LogPlace{path_, 1}.fail("the file is empty, allowed: a log of a clock");
    LogPlace{path_, 1}.fail("the file ends without a time error: its only line has no line end");
  }

  void read_lines(const LogFormat& format);
  void read_table(const std::string& first);
  void note_torn() {
    if (!lines_.torn()) return;
    notes_.push_back(fmt::format(
        "{}: the last line has no line end and may be cut; it was left out", lines_.place()));
  }

  std::string path_;
  LineReader lines_;
  const ClockLogOptions& options_;
  bool lists_;
  LogSeriesSet set_;
  bool absolute_ = true;
  std::vector<std::string> notes_{};
  std::optional<ClockLog> table_{};
  std::vector<ClockLogSeries> table_series_{};
};

void LogReading::read_lines(const LogFormat& format) {
  if (options_.unit) {
    LogPlace{path_, 1}.fail(fmt::format(
        "--unit: found {}, which has a unit of its own; allowed: with tables", format.text));
  }
  if (options_.frequencies) {
    LogPlace{path_, 1}.fail(
        fmt::format("--frequencies: found {}, allowed: with tables", format.text));
  }
  const std::unique_ptr<LogLines> lines = format.make();
  absolute_ = lines->absolute();
  std::size_t others = 0;
  std::size_t first_other = 0;
  while (const std::optional<std::string_view> next = lines_.next()) {
    const std::string_view line = without_end(*next);
    const LogPlace place{path_, lines_.line()};
    const std::uint64_t skipped = lines->skipped();
    if (const std::optional<LogLine> found = lines->read(line, place)) {
      set_.add(*found, place);
    } else if (!line.empty() && !set_.empty() && lines->skipped() == skipped &&
               !lines->is_expected(line) && ++others == 1) {
      first_other = place.line;
    }
  }
  note_torn();
  for (const std::string& note : lines->notes()) notes_.push_back(path_ + ": " + note);
  if (others > 0) {
    notes_.push_back(fmt::format("{}:{}: {} that {} no measurement left out, the first here", path_,
                                 first_other, counted(others, "line"), others == 1 ? "is" : "are"));
  }
}

void LogReading::read_table(const std::string& first) {
  TableReader table(std::move(lines_));
  if (!is_table_of_values(table)) {
    std::vector<std::string> formats;
    for (const LogFormat& format : log_formats()) formats.emplace_back(format.text);
    LogPlace{path_, 1}.fail(
        fmt::format("found {}, allowed: a table of time and time error (CSV), {}",
                    quoted_bytes(first), fmt::join(formats, ", ")));
  }
  table_series_ = table_columns(table);
  if (lists_ && !has_series_columns(table)) return;
  ClockLog log = read_table_log(table, options_, set_);
  absolute_ = false;
  if (set_.empty()) {
    table_ = std::move(log);
  } else {
    notes_ = std::move(log.notes);
  }
}

template <class Action>
auto checked_lines(const Action& action) {
  try {
    return action();
  } catch (const LineError& error) {
    throw scenarios::InputError(error.what());
  }
}

}  // namespace

ClockLog read_clock_log(const std::string& path, const ClockLogOptions& options) {
  return checked_lines([&] { return LogReading(LineReader(path), options, false).take(); });
}

ClockLog parse_clock_log(std::string_view text, const std::string& path,
                         const ClockLogOptions& options) {
  return checked_lines([&] { return LogReading(LineReader(path, text), options, false).take(); });
}

std::vector<ClockLogSeries> clock_log_series(const std::string& path,
                                             const ClockLogOptions& options) {
  return checked_lines([&] { return LogReading(LineReader(path), options, true).list(); });
}

}  // namespace simbench::evaluation

#include "evaluation/stability/clock_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "evaluation/stability/log_lines.h"
#include "recording/collected.h"
#include "recording/counted.h"
#include "recording/line_reader.h"
#include "recording/text_fields.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kNamedSeries = 8;  // in a message

// One log as it is read, line by line.
class LogAssembly {
 public:
  LogAssembly(const std::string& path, const ClockLogOptions& options)
      : place_{.path = path}, options_(options) {}

  void read_line(std::string_view line);
  // After the last line; `torn`: bytes without a line end follow.
  ClockLog finish(bool torn);

 private:
  bool is_wanted(std::string_view series);
  void check_order(Microseconds time) const;

  LogPlace place_;
  const ClockLogOptions& options_;
  std::unique_ptr<LogLines> lines_;
  std::vector<std::string> series_;  // the first few that occur
  std::vector<ClockLogPoint> points_;
};

void LogAssembly::read_line(std::string_view line) {
  if (++place_.line == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
  const std::size_t last = line.find_last_not_of(" \t\r");
  if (last == std::string_view::npos) return;
  line = line.substr(0, last + 1);
  if (!lines_) lines_ = lines_of_format(line, place_, options_);
  if (!lines_) return;
  const std::optional<LogLine> found = lines_->read(line, place_);
  if (!found || !is_wanted(found->series)) return;
  check_order(found->point.time);
  points_.push_back(found->point);
}

bool LogAssembly::is_wanted(std::string_view series) {
  const bool known = std::find(series_.begin(), series_.end(), series) != series_.end();
  if (!known && series_.size() < kNamedSeries) series_.emplace_back(series);
  if (!options_.series.empty()) return series == options_.series || series.empty();
  if (series != series_.front()) {
    place_.fail(
        fmt::format("found a second series, {}, beside {}, allowed: one, or --series with "
                    "the name of one",
                    quoted_bytes(series), quoted_bytes(series_.front())));
  }
  return true;
}

void LogAssembly::check_order(Microseconds time) const {
  if (points_.empty() || time > points_.back().time) return;
  place_.fail(fmt::format(
      "found a time {} s before the one before it, allowed: times that ascend; sort the file, or "
      "split it where its clock was set back",
      1e-6 * static_cast<double>((points_.back().time - time).count())));
}

ClockLog LogAssembly::finish(bool torn) {
  ClockLog log{.path = place_.path};
  if (torn) {
    ++place_.line;
    log.notes.push_back(
        fmt::format("{}:{}: the last line has no line end and may be cut; it was left out",
                    place_.path, place_.line));
  }
  if (place_.line == 0) {
    ++place_.line;
    place_.fail("the file is empty, allowed: a log of a clock");
  }
  if (points_.empty()) {
    std::string problem = "the file ends without a time error";
    if (!options_.series.empty() && !series_.empty()) {
      const std::vector<std::string> names = collected(series_, quoted_bytes);
      problem += fmt::format(" of the series {}, allowed: {}", quoted_bytes(options_.series),
                             fmt::join(names, ", "));
    }
    place_.fail(problem);
  }
  log.format = lines_->format();
  log.points = std::move(points_);
  for (const std::string& note : lines_->notes()) log.notes.push_back(place_.path + ": " + note);
  return log;
}

}  // namespace

ClockLog read_clock_log(const std::string& path, const ClockLogOptions& options) {
  try {
    LineReader lines(path);
    LogAssembly log(path, options);
    while (const auto line = lines.next()) log.read_line(*line);
    return log.finish(lines.torn());
  } catch (const LineError& error) {
    throw scenarios::InputError(error.what());
  }
}

ClockLog parse_clock_log(std::string_view text, const std::string& path,
                         const ClockLogOptions& options) {
  LogAssembly log(path, options);
  std::size_t end = 0;
  while ((end = text.find('\n')) != std::string_view::npos) {
    log.read_line(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return log.finish(!text.empty());
}

}  // namespace simbench::evaluation

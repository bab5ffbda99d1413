#include "evaluation/stability/log_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "evaluation/stability/log_entry.h"
#include "recording/counted.h"
#include "recording/text_fields.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kNamedSeries = 8;  // in a message

// Whole files in any order: segments that do not overlap. False if they do.
bool put_in_order(ClockLog& log) {
  using Segment = std::pair<std::size_t, std::size_t>;
  std::vector<Segment> order;
  for (std::size_t i = 0; i <= log.segments.size(); ++i) {
    order.emplace_back(i == 0 ? 0 : log.segments[i - 1],
                       i == log.segments.size() ? log.points.size() : log.segments[i]);
  }
  std::ranges::sort(order, {}, [&](const Segment& s) { return log.points[s.first].time; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (log.points[order[i - 1].second - 1].time > log.points[order[i].first].time) return false;
  }
  std::vector<ClockLogPoint> sorted;
  sorted.reserve(log.points.size());
  for (const auto& [begin, end] : order) {
    sorted.insert(sorted.end(), log.points.begin() + static_cast<std::ptrdiff_t>(begin),
                  log.points.begin() + static_cast<std::ptrdiff_t>(end));
  }
  log.points = std::move(sorted);
  return true;
}

void add_segment_notes(ClockLog& log, bool absolute) {
  if (log.segments.empty()) return;
  if (absolute && !log.are_summaries() && put_in_order(log)) {
    log.notes.push_back(
        fmt::format("{}: times go back {}, and the parts do not overlap: put in order of time",
                    log.path, counted(log.segments.size(), "time")));
    log.segments.clear();
    return;
  }
  log.notes.push_back(segments_note(log.path, log.segments.size()));
}

}  // namespace

bool LogSeriesSet::Series::is_of_same_clock(const Series& other) const {
  return format == other.format && host == other.host && tag == other.tag && name == other.name &&
         largest_s.empty() == other.largest_s.empty();
}

void LogSeriesSet::Series::append(Series next) {
  const std::size_t before = points.size();
  if (next.points.front().time < points.back().time) segments.push_back(before);
  for (const std::size_t begin : next.segments) segments.push_back(before + begin);
  for (ClockLog::Boot boot : next.boots) {
    boot.point += before;
    boots.push_back(boot);
  }
  points.insert(points.end(), next.points.begin(), next.points.end());
  largest_s.insert(largest_s.end(), next.largest_s.begin(), next.largest_s.end());
  unlocked += next.unlocked;
  last_line = next.last_line;
}

bool LogSeriesSet::Series::has_name(const std::string& asked) const {
  return asked == name || asked == process || asked == host || asked == tag || asked == format ||
         asked == fmt::format("{}[{}]", format, process);
}

LogSeriesSet::Series& LogSeriesSet::series_of(const LogLine& line, const LogPlace& place) {
  constexpr char kBetween = '\n';
  key_.assign(line.format);
  for (const std::string_view part : {line.host, line.process, line.tag, line.name}) {
    key_ += kBetween;
    key_ += part;
  }
  if (line.largest_s) key_ += kBetween;
  const auto known = index_.find(key_);
  if (known != index_.end()) return series_[known->second];
  if (series_.size() == kMostLogSeries) {
    place.fail(fmt::format("found more than {} series, allowed: so many", kMostLogSeries));
  }
  index_.emplace(key_, series_.size());
  return series_.emplace_back(Series{.format = line.format,
                                     .host = std::string(line.host),
                                     .process = std::string(line.process),
                                     .tag = std::string(line.tag),
                                     .name = std::string(line.name),
                                     .first_line = place.line});
}

void LogSeriesSet::add(const LogLine& line, const LogPlace& place) {
  Series& series = series_of(line, place);
  series.last_line = place.line;
  if (!line.locked) ++series.unlocked;
  if (!line.locked && options_.locked) return;
  if (!series.points.empty() && line.point.time < series.points.back().time) {
    series.segments.push_back(series.points.size());
  }
  const bool is_first = series.points.empty() || (!series.segments.empty() &&
                                                  series.segments.back() == series.points.size());
  if (is_first) {
    if (const auto written = written_time_in(line.written)) {
      const double since_boot_s = 1e-6 * static_cast<double>(line.point.time.count());
      series.boots.push_back({.point = series.points.size(),
                              .at_s = written->at_s - since_boot_s,
                              .has_year = written->has_year});
    }
  }
  series.points.push_back(line.point);
  if (line.largest_s) series.largest_s.push_back(*line.largest_s);
}

void LogSeriesSet::join_restarts() {
  if (std::exchange(joined_, true)) return;
  std::vector<Series> joined;
  for (Series& next : series_) {
    if (next.points.empty()) continue;  // never locked
    const auto before = std::ranges::find_if(joined, [&](const Series& series) {
      return series.is_of_same_clock(next) && series.last_line < next.first_line;
    });
    if (before == joined.end()) {
      joined.push_back(std::move(next));
    } else {
      before->append(std::move(next));
    }
  }
  series_ = std::move(joined);
  name_series();
}

void LogSeriesSet::name_series() {
  const auto differ = [&](const std::string Series::*part) {
    return std::ranges::any_of(series_,
                               [&](const Series& s) { return s.*part != series_.front().*part; });
  };
  const bool hosts = differ(&Series::host);
  const bool processes = differ(&Series::process);
  const bool formats = differ(&Series::format);
  const bool tags = differ(&Series::tag);
  const bool names = differ(&Series::name) || (!hosts && !processes && !formats && !tags);
  for (Series& series : series_) {
    std::vector<std::string> parts;
    if (hosts) parts.push_back(series.host);
    if (processes) parts.push_back(fmt::format("{}[{}]", series.format, series.process));
    if (formats && !processes) parts.push_back(series.format);
    if (tags) parts.push_back(series.tag);
    if (names && !series.name.empty()) parts.push_back(series.name);
    series.label = fmt::format("{}", fmt::join(parts, " "));
  }
}

std::vector<ClockLogSeries> LogSeriesSet::list() {
  join_restarts();
  std::vector<ClockLogSeries> found;
  for (const Series& series : series_) {
    found.push_back({.name = printable_name(series.label),
                     .format = series.format,
                     .points = series.points.size(),
                     .first = series.points.front().time,
                     .last = series.points.back().time});
  }
  return found;
}

LogSeriesSet::Series& LogSeriesSet::chosen(const LogPlace& place) {
  join_restarts();
  std::vector<std::string> names;
  for (const Series& series : series_) {
    if (names.size() == kNamedSeries) {
      names.emplace_back("...");
      break;
    }
    names.push_back(quoted_bytes(series.label));
  }
  const std::string& asked = options_.series;
  if (asked.empty()) {
    if (series_.size() == 1) return series_.front();
    place.fail(fmt::format("found {} series, {}, allowed: one, or --series with the name of one",
                           series_.size(), fmt::join(names, ", ")));
  }
  const auto by_label = std::ranges::find(series_, asked, &Series::label);
  if (by_label != series_.end()) return *by_label;
  const auto has_name = [&](const Series& series) { return series.has_name(asked); };
  const auto found = std::ranges::find_if(series_, has_name);
  if (found != series_.end() && std::ranges::count_if(series_, has_name) == 1) return *found;
  // A file that has no names at all has one series, whatever it is called.
  if (series_.size() == 1 && series_.front().label.empty()) return series_.front();
  place.fail(fmt::format("--series: found {}, which {} of the series, allowed: {}",
                         quoted_bytes(asked), found == series_.end() ? "is none" : "is several",
                         fmt::join(names, ", ")));
}

ClockLog LogSeriesSet::take(const LogPlace& place, bool absolute) {
  join_restarts();
  if (series_.empty()) place.fail("the file ends without a time error of a locked servo");
  const bool several = series_.size() > 1;
  Series& series = chosen(place);
  ClockLog log{.path = place.path,
               .format = series.format,
               .series = several ? printable_name(series.label) : std::string(),
               .points = std::move(series.points),
               .largest_s = std::move(series.largest_s),
               .segments = std::move(series.segments),
               .boots = std::move(series.boots),
               .unlocked = series.unlocked};
  add_segment_notes(log, absolute);
  if (log.unlocked > 0) {
    log.notes.push_back(fmt::format(
        "{}: {} before the servo locked (s0, s1) {}", log.path, counted(log.unlocked, "point"),
        options_.locked ? "left out" : "among those taken; --locked leaves them out"));
  }
  return log;
}

std::string segments_note(const std::string& path, std::size_t segments) {
  return fmt::format(
      "{}: times go back {} (a restart, or a clock that was set back): each is a gap", path,
      counted(segments, "time"));
}

}  // namespace simbench::evaluation

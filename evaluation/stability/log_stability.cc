#include "evaluation/stability/log_stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

double seconds_of(Microseconds time) { return static_cast<double>(time.count()) / 1e6; }

// The begin of each segment, and the end of the last one.
std::vector<std::size_t> bounds_of(const LogPoints& log) {
  std::vector<std::size_t> bounds = {0};
  bounds.insert(bounds.end(), log.segments.begin(), log.segments.end());
  bounds.push_back(log.points.size());
  return bounds;
}

// Distances of neighbours of different times, within the segments.
std::vector<double> distances_of(const LogPoints& log) {
  std::vector<double> distances;
  distances.reserve(log.points.size());
  const std::vector<std::size_t> bounds = bounds_of(log);
  for (std::size_t segment = 0; segment + 1 < bounds.size(); ++segment) {
    for (std::size_t i = bounds[segment] + 1; i < bounds[segment + 1]; ++i) {
      const double distance_s = seconds_of(log.points[i].time - log.points[i - 1].time);
      if (distance_s > 0) distances.push_back(distance_s);
    }
  }
  return distances;
}

// Seconds since the first point, on a scale on which a restart, which takes nobody knows how long,
// takes `restart_s`.
std::vector<double> times_of(const LogPoints& log, double restart_s) {
  std::vector<double> times;
  times.reserve(log.points.size());
  const std::vector<std::size_t> bounds = bounds_of(log);
  for (std::size_t segment = 0; segment + 1 < bounds.size(); ++segment) {
    const Microseconds first = log.points[bounds[segment]].time;
    const double begin_s = segment == 0 ? 0 : times.back() + restart_s;
    for (std::size_t i = bounds[segment]; i < bounds[segment + 1]; ++i) {
      times.push_back(begin_s + seconds_of(log.points[i].time - first));
    }
  }
  return times;
}

// Times where a restart takes as long as points are apart.
std::vector<double> times_of(const LogPoints& log) {
  const std::vector<double> distances = distances_of(log);
  return times_of(log, distances.empty() ? 0 : median(distances));
}

// How many points have the time of the one before.
std::uint64_t equal_times(const LogPoints& log) {
  std::uint64_t equal = 0;
  const std::vector<std::size_t> bounds = bounds_of(log);
  for (std::size_t segment = 0; segment + 1 < bounds.size(); ++segment) {
    for (std::size_t i = bounds[segment] + 1; i < bounds[segment + 1]; ++i) {
      if (log.points[i].time == log.points[i - 1].time) ++equal;
    }
  }
  return equal;
}

// Points of one time as their mean.
LogPoints without_equal_times(const LogPoints& log) {
  LogPoints found;
  found.points.reserve(log.points.size());
  const std::vector<std::size_t> bounds = bounds_of(log);
  for (std::size_t segment = 0; segment + 1 < bounds.size(); ++segment) {
    if (segment > 0) found.segments.push_back(found.points.size());
    double count = 0;
    for (std::size_t i = bounds[segment]; i < bounds[segment + 1]; ++i) {
      const ClockLogPoint& point = log.points[i];
      if (i > bounds[segment] && point.time == found.points.back().time) {
        ++count;
        double& mean_s = found.points.back().error_s;
        mean_s += (point.error_s - mean_s) / count;
      } else {
        count = 1;
        found.points.push_back(point);
      }
    }
  }
  return found;
}

// Takes one point after another of a log that may restart.
class Grid {
 public:
  Grid(double interval_s, double share) : interval_s_(interval_s), share_(share) {}

  // A piece ends where a segment does.
  void begin_segment() {
    commit();
    fresh_ = true;
  }

  // The point of those in the window that is nearest to one interval continues the piece.
  void take(double time_s, double error_s) {
    if (waiting_) {
      const double now_s = std::abs(time_s - last_s_ - interval_s_);
      const double before_s = std::abs(waiting_time_s_ - last_s_ - interval_s_);
      if (now_s < before_s) {
        ++even_.left_out;
        wait_for_nearer(time_s, error_s);
        return;
      }
      commit();
    }
    const double since_s = time_s - last_s_;
    if (!fresh_ && since_s < (1 - share_) * interval_s_) {
      ++even_.left_out;
    } else if (!fresh_ && since_s <= (1 + share_) * interval_s_) {
      wait_for_nearer(time_s, error_s);
    } else {
      begin_piece(time_s, error_s);
    }
  }

  EvenSeries finish() {
    commit();
    even_.series.interval_s = interval_s_;
    if (even_.neighbours > 0) {
      // To the microsecond of the stamps, so that a regular log has its plain interval.
      const double mean_s = neighbours_s_ / static_cast<double>(even_.neighbours);
      even_.series.interval_s = std::max(std::round(mean_s * 1e6), 1.0) / 1e6;
    }
    return std::move(even_);
  }

 private:
  void wait_for_nearer(double time_s, double error_s) {
    waiting_ = error_s;
    waiting_time_s_ = time_s;
  }

  void commit() {
    if (!waiting_) return;
    neighbours_s_ += waiting_time_s_ - last_s_;
    ++even_.neighbours;
    even_.series.pieces.back().x_s.push_back(*waiting_);
    last_s_ = waiting_time_s_;
    waiting_.reset();
  }

  void begin_piece(double time_s, double error_s) {
    if (!fresh_) even_.longest_gap_s = std::max(even_.longest_gap_s, time_s - last_s_);
    even_.series.pieces.push_back({.start_s = time_s, .x_s = {error_s}});
    last_s_ = time_s;
    fresh_ = false;
  }

  double interval_s_;
  double share_;
  EvenSeries even_{};
  std::optional<double> waiting_{};  // the error of a point that a nearer one may replace
  double waiting_time_s_ = 0;
  double neighbours_s_ = 0;
  double last_s_ = 0;
  bool fresh_ = true;
};

double covered_s(const EvenSeries& even) {
  return static_cast<double>(even.neighbours) * even.series.interval_s;
}

// The medians of distances of one octave each, of those that occur often, ascending.
std::vector<double> octaves_of(std::vector<double> distances) {
  constexpr std::size_t kRare = 20;  // one in so many
  std::ranges::sort(distances);
  std::vector<double> found;
  for (std::size_t begin = 0; begin < distances.size();) {
    const auto end = static_cast<std::size_t>(
        std::upper_bound(distances.begin(), distances.end(), std::sqrt(2) * distances[begin]) -
        distances.begin());
    if ((end - begin) * kRare >= distances.size()) found.push_back(distances[(begin + end) / 2]);
    begin = end;
  }
  return found;
}

// The even series of a log whose interval nobody states, and how it was found, if that is not
// plain.
EvenSeries found_grid(const LogPoints& log, std::string& how) {
  constexpr double kNearlyAll = 0.9;
  const std::vector<double> distances = distances_of(log);
  const double median_s = median(distances);
  const auto enough = [&](const EvenSeries& even) {
    return static_cast<double>(even.neighbours) >=
           kEvenShare * static_cast<double>(distances.size());
  };
  EvenSeries plain = evenly_spaced(log, median_s);
  if (enough(plain)) return plain;
  EvenSeries wide = evenly_spaced(log, median_s, kUnevenShare);
  if (enough(wide)) {
    how =
        fmt::format("distances of points vary: those within {:.0f} % of {:.6g} s are taken as even",
                    100 * kUnevenShare, median_s);
    return wide;
  }
  std::vector<EvenSeries> candidates;
  for (const double interval_s : octaves_of(distances)) {
    candidates.push_back(evenly_spaced(log, interval_s));
  }
  double most_s = covered_s(plain);
  for (const EvenSeries& candidate : candidates) most_s = std::max(most_s, covered_s(candidate));
  if (covered_s(plain) >= most_s / 2) return plain;
  for (EvenSeries& candidate : candidates) {
    if (covered_s(candidate) < kNearlyAll * most_s) continue;
    how = fmt::format("distances of points go from {:.6g} to {:.6g} s: taken at {:.6g} s",
                      *std::ranges::min_element(distances), *std::ranges::max_element(distances),
                      candidate.series.interval_s);
    return std::move(candidate);
  }
  return plain;
}

// Points without a neighbour on the grid.
std::uint64_t lone_points(const TimeErrorSeries& series) {
  return static_cast<std::uint64_t>(
      std::count_if(series.pieces.begin(), series.pieces.end(),
                    [](const TimeErrorPiece& piece) { return piece.x_s.size() == 1; }));
}

void add_grid_notes(const EvenSeries& even, LogStability& found) {
  const Stability& stability = found.stability;
  const auto note = [&](const std::string& text) {
    found.notes.push_back(found.file + ": " + text);
  };
  if (found.left_out > 0) {
    note(fmt::format("{} between those {:.6g} s apart only in the time error",
                     counted(static_cast<std::uint64_t>(found.left_out), "point"),
                     stability.interval_s));
  }
  if (stability.pieces > 1) {
    note(found.longest_gap_s > 0
             ? fmt::format("{}, the longest of {:.6g} s: no difference reaches over a gap",
                           counted(static_cast<std::uint64_t>(stability.pieces - 1), "gap"),
                           found.longest_gap_s)
             : fmt::format("{}: no difference reaches over a gap",
                           counted(static_cast<std::uint64_t>(stability.pieces - 1), "gap")));
  }
  if (const std::uint64_t lone = lone_points(even.series); lone > 0) {
    note(
        fmt::format("{} without a neighbour at {:.6g} s only in the time error; --interval-s "
                    "states another interval",
                    counted(lone, "point"), stability.interval_s));
  }
  if (stability.adev.empty()) {
    note(
        fmt::format("no three points {:.6g} s apart, so no deviation exists; --interval-s states "
                    "another interval",
                    stability.interval_s));
  }
}

TimeErrorSummary size_of(std::span<const ClockLogPoint> points) {
  TimeErrorSeries series{.pieces = {{}}};
  std::vector<double>& x_s = series.pieces.front().x_s;
  x_s.reserve(points.size());
  for (const ClockLogPoint& point : points) x_s.push_back(point.error_s);
  return time_error_of(series);
}

// How many first points are a start; 0: none.
std::size_t start_of(std::span<const ClockLogPoint> points) {
  if (points.size() < 2 * kSettledPoints) return 0;
  std::vector<double> second_half;
  for (const ClockLogPoint& point : points.subspan(points.size() / 2)) {
    second_half.push_back(point.error_s);
  }
  const double middle_s = median(second_half);
  const double limit_s = kStartScatters * robust_deviation(std::move(second_half));
  std::size_t settled = 0;
  for (std::size_t i = 0; i < points.size() / 2 + kSettledPoints; ++i) {
    settled = std::abs(points[i].error_s - middle_s) <= limit_s ? settled + 1 : 0;
    if (settled == kSettledPoints) return i + 1 - kSettledPoints;
  }
  return 0;
}

// Leaves `count` first points out.
void drop_first(LogPoints& log, std::size_t count) {
  log.points.erase(log.points.begin(), log.points.begin() + static_cast<std::ptrdiff_t>(count));
  std::erase_if(log.segments, [&](std::size_t begin) { return begin <= count; });
  for (std::size_t& begin : log.segments) begin -= count;
}

// Keeps the asked stretch alone, with the largest errors of summaries.
void keep_asked(const LogStabilityOptions& options, LogPoints& log, std::vector<double>& largest_s,
                const std::string& path) {
  if (!options.from && !options.until) return;
  const std::vector<double> since_first = times_of(log);
  const auto time_on_scale = [&](const LogTime& asked, std::size_t i) {
    return asked.since_first ? since_first[i] : seconds_of(log.points[i].time);
  };
  LogPoints kept;
  std::vector<double> kept_largest;
  const std::vector<std::size_t> bounds = bounds_of(log);
  for (std::size_t segment = 0; segment + 1 < bounds.size(); ++segment) {
    const std::size_t before = kept.points.size();
    for (std::size_t i = bounds[segment]; i < bounds[segment + 1]; ++i) {
      if (options.from && time_on_scale(*options.from, i) < options.from->time_s) continue;
      if (options.until && time_on_scale(*options.until, i) > options.until->time_s) continue;
      kept.points.push_back(log.points[i]);
      if (!largest_s.empty()) kept_largest.push_back(largest_s[i]);
    }
    if (before > 0 && kept.points.size() > before) kept.segments.push_back(before);
  }
  if (kept.points.empty()) {
    throw scenarios::InputError(
        fmt::format("{}: found no time error in the asked time, allowed: from 0 to {:.9g} s after "
                    "the first, or times of the log's own scale",
                    path, since_first.back()));
  }
  log = std::move(kept);
  largest_s = std::move(kept_largest);
}

// Finds the start of a clock that was not set yet, and drops it on request.
void find_start(const LogStabilityOptions& options, LogPoints& log, LogStability& found) {
  const std::size_t start = start_of(log.points);
  if (start == 0) return;
  const std::span<const ClockLogPoint> all = log.points;
  found.start = {.points = static_cast<std::int64_t>(start),
                 .until_s = times_of(log)[start],
                 .largest_ms = size_of(all.first(start)).max_te_ms,
                 .settled = size_of(all.subspan(start))};
  found.settled = options.settle;
  if (options.settle) drop_first(log, start);
}

void remove_line(LogPoints& log, LogStability& found) {
  const std::vector<double> times = times_of(log);
  std::vector<double> errors;
  errors.reserve(times.size());
  for (const ClockLogPoint& point : log.points) errors.push_back(point.error_s);
  const FittedLine line = fit_line(times, errors);
  if (!std::isfinite(line.slope)) return;
  for (std::size_t i = 0; i < times.size(); ++i) {
    log.points[i].error_s -= line.slope * (times[i] - line.mean_x);
  }
  found.frequency_offset = line.slope;
}

// The size of a log of summaries: their maxima, and the root of their mean squares.
LogStability stability_of_summaries(const LogPoints& log, const std::vector<double>& largest_s,
                                    LogStability found) {
  double squares = 0;
  for (const ClockLogPoint& point : log.points) squares += point.error_s * point.error_s;
  const std::vector<double> distances = distances_of(log);
  found.are_summaries = true;
  found.stability.points = found.samples;
  found.stability.interval_s = distances.empty() ? 0 : median(distances);
  found.stability.pieces = static_cast<std::int64_t>(log.segments.size()) + 1;
  found.stability.time_error.max_te_ms = 1e3 * *std::ranges::max_element(largest_s);
  found.stability.time_error.rms_te_ms =
      1e3 * std::sqrt(squares / static_cast<double>(log.points.size()));
  found.notes.push_back(
      found.file +
      ": its lines are summaries (rms, max), which have no sign and no order: only the largest and "
      "the RMS time error exist. For the rest each update must be logged: ptp4l does that where "
      "summary_interval does not exceed logSyncInterval (-3 for 8 messages a second), phc2sys with "
      "-u 0");
  return found;
}

}  // namespace

EvenSeries evenly_spaced(const LogPoints& log, std::optional<double> interval_s, double share) {
  const double nominal_s = interval_s ? *interval_s : median(distances_of(log));
  SIMBENCH_ASSERT(nominal_s > 0, "points of one time have no interval");
  Grid grid(nominal_s, share);
  const std::vector<double> times = times_of(log, nominal_s);
  const std::vector<std::size_t> bounds = bounds_of(log);
  for (std::size_t segment = 0; segment + 1 < bounds.size(); ++segment) {
    grid.begin_segment();
    for (std::size_t i = bounds[segment]; i < bounds[segment + 1]; ++i) {
      grid.take(times[i], log.points[i].error_s);
    }
  }
  return grid.finish();
}

LogStability stability_of_log(ClockLog log, const LogStabilityOptions& options) {
  LogStability found{
      .file = log.path, .format = log.format, .series = log.series, .notes = log.notes};
  const bool summaries = log.are_summaries();
  LogPoints asked{std::move(log.points), std::move(log.segments)};
  keep_asked(options, asked, log.largest_s, log.path);
  if (!summaries) find_start(options, asked, found);
  found.samples = static_cast<std::int64_t>(asked.points.size());
  found.first_s = seconds_of(asked.points.front().time);
  if (summaries) return stability_of_summaries(asked, log.largest_s, std::move(found));
  if (distances_of(asked).empty()) {
    throw scenarios::InputError(fmt::format(
        "{}: found a single time error, allowed: two or more of different times", log.path));
  }
  if (options.remove_frequency) remove_line(asked, found);
  const TimeErrorSummary size = size_of(asked.points);
  const std::uint64_t equal = equal_times(asked);
  if (equal > 0) asked = without_equal_times(asked);
  std::string how;
  const EvenSeries even =
      options.interval_s ? evenly_spaced(asked, options.interval_s) : found_grid(asked, how);
  asked = {};
  found.left_out = even.left_out;
  found.longest_gap_s = even.longest_gap_s;
  found.stability = stability_of(even.series);
  found.stability.time_error = size;
  if (equal > 0) {
    found.notes.push_back(fmt::format("{}: {} of the time of the one before: the mean is taken",
                                      log.path, counted(equal, "point")));
  }
  if (!how.empty()) found.notes.push_back(log.path + ": " + how);
  add_grid_notes(even, found);
  return found;
}

}  // namespace simbench::evaluation

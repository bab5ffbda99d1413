#include "evaluation/stability/log_stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

double seconds_of(Microseconds time) { return static_cast<double>(time.count()) / 1e6; }

double median_distance_s(const std::vector<ClockLogPoint>& points) {
  std::vector<double> distances;
  for (std::size_t i = 1; i < points.size(); ++i) {
    distances.push_back(seconds_of(points[i].time - points[i - 1].time));
  }
  return median(std::move(distances));
}

// Points without a neighbour on the grid.
std::uint64_t lone_points(const TimeErrorSeries& series) {
  return static_cast<std::uint64_t>(
      std::count_if(series.pieces.begin(), series.pieces.end(),
                    [](const TimeErrorPiece& piece) { return piece.x_s.size() == 1; }));
}

void add_notes(std::uint64_t lone, LogStability& found) {
  const Stability& stability = found.stability;
  const auto note = [&](const std::string& text) {
    found.notes.push_back(found.file + ": " + text);
  };
  if (found.left_out > 0) {
    note(fmt::format("{} between those {:.6g} s apart left out",
                     counted(static_cast<std::uint64_t>(found.left_out), "point"),
                     stability.interval_s));
  }
  if (stability.pieces > 1) {
    note(fmt::format("{}, the longest of {:.6g} s: no difference reaches over a gap",
                     counted(static_cast<std::uint64_t>(stability.pieces - 1), "gap"),
                     found.longest_gap_s));
  }
  if (lone > 0) {
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

}  // namespace

EvenSeries evenly_spaced(const std::vector<ClockLogPoint>& points,
                         std::optional<double> interval_s) {
  SIMBENCH_ASSERT(points.size() >= 2, "a single point has no interval");
  const double nominal_s = interval_s.value_or(median_distance_s(points));
  EvenSeries even;
  even.series.interval_s = nominal_s;
  std::vector<TimeErrorPiece>& pieces = even.series.pieces;
  double neighbours_s = 0;
  std::int64_t neighbours = 0;
  Microseconds last{};
  for (const ClockLogPoint& point : points) {
    const double since_s = pieces.empty() ? 0 : seconds_of(point.time - last);
    if (!pieces.empty() && since_s < (1 - kGridShare) * nominal_s) {
      ++even.left_out;
      continue;
    }
    const bool next = !pieces.empty() && since_s <= (1 + kGridShare) * nominal_s;
    if (next) {
      neighbours_s += since_s;
      ++neighbours;
    } else {
      even.longest_gap_s = std::max(even.longest_gap_s, since_s);
      pieces.push_back({.start_s = seconds_of(point.time - points.front().time)});
    }
    pieces.back().x_s.push_back(point.error_s);
    last = point.time;
  }
  if (neighbours > 0) {
    // To the microsecond of the stamps, so that a regular log has its plain interval.
    const double mean_s = neighbours_s / static_cast<double>(neighbours);
    even.series.interval_s = std::max(std::round(mean_s * 1e6), 1.0) / 1e6;
  }
  return even;
}

LogStability stability_of_log(const ClockLog& log, const LogStabilityOptions& options) {
  if (log.points.size() < 2) {
    throw scenarios::InputError(
        fmt::format("{}: found a single time error, allowed: two or more", log.path));
  }
  EvenSeries even = evenly_spaced(log.points, options.interval_s);
  LogStability found{.file = log.path,
                     .format = log.format,
                     .first_s = seconds_of(log.points.front().time),
                     .left_out = even.left_out,
                     .longest_gap_s = even.longest_gap_s,
                     .notes = log.notes};
  if (options.remove_frequency) found.frequency_offset = remove_frequency_offset(even.series);
  found.stability = stability_of(even.series);
  add_notes(lone_points(even.series), found);
  return found;
}

}  // namespace simbench::evaluation

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "reports/figures/figure_parts.h"
#include "reports/figures/run_figures.h"
#include "reports/figures/thin.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::LostFrame;
using evaluation::RunDetail;
using evaluation::SetDetail;

constexpr double kBucketsOfACamera = 480;  // marks closer than this share of the axis are one

// What became of a frame.
enum class Lot : std::uint8_t { kGathered, kMixed, kPartial, kLeftOver, kDropped };
constexpr std::size_t kLots = 5;
constexpr std::array<const char*, kLots> kLotNames = {"in a complete set of one pulse",
                                                      "in a set of several pulses",
                                                      "in a partial set", "in no set", "dropped"};

// Beside the line of the camera's gathered frames, so that it stays to be seen.
constexpr std::array<double, kLots> kBesideCamera = {0, 0.3, 0.3, -0.3, 0.3};

// Where the frames of each lot are, by camera: buckets of the x axis.
struct Timeline {
  double first = 0;   // position
  double bucket = 1;  // width
  std::vector<std::array<std::set<std::int64_t>, kLots>> cameras;

  void add(std::size_t camera, Lot lot, double position) {
    if (std::isnan(position)) return;
    cameras[camera][static_cast<std::size_t>(lot)].insert(
        static_cast<std::int64_t>(std::floor((position - first) / bucket)));
  }
  double middle(std::int64_t of_bucket) const {
    return first + (static_cast<double>(of_bucket) + 0.5) * bucket - 0.5;
  }
};

Lot lot_of(const SetDetail& set) {
  if (!set.complete) return Lot::kPartial;
  return set.pure ? Lot::kGathered : Lot::kMixed;
}

// The lots of all kept frames, by camera and frame.
std::vector<std::vector<Lot>> lots_of_frames(const RunDetail& run) {
  std::vector<std::vector<Lot>> lots;
  for (const CameraDetail& camera : run.cameras) {
    lots.emplace_back(camera.frames.size(), Lot::kLeftOver);
  }
  for (const SetDetail& set : run.sets) {
    for (const SetDetail::Member& member : set.members) {
      lots[member.camera][member.frame] = lot_of(set);
    }
  }
  return lots;
}

bool drawn(const RunDetail& run, const FrameDetail& frame) {
  return run.has_pulses ? frame.evaluated : !frame.in_warm_up;
}

// Of a lost frame: its pulse, or by the frame before it. NaN: not among those drawn.
double lost_position(const RunDetail& run, const LostFrame& lost) {
  if (lost.pulse >= 0) {
    const bool evaluated =
        lost.pulse >= run.first_pulse && lost.pulse < run.first_pulse + run.pulses;
    return evaluated ? static_cast<double>(lost.pulse) : evaluation::kNan;
  }
  const CameraDetail& camera = run.cameras[lost.camera];
  const auto after =
      std::find_if(camera.frames.begin(), camera.frames.end(),
                   [&lost](const FrameDetail& frame) { return frame.counter > lost.counter; });
  if (after == camera.frames.begin() || after == camera.frames.end()) return evaluation::kNan;
  if (!drawn(run, *after)) return evaluation::kNan;
  return frame_position(run, camera, static_cast<std::size_t>(after - camera.frames.begin())) -
         static_cast<double>(after->counter - lost.counter);
}

Timeline timeline_of(const RunDetail& run) {
  Timeline timeline;
  timeline.cameras.resize(run.cameras.size());
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (const CameraDetail& camera : run.cameras) {
    for (std::size_t i = 0; i < camera.frames.size(); ++i) {
      const double position = frame_position(run, camera, i);
      if (!drawn(run, camera.frames[i]) || std::isnan(position)) continue;
      first = std::min(first, position);
      last = std::max(last, position);
    }
  }
  if (last < first) return timeline;
  timeline.first = first;
  timeline.bucket = std::max(1.0, std::ceil((last - first + 1) / kBucketsOfACamera));
  const std::vector<std::vector<Lot>> lots = lots_of_frames(run);
  for (std::size_t camera = 0; camera < run.cameras.size(); ++camera) {
    const CameraDetail& of_camera = run.cameras[camera];
    for (std::size_t i = 0; i < of_camera.frames.size(); ++i) {
      if (!drawn(run, of_camera.frames[i])) continue;
      timeline.add(camera, lots[camera][i], frame_position(run, of_camera, i));
    }
  }
  for (const LostFrame& lost : run.lost) {
    if (lost.camera >= run.cameras.size()) continue;
    timeline.add(lost.camera, Lot::kDropped, lost_position(run, lost));
  }
  return timeline;
}

// A line over every unbroken run of buckets.
FigureSeries unbroken(const Timeline& timeline, std::size_t camera) {
  constexpr auto kLot = static_cast<std::size_t>(Lot::kGathered);
  FigureSeries line = series(kLotNames[kLot], Mark::kLine, static_cast<int>(kLot));
  const std::set<std::int64_t>& buckets = timeline.cameras[camera][kLot];
  const auto y = static_cast<double>(camera);
  for (auto begin = buckets.begin(); begin != buckets.end();) {
    auto end = std::next(begin);
    while (end != buckets.end() && *end == *std::prev(end) + 1) ++end;
    if (!line.x.empty()) {
      line.x.push_back(line.x.back());
      line.y.push_back(evaluation::kNan);
    }
    const double half = timeline.bucket / 2;
    line.x.insert(line.x.end(),
                  {timeline.middle(*begin) - half, timeline.middle(*std::prev(end)) + half});
    line.y.insert(line.y.end(), {y, y});
    begin = end;
  }
  return line;
}

FigurePanel frames_panel(const RunDetail& run, const Timeline& timeline) {
  FigurePanel made = panel("Frames", frame_axis(run), "camera");
  made.x_is_pulse = run.has_pulses;
  for (std::size_t camera = 0; camera < timeline.cameras.size(); ++camera) {
    FigureSeries line = unbroken(timeline, camera);
    if (!line.x.empty()) made.series.push_back(std::move(line));
  }
  for (std::size_t lot = 1; lot < kLots; ++lot) {
    FigureSeries marks = series(kLotNames[lot], Mark::kPoints, static_cast<int>(lot));
    for (std::size_t camera = 0; camera < timeline.cameras.size(); ++camera) {
      for (const std::int64_t bucket : timeline.cameras[camera][lot]) {
        marks.x.push_back(timeline.middle(bucket));
        marks.y.push_back(static_cast<double>(camera) + kBesideCamera.at(lot));
      }
    }
    if (!marks.x.empty()) made.series.push_back(std::move(marks));
  }
  return made;
}

FigurePanel sets_panel(const RunDetail& run) {
  FigurePanel made = panel("Sets", "pulse", "range of the set (ms)");
  made.x_is_pulse = true;
  for (const Lot lot : {Lot::kGathered, Lot::kMixed, Lot::kPartial}) {
    std::vector<std::pair<double, double>> points;
    for (const SetDetail& set : run.sets) {
      if (lot_of(set) != lot || set.pulse < 0) continue;
      points.emplace_back(static_cast<double>(set.pulse), set.range_ms);
    }
    if (points.empty()) continue;
    std::sort(points.begin(), points.end());
    const std::array<const char*, 3> names = {"complete, of one pulse", "complete, of several",
                                              "partial"};
    FigureSeries marks =
        series(names[static_cast<std::size_t>(lot)], Mark::kPoints, static_cast<int>(lot));
    for (const auto& [x, y] : points) {
      marks.x.push_back(x);
      marks.y.push_back(y);
    }
    made.series.push_back(thinned(std::move(marks), kMostPoints));
  }
  made.lines.push_back({.label = "T_int", .at = run.gathering_interval_ms});
  return made;
}

}  // namespace

Figure gathering(const RunDetail& run) {
  Figure figure = of_run("gathering", run);
  FigurePanel frames = frames_panel(run, timeline_of(run));
  if (frames.series.empty()) return absent(std::move(figure), "No camera has a scored frame.");
  figure.panels.push_back(std::move(frames));
  FigurePanel sets = sets_panel(run);
  if (!sets.series.empty()) figure.panels.push_back(std::move(sets));
  const evaluation::SetCounts& counts = run.score.sets;
  figure.caption = fmt::format(
      "{} complete sets, {} of them of one pulse; {} partial; {} of {} frames dropped. All cameras "
      "delivered {} pulses.{}",
      counts.emitted, counts.pure, counts.partial, run.score.frames.dropped,
      run.score.frames.expected, counts.complete_pulses, camera_note(run));
  return figure;
}

}  // namespace simbench::reports

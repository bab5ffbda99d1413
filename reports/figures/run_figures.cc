#include "reports/figures/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "recording/counted.h"
#include "reports/figures/caption_facts.h"
#include "reports/figures/code_figure.h"
#include "reports/figures/figure_parts.h"
#include "reports/figures/host_clock_figure.h"
#include "reports/figures/pulse_figure.h"
#include "reports/text/number_text.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::LostFrame;
using evaluation::RunDetail;
using evaluation::SetDetail;

constexpr double kBucketsOfACamera = 480;  // marks closer than this share of the axis are one

// The fate of a frame in gathering.
enum class Lot : std::uint8_t { kGathered, kMixed, kPartial, kLeftOver, kDropped };
constexpr std::size_t kLots = 5;
constexpr std::array<const char*, kLots> kLotNames = {"in a complete set of one pulse",
                                                      "in a set of several pulses",
                                                      "in a partial set", "in no set", "dropped"};

// The distance from the line of the camera's gathered frames, which stays visible.
constexpr std::array<double, kLots> kBesideCamera = {0, 0.3, 0.3, -0.3, 0.3};

// The frames of each lot by camera, as buckets of the x axis.
struct FrameTimeline {
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

// The position of a lost frame: its pulse, or derived from the next frame. NaN: not drawn.
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

FrameTimeline timeline_of(const RunDetail& run) {
  FrameTimeline timeline;
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

// A line over every run of adjacent buckets.
FigureSeries unbroken(const FrameTimeline& timeline, std::size_t camera) {
  constexpr auto kLot = static_cast<std::size_t>(Lot::kGathered);
  FigureSeries line = series(kLotNames[kLot], Mark::kLine, static_cast<int>(kLot));
  const std::set<std::int64_t>& buckets = timeline.cameras[camera][kLot];
  const auto y = static_cast<double>(camera);
  for (auto begin = buckets.begin(); begin != buckets.end();) {
    auto end = std::next(begin);
    while (end != buckets.end() && *end == *std::prev(end) + 1) ++end;
    if (!line.x.empty()) {
      line.add(line.x.back(), evaluation::kNan);
    }
    const double half = timeline.bucket / 2;
    line.x.insert(line.x.end(),
                  {timeline.middle(*begin) - half, timeline.middle(*std::prev(end)) + half});
    line.y.insert(line.y.end(), {y, y});
    begin = end;
  }
  return line;
}

FigurePanel frames_panel(const RunDetail& run, const FrameTimeline& timeline) {
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
        marks.add(timeline.middle(bucket), static_cast<double>(camera) + kBesideCamera.at(lot));
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
      marks.add(x, y);
    }
    made.series.push_back(thinned(std::move(marks), kMostPoints));
  }
  made.lines.push_back({.label = "T_int", .at = run.gathering_interval_ms});
  return made;
}

constexpr std::size_t kCamerasOfAHost = 3;  // as in the paper's figures
constexpr double kFirstSeconds = 10;

constexpr const char* kNoFrames = "No camera of the master host has frames after the warm-up.";

// The interval that ends with each frame after the warm-up; a gap where frames are missing between.
FigureSeries interval_series(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp) {
  FigureSeries made = series(camera_label(run, camera), Mark::kLine, 0);
  const CameraDetail& of_camera = run.cameras[camera];
  for (std::size_t i = 1; i < of_camera.frames.size(); ++i) {
    const FrameDetail& before = of_camera.frames[i - 1];
    const FrameDetail& frame = of_camera.frames[i];
    const double x = frame_position(run, of_camera, i);
    if (before.in_warm_up || frame.in_warm_up || std::isnan(x)) continue;
    made.add(x,
             frame.counter == before.counter + 1 ? frame.*stamp - before.*stamp : evaluation::kNan);
  }
  return thinned(std::move(made), kMostPoints);
}

// What of the paper's Fig. 2 the camera's stamps have not.
void note_lacking_stamps(const RunDetail& run, std::size_t camera, Figure& figure) {
  const CameraDetail& of_camera = run.cameras[camera];
  if (is_copy(of_camera, &FrameDetail::frame_ms)) {
    add_lack(figure, {.what = "frame stamps", .scenario = kNominalWorld, .was_recorded = false});
  }
  if (is_copy(of_camera, &FrameDetail::backend_ms)) {
    add_lack(figure, {.what = "back-end stamps", .scenario = kNominalWorld, .was_recorded = false});
  }
  if (interval_facts(run, camera, &FrameDetail::arrival_ms).jumps == 0) {
    add_lack(figure, {.what = "rare large jumps of the arrivals", .scenario = kNominalWorld});
  }
}

// The first frames after the warm-up.
FigureSeries raw_series(const RunDetail& run, std::size_t camera, double FrameDetail::*stamp,
                        std::size_t colour) {
  FigureSeries made = series(camera_label(run, camera), Mark::kPoints, static_cast<int>(colour));
  const CameraDetail& of_camera = run.cameras[camera];
  for (std::size_t i = 0; i < of_camera.frames.size() && made.x.size() < kFramesOfStamps; ++i) {
    const double x = frame_position(run, of_camera, i);
    if (of_camera.frames[i].in_warm_up || std::isnan(x)) continue;
    made.add(x, of_camera.frames[i].*stamp);
  }
  return made;
}

FigurePanel frame_panel(const RunDetail& run, std::string title, std::string y_label) {
  FigurePanel made = panel(std::move(title), frame_axis(run), std::move(y_label));
  made.x_is_pulse = run.has_pulses;
  return made;
}

bool has_points(const FigureSeries& series) { return !series.x.empty(); }

// Differences to the first series at the same x.
FigurePanel difference_panel(const RunDetail& run, const FigurePanel& stamps) {
  FigurePanel made = frame_panel(run, "Arrivals less those of the first camera", "difference (ms)");
  const FigureSeries& first = stamps.series.front();
  for (const FigureSeries& of_camera : stamps.series) {
    FigureSeries difference = series(of_camera.label, of_camera.mark, of_camera.colour);
    for (std::size_t i = 0; i < of_camera.x.size(); ++i) {
      const auto same = std::lower_bound(first.x.begin(), first.x.end(), of_camera.x[i]);
      if (same == first.x.end() || *same != of_camera.x[i]) continue;
      difference.add(of_camera.x[i],
                     of_camera.y[i] - first.y[static_cast<std::size_t>(same - first.x.begin())]);
    }
    made.series.push_back(std::move(difference));
  }
  return made;
}

// Global stamps of some cameras; colours by camera or by host.
FigurePanel global_panel(const RunDetail& run, std::string title,
                         const std::vector<std::size_t>& cameras, double FrameDetail::*stamp,
                         bool by_host) {
  FigurePanel made = frame_panel(run, std::move(title), reference_axis(run));
  const CommonReference reference(run, stamp);
  for (const std::size_t camera : cameras) {
    const std::size_t colour = by_host ? run.cameras[camera].host : made.series.size();
    made.series.push_back(stamp_series(run, camera, stamp, reference, static_cast<int>(colour)));
  }
  return made;
}

bool has_stamps(const FigurePanel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), has_points);
}

// The zero of x in the figure of the first seconds.
double capture_start_ms(const RunDetail& run, const CameraDetail& camera) {
  if (!std::isnan(run.capture_start_ms)) return run.capture_start_ms;
  return run.has_truth ? camera.frames.front().exposure_start_ms : camera.frames.front().arrival_ms;
}

FigureSeries first_intervals(const RunDetail& run, std::size_t camera, std::size_t colour) {
  FigureSeries made = series(camera_label(run, camera), Mark::kLine, static_cast<int>(colour));
  const std::vector<FrameDetail>& frames = run.cameras[camera].frames;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double at_ms = run.has_truth ? frames[i].mid_exposure_ms() : frames[i].arrival_ms;
    const double x = (at_ms - capture_start_ms(run, run.cameras[camera])) / 1000;
    if (x > kFirstSeconds) break;
    if (!made.x.empty() && x < made.x.back()) continue;
    made.add(x, frames[i].counter == frames[i - 1].counter + 1
                    ? frames[i].from_start_ms - frames[i - 1].from_start_ms
                    : evaluation::kNan);
  }
  return made;
}

// A camera's true mid-exposures less those of the first camera, over the latter.
FigureSeries exposure_differences(const RunDetail& run, std::size_t camera, double start_ms) {
  FigureSeries made = series(camera_label(run, camera), Mark::kLine, static_cast<int>(camera));
  const std::vector<FrameDetail>& frames = run.cameras[camera].frames;
  std::size_t near = 0;
  for (const FrameDetail& first : run.cameras.front().frames) {
    const double at_ms = first.mid_exposure_ms();
    const auto distance_ms = [&](std::size_t i) { return frames[i].mid_exposure_ms() - at_ms; };
    while (near + 1 < frames.size() &&
           std::abs(distance_ms(near + 1)) <= std::abs(distance_ms(near))) {
      ++near;
    }
    const bool is_there =
        near < frames.size() && std::abs(distance_ms(near)) <= 500 / run.frame_rate_hz;
    made.add((at_ms - start_ms) / 1000, is_there ? distance_ms(near) : evaluation::kNan);
  }
  return made;
}

// The range of all of them and the first camera; a gap where one has no frame.
FigureSeries spread_series(const std::vector<FigureSeries>& differences) {
  FigureSeries made = series("all cameras", Mark::kLine, 0);
  made.x = differences.front().x;
  for (std::size_t i = 0; i < made.x.size(); ++i) {
    double least = 0;
    double most = 0;
    for (const FigureSeries& of_camera : differences) {
      const double y = of_camera.y[i];
      least = std::isnan(y) ? y : std::min(least, y);
      most = std::isnan(y) ? y : std::max(most, y);
      if (std::isnan(y)) break;
    }
    made.y.push_back(most - least);
  }
  return made;
}

}  // namespace

Figure exposures(const RunDetail& run) {
  Figure figure = of_run("exposures", run);
  if (!run.has_truth) {
    return without_truth(std::move(figure), "true exposures");
  }
  if (run.cameras.size() < 2 || run.cameras.front().frames.empty()) {
    return absent(std::move(figure), "It takes the frames of two cameras.");
  }
  const char* const axis = "time since the start of the cameras (s)";
  FigurePanel each = panel("Against the first camera", axis, "exposed later by (ms)");
  FigurePanel all = panel("Spread", axis, "range of the exposures (ms)");
  const double start_ms = capture_start_ms(run, run.cameras.front());
  for (std::size_t camera = 1; camera < run.cameras.size(); ++camera) {
    each.series.push_back(exposure_differences(run, camera, start_ms));
  }
  all.series.push_back(thinned(spread_series(each.series), kMostPoints));
  all.log_y = is_wide(all);
  for (FigureSeries& of_camera : each.series)
    of_camera = thinned(std::move(of_camera), kMostPoints);
  for (FigurePanel* const made : {&each, &all}) {
    add_span("warm-up", 0, run.evaluated_start_ms - start_ms, 0, *made);
    figure.panels.push_back(std::move(*made));
  }
  figure.caption = fmt::format(
      "True middles of the exposures, each with the first camera's nearest. Where cameras are "
      "steered, this is what the alignment reaches and how it drifts.{}",
      camera_note(run));
  return figure;
}

Figure gathering(const RunDetail& run) {
  Figure figure = of_run("gathering", run);
  FigurePanel frames = frames_panel(run, timeline_of(run));
  if (frames.series.empty()) return absent(std::move(figure), "No camera has a scored frame.");
  figure.panels.push_back(std::move(frames));
  FigurePanel sets = sets_panel(run);
  if (!sets.series.empty()) figure.panels.push_back(std::move(sets));
  const evaluation::SetCounts& counts = run.score.sets;
  const auto of = [](std::int64_t count, const char* thing) {
    return counted(static_cast<std::uint64_t>(count), thing);
  };
  figure.caption = fmt::format(
      "{}, {} of them of one pulse; {} partial; {} of {} dropped. All cameras delivered {}.{}",
      of(counts.emitted, "complete set"), counts.pure, counts.partial, run.score.frames.dropped,
      of(run.score.frames.expected, "frame"), of(counts.complete_pulses, "pulse"),
      camera_note(run));
  return figure;
}

Figure stamp_intervals(const RunDetail& run) {
  Figure figure = of_run("stamp_intervals", run);
  struct Stamp {
    const char* title;
    double FrameDetail::*member;
  };
  constexpr Stamp kStamps[] = {
      {"Sensor stamp (middle of the exposure, camera's clock)", &FrameDetail::sensor_ms},
      {"Frame stamp (start of the transmission, camera's clock)", &FrameDetail::frame_ms},
      {"Back-end stamp (copied to the kernel, host's clock)", &FrameDetail::backend_ms},
      {"Time of arrival (delivered, host's clock)", &FrameDetail::arrival_ms}};
  const std::vector<std::size_t> cameras = cameras_of_host(run, 0, 1);
  if (cameras.empty()) return absent(std::move(figure), kNoFrames);
  for (const Stamp& stamp : kStamps) {
    if (is_copy(run.cameras[cameras.front()], stamp.member)) continue;
    FigurePanel made = frame_panel(run, stamp.title, "interval (ms)");
    made.series.push_back(interval_series(run, cameras.front(), stamp.member));
    if (!has_points(made.series.front())) return absent(std::move(figure), kNoFrames);
    figure.panels.push_back(std::move(made));
  }
  figure.caption = fmt::format(
      "Intervals between consecutive frames of {}, nominally {:.3f} ms. A gap is a lost frame.{}",
      camera_label(run, cameras.front()), 1000 / run.frame_rate_hz,
      intervals_text(run, cameras.front()));
  note_lacking_stamps(run, cameras.front(), figure);
  return figure;
}

Figure stamps(const RunDetail& run) {
  Figure figure = of_run("stamps", run);
  FigurePanel sensor = frame_panel(run, "Sensor stamps", "camera's clock (ms)");
  FigurePanel arrival = frame_panel(run, "Arrival stamps", "host's clock (ms)");
  for (const std::size_t camera : cameras_of_host(run, 0, kCamerasOfAHost)) {
    const std::size_t colour = sensor.series.size();
    sensor.series.push_back(raw_series(run, camera, &FrameDetail::sensor_ms, colour));
    arrival.series.push_back(raw_series(run, camera, &FrameDetail::arrival_ms, colour));
  }
  if (!has_stamps(sensor)) return absent(std::move(figure), kNoFrames);
  FigurePanel difference = difference_panel(run, arrival);
  figure.panels = {std::move(sensor), std::move(arrival), std::move(difference)};
  figure.caption = fmt::format("The first {} frames after the warm-up.", kFramesOfStamps) +
                   ranges_text(run, cameras_of_host(run, 0, kCamerasOfAHost));
  if (figure.panels.front().series.size() < kCamerasOfAHost) {
    add_lack(figure, {.what = "three cameras on the host", .scenario = "3cam_1host_30fps"});
  }
  return figure;
}

Figure global_stamps(const RunDetail& run) {
  Figure figure = of_run("global_stamps", run);
  const std::vector<std::size_t> cameras = cameras_of_host(run, 0, kCamerasOfAHost);
  figure.panels = {global_panel(run, "Online: regression over the last 30 frames", cameras,
                                &FrameDetail::online_ms, /*by_host=*/false),
                   global_panel(run, "Offline: regression over all frames", cameras,
                                &FrameDetail::offline_ms, /*by_host=*/false)};
  if (!has_stamps(figure.panels.front())) return absent(std::move(figure), kNoFrames);
  figure.caption =
      "Global stamps by eq. (1) on the cameras of the master host, whichever device_time the "
      "pipeline has. The paper plots the stamps themselves, not their differences to a reference.";
  figure.caption += online_offline_text(run, cameras) + truth_note(run);
  return figure;
}

Figure hosts(const RunDetail& run) {
  Figure figure = of_run("hosts", run);
  std::vector<std::size_t> cameras = cameras_of_host(run, 0, kCamerasOfAHost);
  figure.panels.push_back(
      global_panel(run, "One host", cameras, &FrameDetail::global_ms, /*by_host=*/true));
  const std::vector<std::size_t> others = cameras_of_host(run, 1, kCamerasOfAHost);
  cameras.insert(cameras.end(), others.begin(), others.end());
  if (!others.empty()) {
    figure.panels.push_back(
        global_panel(run, "Two hosts", cameras, &FrameDetail::global_ms, /*by_host=*/true));
  }
  if (!has_stamps(figure.panels.back())) {
    return absent(std::move(figure), "No frame of the first two hosts has a global stamp.");
  }
  figure.caption =
      fmt::format("Global stamps of {}, one colour for each host.{}{}{}", run.pipeline,
                  distance_text(run, cameras), before_synchronisation_note(run), truth_note(run));
  if (others.empty()) {
    add_lack(figure, {.what = "a second host with cameras", .scenario = "6cam_2host_30fps"});
  }
  return figure;
}

Figure first_seconds(const RunDetail& run) {
  Figure figure = of_run("first_seconds", run);
  FigurePanel made = panel("Intervals of the global stamps",
                           "time since the start of the cameras (s)", "interval (ms)");
  std::optional<double> start_ms;
  for (const std::size_t camera : cameras_of_host(run, 0, kCamerasOfAHost)) {
    if (run.cameras[camera].frames.empty()) continue;
    if (!start_ms) start_ms = capture_start_ms(run, run.cameras[camera]);
    made.series.push_back(first_intervals(run, camera, made.series.size()));
  }
  if (!has_stamps(made)) {
    return absent(std::move(figure), "No camera of the master host has two frames in this time.");
  }
  const double warm_s = (run.evaluated_start_ms - *start_ms) / 1000;
  if (warm_s > 0) {
    made.spans.push_back({"warm-up, not scored", 0, std::min(warm_s, kFirstSeconds)});
  }
  const SteadyFacts facts = steady_facts(made.series);
  figure.caption =
      "The pipeline's device_time from each camera's first frame on." + steady_text(facts);
  if (warm_s > 0) {
    figure.caption += fmt::format(" Scores begin after {}.", time_text(warm_s * 1000));
  }
  if (!facts.is_unsteady()) {
    add_lack(figure, {.what = "unsteady intervals in the first 5 s", .scenario = kNominalWorld});
  }
  figure.panels.push_back(std::move(made));
  return figure;
}

std::vector<Figure> run_figures(const RunDetail& run) {
  std::vector<Figure> figures = {stamp_intervals(run), stamps(run),        global_stamps(run),
                                 hosts(run),           first_seconds(run), exposures(run),
                                 host_clocks(run),     gathering(run),     pulse(run)};
  if (run.pulses_code) figures.push_back(coded_trigger(run));
  return figures;
}

}  // namespace simbench::reports

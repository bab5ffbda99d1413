#include "reports/figures/seed_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "recording/counted.h"
#include "reports/figures/caption_facts.h"
#include "reports/figures/figure_parts.h"
#include "reports/text/time_text.h"
#include "scenarios/words.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::OtherFrame;
using evaluation::RunDetail;
using Names = std::span<const std::string_view>;

constexpr double kStepMs = 1000 / kDisplayRateHz;
constexpr std::int64_t kMostReadings = 24;
constexpr double kLeastShare = 0.01;

// Minutes, seconds and whole milliseconds of the display's frame `step`.
std::string reading(std::int64_t step) {
  // A step is 25/3 ms: whole numbers, so that equal steps have equal texts.
  const std::int64_t ms = step >= 0 ? step * 25 / 3 : -((-step * 25 + 2) / 3);
  const std::int64_t in_hour = ((ms % 3'600'000) + 3'600'000) % 3'600'000;
  return fmt::format("{:02}:{:02}.{:03}", in_hour / 60'000, in_hour / 1000 % 60, in_hour % 1000);
}

constexpr std::array<std::string_view, 1> kProposed = {"yoon2021_both"};
constexpr std::array<std::string_view, 4> kWithout = {"ntp_last_set", "ntp_w32time", "free_running",
                                                      "yoon2021_neither"};
constexpr std::array<std::string_view, 1> kGenlock = {"genlock"};
constexpr std::array<std::string_view, 2> kNtp = {"ntp_last_set", "ntp_w32time"};

constexpr std::size_t kPhotographs = 6;
constexpr std::size_t kMostRows = 3;

// The run of the first of these names that has one; null if none has.
const RunDetail* run_named(std::span<const RunDetail> runs, Names names) {
  for (const std::string_view name : names) {
    for (const RunDetail& run : runs) {
      if (run.pipeline == name) return &run;
    }
  }
  return nullptr;
}

// Runs with the smallest and the largest AMD; null if no run has one.
std::pair<const RunDetail*, const RunDetail*> best_and_worst(std::span<const RunDetail> runs) {
  const RunDetail* best = nullptr;
  const RunDetail* worst = nullptr;
  for (const RunDetail& run : runs) {
    if (std::isnan(run.score.amd_ms)) continue;
    if (best == nullptr || run.score.amd_ms < best->score.amd_ms) best = &run;
    if (worst == nullptr || run.score.amd_ms > worst->score.amd_ms) worst = &run;
  }
  return {best, worst};
}

FigurePanel all_cameras(const RunDetail& run, std::string_view what) {
  FigurePanel made =
      panel(fmt::format("{}: {}", what, run.pipeline), frame_axis(run), reference_axis(run));
  made.x_is_pulse = run.has_pulses;
  const CommonReference reference(run, &FrameDetail::global_ms);
  for (std::size_t camera = 0; camera < run.cameras.size(); ++camera) {
    const int colour = static_cast<int>(run.cameras[camera].host);
    made.series.push_back(stamp_series(run, camera, &FrameDetail::global_ms, reference, colour));
  }
  return made;
}

// What one of the two panels shows; nothing if there is none.
std::string distance_of(std::string_view what, const RunDetail* run) {
  if (run == nullptr) return "";
  const std::string distance = distance_text(*run, kept_cameras(*run));
  return distance.empty() ? "" : fmt::format(" {} ({}):{}", what, run->pipeline, distance);
}

// The evaluated frame of the master's first camera in the middle of the capture; null without any.
const FrameDetail* middle_frame(const RunDetail& run) {
  const auto camera = std::find_if(run.cameras.begin(), run.cameras.end(),
                                   [](const CameraDetail& c) { return c.host == 0; });
  if (camera == run.cameras.end()) return nullptr;
  std::vector<const FrameDetail*> frames;
  for (const FrameDetail& frame : camera->frames) {
    if (!std::isnan(frame.global_ms)) frames.push_back(&frame);
  }
  return frames.empty() ? nullptr : frames[frames.size() / 2];
}

// Cameras of as many hosts as there are: the first of each, then the second of each, ...
std::vector<std::size_t> photographers(const RunDetail& run) {
  std::vector<std::size_t> cameras;
  std::size_t hosts = 0;
  for (const CameraDetail& camera : run.cameras) {
    hosts = std::max<std::size_t>(hosts, camera.host + std::size_t{1});
  }
  for (std::size_t turn = 0; turn < run.cameras.size() && cameras.size() < kPhotographs; ++turn) {
    for (std::size_t host = 0; host < hosts && cameras.size() < kPhotographs; ++host) {
      const std::vector<std::size_t> of_host = cameras_of_host(run, host, turn + 1);
      if (of_host.size() > turn) cameras.push_back(of_host[turn]);
    }
  }
  return cameras;
}

// The frame with the nearest global stamp; null without any.
const FrameDetail* nearest_frame(const CameraDetail& camera, double global_ms) {
  const FrameDetail* nearest = nullptr;
  for (const FrameDetail& frame : camera.frames) {
    if (std::isnan(frame.global_ms)) continue;
    if (nearest == nullptr ||
        std::abs(frame.global_ms - global_ms) < std::abs(nearest->global_ms - global_ms)) {
      nearest = &frame;
    }
  }
  return nearest;
}

// An exposure in which a camera photographs the display.
struct Shot {
  std::size_t camera = 0;
  double start_ms = 0;
  double end_ms = 0;

  double middle_ms() const { return (start_ms + end_ms) / 2; }
};

// The shots of a run at one instant: of the scored stream, and of the other where there is one.
struct Shots {
  std::vector<Shot> scored;
  std::vector<Shot> other;
};

// The camera's other frame with the nearest sensor stamp: both are of its clock. Null without any.
const OtherFrame* nearest_other(const CameraDetail& camera, double sensor_ms) {
  const auto distance = [sensor_ms](const OtherFrame& frame) {
    return std::abs(frame.sensor_ms - sensor_ms);
  };
  const auto nearest = std::ranges::min_element(camera.others, {}, distance);
  return nearest == camera.others.end() ? nullptr : &*nearest;
}

Shots shots_of(const RunDetail& run) {
  Shots shots;
  const FrameDetail* middle = middle_frame(run);
  if (middle == nullptr || !run.has_truth) return shots;
  for (const std::size_t camera : photographers(run)) {
    const FrameDetail* frame = nearest_frame(run.cameras[camera], middle->global_ms);
    if (frame == nullptr) continue;
    shots.scored.push_back({camera, frame->exposure_start_ms, frame->exposure_end_ms});
    const OtherFrame* other = nearest_other(run.cameras[camera], frame->sensor_ms);
    if (other == nullptr) continue;
    shots.other.push_back({camera, other->exposure_start_ms, other->exposure_end_ms});
  }
  return shots;
}

// The reading with the largest share.
const std::string& main_reading(const Photograph& photograph) {
  return std::ranges::max_element(photograph.readings, {}, &PhotographedReading::share)->text;
}

// Adds the row of these shots, and to the caption what it shows; nothing without shots.
void add_row(const RunDetail& run, const std::string& label, const std::vector<Shot>& shots,
             Figure& figure) {
  if (shots.empty()) return;
  PhotographRow row{.label = label, .photographs = {}};
  std::map<std::string, std::size_t> cameras_of_reading;
  for (const Shot& shot : shots) {
    row.photographs.push_back(
        {camera_label(run, shot.camera), display_readings(shot.start_ms, shot.end_ms)});
    ++cameras_of_reading[main_reading(row.photographs.back())];
  }
  const auto most = std::ranges::max_element(cameras_of_reading, {},
                                             [](const auto& reading) { return reading.second; });
  const auto [first, last] = std::ranges::minmax(shots, {}, &Shot::middle_ms);
  figure.caption += fmt::format(
      " {}: {} of {} show {} (mostly), middles of the exposures within {}.", label, most->second,
      shots.size(), most->first, time_text(last.middle_ms() - first.middle_ms()));
  figure.photographs.push_back(std::move(row));
}

std::string_view other_of(scenarios::StreamKind stream) {
  using scenarios::StreamKind;
  return to_text(stream == StreamKind::kDepth ? StreamKind::kColour : StreamKind::kDepth);
}

// The figure of runs without any shot, and why.
Figure unphotographed(Figure figure, const std::vector<const RunDetail*>& runs) {
  if (runs.empty() || !runs.front()->has_truth) {
    return without_truth(std::move(figure), "true exposures");
  }
  return absent(std::move(figure),
                fmt::format("No {} frame after the warm-up has a global stamp, since no trigger "
                            "pulse exposes that stream in {}; with /evaluation/stream \"{}\" both "
                            "streams are photographed.",
                            to_text(runs.front()->stream), to_text(runs.front()->sync_mode),
                            other_of(runs.front()->stream)));
}

// Adds the rows of a run: one, or one for each stream.
void add_rows(const RunDetail& run, Figure& figure) {
  const Shots shots = shots_of(run);
  if (shots.other.empty()) return add_row(run, run.pipeline, shots.scored, figure);
  const auto label = [&run](std::string_view stream) {
    return fmt::format("{} in {}, {}", run.pipeline, to_text(run.sync_mode), stream);
  };
  add_row(run, label(to_text(run.stream)), shots.scored, figure);
  add_row(run, label(other_of(run.stream)), shots.other, figure);
}

// The runs of GenLock, the proposed method and NTP that exist, those of each sync mode together,
// else the first ones.
std::vector<const RunDetail*> photographed_runs(std::span<const RunDetail> runs) {
  std::vector<const RunDetail*> chosen;
  for (auto begin = runs.begin(); begin != runs.end();) {
    const auto end = std::find_if(begin, runs.end(), [&begin](const RunDetail& run) {
      return run.sync_mode != begin->sync_mode;
    });
    for (const Names names : {Names(kGenlock), Names(kProposed), Names(kNtp)}) {
      if (const RunDetail* run = run_named({begin, end}, names)) chosen.push_back(run);
    }
    begin = end;
  }
  if (!chosen.empty()) return chosen;
  for (const RunDetail& run : runs.first(std::min(runs.size(), kMostRows))) chosen.push_back(&run);
  return chosen;
}

Figure of_seed(std::string_view id, std::span<const RunDetail> runs) {
  Figure figure = catalogued(id);
  if (!runs.empty()) figure.seed = runs.front().seed;
  return figure;
}

}  // namespace

std::vector<PhotographedReading> display_readings(double start_ms, double end_ms) {
  const auto first = static_cast<std::int64_t>(std::floor(start_ms / kStepMs));
  if (!(end_ms > start_ms)) return {{reading(first), 1}};
  const auto last = std::clamp(static_cast<std::int64_t>(std::ceil(end_ms / kStepMs)) - 1, first,
                               first + kMostReadings - 1);
  const double end = std::min(end_ms, static_cast<double>(last + 1) * kStepMs);
  std::vector<PhotographedReading> readings;
  for (std::int64_t step = first; step <= last; ++step) {
    const double from = std::max(start_ms, static_cast<double>(step) * kStepMs);
    const double to = std::min(end, static_cast<double>(step + 1) * kStepMs);
    readings.push_back({reading(step), (to - from) / (end - start_ms)});
  }
  std::erase_if(readings, [](const PhotographedReading& r) { return r.share < kLeastShare; });
  double sum = 0;
  for (const PhotographedReading& seen : readings) sum += seen.share;
  for (PhotographedReading& seen : readings) seen.share /= sum;
  return readings;
}

Figure synchronisation(std::span<const RunDetail> runs) {
  Figure figure = of_seed("synchronisation", runs);
  const auto [best, worst] = best_and_worst(runs);
  const RunDetail* without = run_named(runs, kWithout);
  const RunDetail* with = run_named(runs, kProposed);
  const bool stand_in = without == nullptr || with == nullptr;
  if (without == nullptr && worst != with) without = worst;
  if (with == nullptr && best != without) with = best;
  if (without == nullptr && with == nullptr) {
    return absent(std::move(figure), "No pulse was delivered by all cameras of a pipeline.");
  }
  if (without != nullptr) figure.panels.push_back(all_cameras(*without, "Without"));
  if (with != nullptr) figure.panels.push_back(all_cameras(*with, "With"));
  const RunDetail& shown = with != nullptr ? *with : *without;
  figure.caption = fmt::format(
      "Global stamps of {} on {}, one colour for each host; the scales differ.{}{}{}{}{}",
      counted(shown.camera_count, "camera"), counted(shown.host_count, "host"),
      distance_of("Without", without), distance_of("With", with),
      stand_in
          ? " The results do not have all of the paper's pipelines; those with the largest and "
            "the smallest AMD replace them."
          : "",
      camera_note(shown), truth_note(shown));
  return figure;
}

Figure digital_clocks(std::span<const RunDetail> runs) {
  Figure figure = of_seed("digital_clocks", runs);
  figure.caption = fmt::format(
      "Simulated photographs of a clock on a {:.0f} Hz display, in the frames that each pipeline "
      "takes for simultaneous (global stamps nearest to the master's first camera, in the middle "
      "of the capture). Equal readings mean exposures in the same steps of {:.1f} ms, no more; an "
      "exposure across a step shows both readings, with their shares.",
      kDisplayRateHz, 1000 / kDisplayRateHz);
  const std::vector<const RunDetail*> photographed = photographed_runs(runs);
  for (const RunDetail* run : photographed) add_rows(*run, figure);
  if (figure.photographs.empty()) return unphotographed(std::move(figure), photographed);
  const RunDetail& first = *photographed.front();
  if (figure.photographs.size() > photographed.size()) {
    figure.caption += fmt::format(
        " The {} is each camera's frame whose sensor stamp is nearest to that of its {}.",
        other_of(first.stream), to_text(first.stream));
  } else {
    add_lack(figure, {.what = fmt::format("{} frames", other_of(first.stream)),
                      .scenario = "18cam_6host_90fps_full_slave",
                      .was_recorded = false});
  }
  return figure;
}

std::vector<Figure> seed_figures(std::span<const RunDetail> runs) {
  return {synchronisation(runs), digital_clocks(runs)};
}

}  // namespace simbench::reports

#include "reports/figures/seed_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "recording/counted.h"
#include "reports/figures/figure_parts.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
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

// Without photographs if there is nothing to photograph.
PhotographRow photograph_row(const RunDetail& run) {
  PhotographRow row{.label = run.pipeline, .photographs = {}};
  const FrameDetail* middle = middle_frame(run);
  if (middle == nullptr || !run.has_truth) return row;
  for (const std::size_t camera : photographers(run)) {
    const FrameDetail* frame = nearest_frame(run.cameras[camera], middle->global_ms);
    if (frame == nullptr) continue;
    row.photographs.push_back({camera_label(run, camera),
                               display_readings(frame->exposure_start_ms, frame->exposure_end_ms)});
  }
  return row;
}

// The runs of GenLock, the proposed method and NTP that exist, else the first ones.
std::vector<const RunDetail*> photographed_runs(std::span<const RunDetail> runs) {
  std::vector<const RunDetail*> chosen;
  for (const Names names : {Names(kGenlock), Names(kProposed), Names(kNtp)}) {
    if (const RunDetail* run = run_named(runs, names)) chosen.push_back(run);
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
      "Global stamps of {} on {}, one colour for each host. Note the different "
      "scales: cameras of one host agree without synchronisation, hosts do not.{}{}{}",
      counted(shown.camera_count, "camera"), counted(shown.host_count, "host"),
      stand_in
          ? " The results do not have all of the paper's pipelines; those with the largest and "
            "the smallest AMD replace them."
          : "",
      camera_note(shown), truth_note(shown));
  return figure;
}

Figure digital_clocks(std::span<const RunDetail> runs) {
  Figure figure = of_seed("digital_clocks", runs);
  for (const RunDetail* run : photographed_runs(runs)) {
    PhotographRow row = photograph_row(*run);
    if (!row.photographs.empty()) figure.photographs.push_back(std::move(row));
  }
  if (figure.photographs.empty()) {
    return absent(std::move(figure), "Photographs need frames and their true exposures.");
  }
  figure.caption = fmt::format(
      "Simulated photographs of a clock on a {:.0f} Hz display, in the frames that each pipeline "
      "takes for simultaneous (global stamps nearest to the master's first camera, in the middle "
      "of the capture). Equal readings mean cameras that are synchronised within the display's "
      "steps of {:.1f} ms; an exposure across a step shows both readings, with their shares.",
      kDisplayRateHz, 1000 / kDisplayRateHz);
  return figure;
}

std::vector<Figure> seed_figures(std::span<const RunDetail> runs) {
  return {synchronisation(runs), digital_clocks(runs)};
}

}  // namespace simbench::reports

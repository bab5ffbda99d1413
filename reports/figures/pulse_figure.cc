#include "reports/figures/pulse_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "reports/figures/figure_parts.h"
#include "reports/text/time_text.h"

namespace simbench::reports {
namespace {

using evaluation::CameraDetail;
using evaluation::FrameDetail;
using evaluation::RunDetail;

// The scored frame of each camera that has the pulse; null where there is none.
std::vector<const FrameDetail*> frames_of_pulse(const RunDetail& run, std::int64_t pulse) {
  std::vector<const FrameDetail*> frames;
  for (const CameraDetail& camera : run.cameras) {
    const auto found = std::ranges::find_if(camera.frames, [pulse](const FrameDetail& frame) {
      return frame.evaluated && frame.pulse == pulse;
    });
    frames.push_back(found == camera.frames.end() ? nullptr : &*found);
  }
  return frames;
}

// The middle one of the pulses that most cameras have; -1: there is none.
std::int64_t shown_pulse(const RunDetail& run) {
  std::map<std::int64_t, int> cameras;
  for (const CameraDetail& camera : run.cameras) {
    for (const FrameDetail& frame : camera.frames) {
      if (frame.evaluated && frame.pulse >= 0) ++cameras[frame.pulse];
    }
  }
  if (cameras.empty()) return -1;
  const int most =
      std::ranges::max_element(cameras, {}, [](const auto& each) { return each.second; })->second;
  std::vector<std::int64_t> candidates;
  for (const auto& [pulse, count] : cameras) {
    if (count == most) candidates.push_back(pulse);
  }
  return candidates[candidates.size() / 2];
}

// What has become of the pulse in gathering, a sentence; "" if no set has it.
std::string set_text(const RunDetail& run, std::int64_t pulse) {
  const auto set = std::ranges::find_if(
      run.sets, [pulse](const evaluation::SetDetail& each) { return each.pulse == pulse; });
  if (set == run.sets.end()) return " No set has its frames.";
  return fmt::format(" Gathered in one set{}{}, whose stamps lie within {}.",
                     set->complete ? "" : " that lacks cameras",
                     set->pure ? "" : " with frames of other pulses", time_text(set->range_ms));
}

struct PulsePanel {
  FigurePanel panel;
  FigureSeries arrivals;
  FigureSeries stamps;
};

// `zero_ms`: on the master's clock; `clock_ms`: the master's clock less true time.
void add_frame(const FrameDetail& frame, double row, double zero_ms, double clock_ms,
               PulsePanel& made) {
  if (!std::isnan(frame.exposure_start_ms)) {
    FigureSeries exposure = series("exposed", Mark::kLine, 0);
    exposure.add(frame.exposure_start_ms + clock_ms - zero_ms, row);
    exposure.add(frame.exposure_end_ms + clock_ms - zero_ms, row);
    made.panel.series.push_back(std::move(exposure));
  }
  made.arrivals.add(frame.arrival_ms - zero_ms, row);
  if (!std::isnan(frame.global_ms)) made.stamps.add(frame.global_ms - zero_ms, row);
}

}  // namespace

Figure pulse(const RunDetail& run) {
  Figure figure = of_run("pulse", run);
  const std::int64_t shown = run.has_pulses ? shown_pulse(run) : -1;
  if (shown < 0) {
    return absent(std::move(figure), "It is not known which frames are of one pulse.");
  }
  const std::vector<const FrameDetail*> frames = frames_of_pulse(run, shown);
  const FrameDetail& first =
      **std::ranges::find_if(frames, [](const FrameDetail* frame) { return frame != nullptr; });
  const double zero_ms = CommonReference(run, &FrameDetail::global_ms).of(first);
  if (std::isnan(zero_ms)) {
    return absent(std::move(figure), "The frames of no pulse have stamps to compare.");
  }
  const double clock_ms = zero_ms - first.mid_exposure_ms();
  PulsePanel made{
      .panel = panel("", "master's clock since the middle of the exposure (ms)", "camera"),
      .arrivals = series("handed to the program, by its host's clock", Mark::kPoints, 1),
      .stamps = series("time that the pipeline gives it", Mark::kPoints, 2)};
  for (std::size_t camera = 0; camera < frames.size(); ++camera) {
    if (frames[camera] == nullptr) continue;
    add_frame(*frames[camera], static_cast<double>(camera), zero_ms, clock_ms, made);
  }
  made.panel.series.push_back(std::move(made.arrivals));
  made.panel.series.push_back(std::move(made.stamps));
  figure.panels.push_back(std::move(made.panel));
  figure.caption =
      fmt::format("Pulse {}: a row is a camera.{}{}{}", shown, set_text(run, shown),
                  run.has_truth ? "" : " Zero is the median of its stamps.", camera_note(run));
  return figure;
}

}  // namespace simbench::reports

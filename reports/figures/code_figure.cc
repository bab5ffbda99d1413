#include "reports/figures/code_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/coded_trigger/code_search.h"
#include "algorithms/coded_trigger/coded_pulses.h"
#include "reports/figures/figure_parts.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::FrameDetail;
using evaluation::RunDetail;

constexpr std::size_t kCamerasOfCode = 3;
constexpr std::size_t kPulsesOfCode = 60;
constexpr double kUsPerMs = 1e3;

// The first evaluated frames of a camera that pulses exposed.
std::vector<const FrameDetail*> first_frames(const RunDetail& run, std::size_t camera) {
  std::vector<const FrameDetail*> frames;
  for (const FrameDetail& frame : run.cameras[camera].frames) {
    if (!frame.evaluated || frame.pulse < 0) continue;
    frames.push_back(&frame);
    if (frames.size() == kPulsesOfCode) break;
  }
  return frames;
}

double code_shift_us(const RunDetail& run, std::int64_t pulse) {
  return to_ns(run.pulses_code->code.shift(pulse)) * 1e-3;
}

// The stamps in microseconds from the first one's, less the period of each pulse since.
std::vector<double> residuals_us(const RunDetail& run,
                                 const std::vector<const FrameDetail*>& frames) {
  const double period_us = to_ns(run.pulses_code->code.period()) * 1e-3;
  std::vector<double> residuals;
  for (const FrameDetail* frame : frames) {
    const double since_us = (frame->sensor_ms - frames.front()->sensor_ms) * kUsPerMs;
    residuals.push_back(since_us -
                        period_us * static_cast<double>(frame->pulse - frames.front()->pulse));
  }
  return residuals;
}

// What is left of the stamps without the camera's level and rate: the shifts, and noise.
FigureSeries shown_shifts(const RunDetail& run, std::size_t camera, int colour) {
  FigureSeries shown = series(camera_label(run, camera), Mark::kPoints, colour);
  const std::vector<const FrameDetail*> frames = first_frames(run, camera);
  const std::vector<double> residuals = residuals_us(run, frames);
  double n = 0;
  double x_sum = 0;
  double y_sum = 0;
  double xx_sum = 0;
  double xy_sum = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto x = static_cast<double>(frames[i]->pulse - frames.front()->pulse);
    const double y = residuals[i] - code_shift_us(run, frames[i]->pulse);
    n += 1;
    x_sum += x;
    y_sum += y;
    xx_sum += x * x;
    xy_sum += x * y;
  }
  const double spread = n * xx_sum - x_sum * x_sum;
  const double slope = spread > 0 ? (n * xy_sum - x_sum * y_sum) / spread : 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto x = static_cast<double>(frames[i]->pulse - frames.front()->pulse);
    const double line = (y_sum - slope * x_sum) / n + slope * x;
    shown.add(static_cast<double>(frames[i]->pulse), residuals[i] - line);
  }
  return shown;
}

FigureSeries code_itself(const RunDetail& run, int colour) {
  FigureSeries code = series("the code", Mark::kSteps, colour);
  for (std::int64_t pulse = run.first_pulse;
       pulse < run.first_pulse + static_cast<std::int64_t>(kPulsesOfCode); ++pulse) {
    if (run.pulses_code->code.is_sent(pulse)) {
      code.add(static_cast<double>(pulse), code_shift_us(run, pulse));
    }
  }
  return code;
}

// The probability of all other places while a search goes on, with the default settings.
FigureSeries search_of(const RunDetail& run, std::size_t camera, int colour) {
  FigureSeries found = series(camera_label(run, camera), Mark::kMarkedLine, colour);
  const std::vector<const FrameDetail*> frames = first_frames(run, camera);
  CodeSearch search(run.pulses_code, {});
  for (const FrameDetail* frame : frames) {
    const CodeSearch::Outcome outcome = search.add(std::llround(frame->sensor_ms * 1e6));
    if (search.held() >= CodeSearch::kFirstLook) {
      found.add(static_cast<double>(search.held()), search.verdict().error_probability);
    }
    if (outcome.is_found) break;
  }
  return found;
}

}  // namespace

Figure coded_trigger(const RunDetail& run) {
  Figure figure = of_run(kCodeFigure, run);
  FigurePanel shifts = panel("Pulses as the cameras' own clocks show them", "pulse",
                             "sensor stamp less the even grid (us)");
  FigurePanel searches =
      panel("The search for the place in the code", "frames", "probability of all other places");
  searches.log_y = true;
  for (std::size_t host = 0; host < run.host_count && shifts.series.size() < kCamerasOfCode;
       ++host) {
    for (const std::size_t camera : cameras_of_host(run, host, 1)) {
      if (first_frames(run, camera).size() < CodeSearch::kFirstLook) continue;
      const auto colour = static_cast<int>(shifts.series.size());
      shifts.series.push_back(shown_shifts(run, camera, colour));
      searches.series.push_back(search_of(run, camera, colour));
    }
  }
  if (shifts.series.empty()) {
    return absent(std::move(figure), "No camera has enough frames whose pulse is known.");
  }
  shifts.x_is_pulse = true;
  shifts.series.push_back(code_itself(run, static_cast<int>(shifts.series.size())));
  figure.panels = {std::move(shifts), std::move(searches)};
  figure.caption = fmt::format(
      "The first {} evaluated pulses. Each camera's level and rate are taken off; what is left is "
      "the code and the noise of its stamps.",
      kPulsesOfCode);
  if (const auto& search = run.score.search) {
    figure.caption +=
        fmt::format(" {} of {} cameras found their place, from at most {} frames in {} s.",
                    search->found, search->sources, search->frames, number_text(search->seconds));
  }
  return figure;
}

}  // namespace simbench::reports

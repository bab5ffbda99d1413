// Small hand-made figures for the tests of the HTML report: every mark, line, span and gap once.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "reports/figures/figure.h"

namespace simbench::reports {

// Curves over pulses 225 ... 225 + n - 1 with a gap, a published value and a warm-up.
inline Figure sample_curves(const std::string& pipeline, std::uint64_t seed, int n = 300) {
  FigureSeries spread{.label = "spread", .mark = Mark::kLine, .x = {}, .y = {}, .colour = 0};
  FigureSeries deviation{.label = "deviation", .mark = Mark::kSteps, .x = {}, .y = {}, .colour = 1};
  for (int i = 0; i < n; ++i) {
    const double y = 2 + std::sin(0.05 * i * static_cast<double>(seed)) + (i == n / 2 ? 3 : 0);
    spread.x.push_back(225 + i);
    spread.y.push_back(i == n / 3 ? std::numeric_limits<double>::quiet_NaN() : y);
    deviation.x.push_back(225 + i);
    deviation.y.push_back(y / 2);
  }
  return {.id = "frame_errors",
          .title = "Error of every pulse",
          .caption = "Range and RMS deviation of the stamps of each pulse.",
          .paper = "Fig. 9, 10",
          .pipeline = pipeline,
          .seed = seed,
          .panels = {{.title = "spread",
                      .x_label = "pulse",
                      .y_label = "ms",
                      .series = {spread, deviation},
                      .lines = {{.label = "published AMD", .vertical = false, .at = 2.438}},
                      .spans = {{.label = "warm-up", .from = 225, .to = 260}},
                      .x_is_pulse = true}}};
}

// A cloud of many cameras, each with its own x, not in order.
inline Figure sample_cloud(int cameras = 18, int frames = 60) {
  FigurePanel panel{.title = "stamps", .x_label = "time, s", .y_label = "ms"};
  for (int camera = 0; camera < cameras; ++camera) {
    FigureSeries cloud{.label = "camera " + std::to_string(camera), .x = {}, .y = {}};
    cloud.colour = camera;
    for (int i = frames - 1; i >= 0; --i) {
      cloud.x.push_back(i / 45.0 + 0.001 * camera);
      cloud.y.push_back(camera + std::sin(0.2 * i));
    }
    panel.series.push_back(cloud);
  }
  return {.id = "stamps", .title = "Stamps", .caption = "", .paper = "Fig. 8", .panels = {panel}};
}

// Bars of named stages, and a logarithmic axis.
inline Figure sample_bars() {
  const FigureSeries mean{
      .label = "mean", .mark = Mark::kBars, .x = {0, 1, 2}, .y = {1, -0.25, 0.5}, .colour = 0};
  const FigureSeries high{
      .label = "95 %", .mark = Mark::kBars, .x = {0, 1, 2}, .y = {1.5, 0.1, 0.75}, .colour = 1};
  const FigureSeries deviation{
      .label = "oscillator", .mark = Mark::kLine, .x = {1, 2, 4, 8}, .y = {1e-9, 1e-8, 1e-7, 1e-6}};
  return {.id = "budget",
          .title = "Error budget",
          .caption = "What each stage adds.",
          .paper = "",
          .panels = {{.title = "AMD",
                      .x_label = "",
                      .y_label = "ms",
                      .series = {mean, high},
                      .categories = {"host_sync", "device_time", "gathering of sets"}},
                     {.title = "Allan deviation",
                      .x_label = "s",
                      .y_label = "1",
                      .series = {deviation},
                      .lines = {{.label = "half a minute", .vertical = true, .at = 4}},
                      .log_y = true}}};
}

// Photographs of a millisecond clock: sharp and ghosted.
inline Figure sample_photographs() {
  const auto row = [](const std::string& label, double sharp) {
    PhotographRow photographs{.label = label, .photographs = {}};
    for (int i = 0; i < 6; ++i) {
      photographs.photographs.push_back(
          {.label = "camera " + std::to_string(i),
           .readings = {{.text = "00:12.345", .share = sharp},
                        {.text = "00:12.35" + std::to_string(i), .share = 1 - sharp}}});
    }
    return photographs;
  };
  return {.id = "digital_clocks",
          .title = "Six cameras, one clock",
          .caption = "",
          .paper = "Fig. 11, 12, 13",
          .photographs = {row("genlock", 1), row("yoon2021_both", 0.6)}};
}

inline Figure sample_absent() {
  return {.id = "hosts",
          .title = "Hosts",
          .caption = "",
          .paper = "Fig. 5",
          .absent = "This scenario has one host."};
}

inline std::vector<Figure> sample_figures() {
  return {sample_curves("yoon2021_both", 1),
          sample_curves("yoon2021_both", 2),
          sample_curves("free_running", 1),
          sample_cloud(),
          sample_bars(),
          sample_photographs(),
          sample_absent()};
}

}  // namespace simbench::reports

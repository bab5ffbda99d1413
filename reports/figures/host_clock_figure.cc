#include "reports/figures/host_clock_figure.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "evaluation/stability/log_stability.h"
#include "evaluation/stability/stability.h"
#include "reports/figures/figure_parts.h"

namespace simbench::reports {
namespace {

using evaluation::ClockErrors;
using evaluation::RunDetail;

constexpr std::size_t kFewestOfMtie = 16;  // readings of a clock

FigurePanel clock_panel(const RunDetail& run, std::string title, double from_ms) {
  FigurePanel made = panel(std::move(title), "true time since the start of synchronisation (s)",
                           "clock minus the master's (ms)");
  const std::size_t hosts = run.clocks.front().errors_ms.size();
  for (std::size_t host = 1; host < hosts; ++host) {
    FigureSeries curve =
        series("host " + std::to_string(host), Mark::kLine, static_cast<int>(host));
    for (const ClockErrors& clocks : run.clocks) {
      if (clocks.at_ms < from_ms) continue;
      curve.add(clocks.at_ms / 1000, clocks.errors_ms[host]);
    }
    made.series.push_back(thinned(std::move(curve), kMostPoints));
  }
  if (run.service) {
    add_span("service before the capture", run.world_start_ms, run.capture_start_ms, from_ms, made);
  } else {
    add_span("synchronisation", run.world_start_ms, run.sync_end_ms, from_ms, made);
  }
  add_span("warm-up", run.capture_start_ms, run.evaluated_start_ms, from_ms, made);
  add_span("scored", run.evaluated_start_ms, run.capture_end_ms, from_ms, made);
  return made;
}

// The largest change of each clock's error within any stretch of a length, over the scored capture.
FigurePanel mtie_panel(const RunDetail& run) {
  FigurePanel made = panel("MTIE of the scored capture", "observation interval (s)",
                           "largest change of the error (ms)");
  made.log_x = true;
  made.log_y = true;
  for (std::size_t host = 1; host < run.clocks.front().errors_ms.size(); ++host) {
    evaluation::LogPoints log;
    for (const ClockErrors& clocks : run.clocks) {
      if (!(clocks.at_ms >= run.evaluated_start_ms && clocks.at_ms <= run.capture_end_ms)) continue;
      const auto at_us = static_cast<std::int64_t>(std::llround(clocks.at_ms * 1000));
      log.points.push_back({Microseconds(at_us), clocks.errors_ms[host] / 1000});
    }
    if (log.points.size() < kFewestOfMtie) break;
    FigureSeries curve =
        series("host " + std::to_string(host), Mark::kMarkedLine, static_cast<int>(host));
    const evaluation::EvenSeries even =
        evaluation::evenly_spaced(log, 1 / run.frame_rate_hz, evaluation::kGridShare);
    for (const evaluation::StabilityPoint& point :
         evaluation::deviation_over_octaves(even.series, evaluation::Deviation::kMtie)) {
      if (point.value > 0) curve.add(point.tau_s, 1000 * point.value);
    }
    if (!curve.x.empty()) made.series.push_back(std::move(curve));
  }
  return made;
}

}  // namespace

Figure host_clocks(const RunDetail& run) {
  Figure figure = of_run("host_clocks", run);
  if (run.host_count < 2) {
    return absent(std::move(figure), "There is one host: its clock is the master's.");
  }
  if (run.clocks.empty()) {
    return without_truth(std::move(figure), "true errors of the hosts' clocks");
  }
  constexpr double kAll = -std::numeric_limits<double>::infinity();
  figure.panels.push_back(clock_panel(run, "All of the run", kAll));
  const double settled_ms = run.service ? run.capture_start_ms : run.sync_end_ms;
  if (settled_ms > run.clocks.front().at_ms && settled_ms < run.clocks.back().at_ms) {
    figure.panels.push_back(
        clock_panel(run, run.service ? "The capture" : "After synchronisation", settled_ms));
  }
  if (FigurePanel mtie = mtie_panel(run); !mtie.series.empty()) {
    figure.panels.push_back(std::move(mtie));
  }
  figure.caption = "System clock of each slave host minus the master's at the same instant.";
  if (run.clocks.size() > 1) {
    figure.caption += fmt::format(" Sampled every {:.0f} ms, and at every scored pulse.",
                                  run.clocks[1].at_ms - run.clocks[0].at_ms);
  }
  if (run.host_count > run.clocks.front().errors_ms.size()) {
    figure.caption += " Only the first " + std::to_string(run.clocks.front().errors_ms.size()) +
                      " of " + std::to_string(run.host_count) + " hosts are drawn.";
  }
  return figure;
}

}  // namespace simbench::reports

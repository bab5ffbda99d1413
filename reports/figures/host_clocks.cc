#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "reports/figures/figure_parts.h"
#include "reports/figures/run_figures.h"
#include "reports/figures/thin.h"

namespace simbench::reports {
namespace {

using evaluation::ClockErrors;
using evaluation::RunDetail;

void add_span(std::string label, double from_ms, double to_ms, double panel_from_ms,
              FigurePanel& panel) {
  const double from = std::fmax(from_ms, panel_from_ms);
  if (!(to_ms > from)) return;  // also where one of them is not known
  panel.spans.push_back({std::move(label), from / 1000, to_ms / 1000});
}

FigurePanel clock_panel(const RunDetail& run, std::string title, double from_ms) {
  FigurePanel made = panel(std::move(title), "true time since the start of synchronisation (s)",
                           "clock minus the master's (ms)");
  const std::size_t hosts = run.clocks.front().errors_ms.size();
  for (std::size_t host = 1; host < hosts; ++host) {
    FigureSeries curve =
        series("host " + std::to_string(host), Mark::kLine, static_cast<int>(host));
    for (const ClockErrors& clocks : run.clocks) {
      if (clocks.at_ms < from_ms) continue;
      curve.x.push_back(clocks.at_ms / 1000);
      curve.y.push_back(clocks.errors_ms[host]);
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

}  // namespace

Figure host_clocks(const RunDetail& run) {
  Figure figure = of_run("host_clocks", run);
  if (run.host_count < 2) {
    return absent(std::move(figure), "There is one host: its clock is the master's.");
  }
  if (run.clocks.empty()) {
    return absent(std::move(figure), "Only a simulated world shows its clocks.");
  }
  constexpr double kAll = -std::numeric_limits<double>::infinity();
  figure.panels.push_back(clock_panel(run, "All of the run", kAll));
  const double settled_ms = run.service ? run.capture_start_ms : run.sync_end_ms;
  if (settled_ms > run.clocks.front().at_ms && settled_ms < run.clocks.back().at_ms) {
    figure.panels.push_back(
        clock_panel(run, run.service ? "The capture" : "After synchronisation", settled_ms));
  }
  figure.caption = "System clock of each slave host minus the master's at the same instant.";
  if (run.clocks.size() > 1) {
    figure.caption += fmt::format(" Looked at every {:.0f} ms, and at every scored pulse.",
                                  run.clocks[1].at_ms - run.clocks[0].at_ms);
  }
  if (run.host_count > run.clocks.front().errors_ms.size()) {
    figure.caption += " Only the first " + std::to_string(run.clocks.front().errors_ms.size()) +
                      " of " + std::to_string(run.host_count) + " hosts are drawn.";
  }
  return figure;
}

}  // namespace simbench::reports

#include "reports/figures/budget_figure.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "evaluation/budget/ideal_world.h"
#include "reports/figures/figure_parts.h"
#include "reports/text/number_text.h"

namespace simbench::reports {
namespace {

using evaluation::Budget;
using evaluation::BudgetPart;
using evaluation::ErrorParts;

FigurePanel parts_panel(const std::string& title, const ErrorParts& parts) {
  FigurePanel made =
      panel(fmt::format("{}: {} ms in all", title, number_text(parts.total.mean)), "", "part (ms)");
  FigureSeries bars = series("mean over seeds", Mark::kBars, 0);
  FigureSeries low = series("5 %", Mark::kPoints, 1);
  FigureSeries high = series("95 %", Mark::kPoints, 2);
  const auto add = [&](const std::string& name, const BudgetPart& part) {
    const auto x = static_cast<double>(made.categories.size());
    made.categories.push_back(name);
    for (FigureSeries* each : {&bars, &low, &high}) each->x.push_back(x);
    bars.y.push_back(part.mean);
    low.y.push_back(part.p05);
    high.y.push_back(part.p95);
  };
  for (std::size_t stage = 0; stage < parts.stages.size(); ++stage) {
    add(std::string(evaluation::kStageNames[stage]), parts.stages[stage]);
  }
  add("remainder", parts.remainder);
  made.series = {std::move(bars), std::move(low), std::move(high)};
  return made;
}

}  // namespace

Figure budget_figure(const Budget& budget) {
  Figure figure = catalogued("budget");
  figure.pipeline = budget.pipeline;
  const char* over = budget.amd_of_sets ? "gathered sets" : "true pulses";
  struct Named {
    std::string title;
    const ErrorParts* parts;
  };
  for (const Named& error :
       {Named{fmt::format("AMD of {}", over), &budget.amd_ms},
        Named{fmt::format("Absolute error of {}", over), &budget.absolute_error_ms},
        Named{"Physical spread of the exposures", &budget.physical_ms}}) {
    if (std::isnan(error.parts->total.mean)) continue;
    figure.panels.push_back(parts_panel(error.title, *error.parts));
  }
  if (figure.panels.empty()) return absent(std::move(figure), "No seed has an error to divide.");
  figure.caption = fmt::format(
      "What an ideal stage would take off the error, averaged over all orders in which the stages "
      "can be replaced (Shapley values), {} seeds. Parts and remainder add up to the whole; a part "
      "below zero cancels another.",
      budget.amd_ms.total.values.size());
  return figure;
}

}  // namespace simbench::reports

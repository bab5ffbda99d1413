// What the blocks and figures of sweeps have in common.
#pragma once

#include <string>
#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/figures/figure.h"
#include "reports/text/block.h"
#include "reports/text/number_text.h"

namespace simbench::reports {

inline bool of_clocks(const evaluation::SweepPlan& plan) {
  return plan.kind == evaluation::ResultKind::kClockRuns;
}

// The scenario, and how many points, pipelines and seeds.
std::string sweep_heading(const evaluation::SweepPlan& plan);

// The columns of the swept values, and their cells at a point.
std::vector<Column> value_columns(const evaluation::SweepPlan& plan);

// The same and that of the pipeline, and their cells in a row.
std::vector<Column> point_columns(const evaluation::SweepPlan& plan);
std::vector<std::string> point_cells(const evaluation::SweepPlan& plan,
                                     const evaluation::ResponseRow& row);

Figure new_sweep_figure(const evaluation::SweepPlan& plan, const std::string& id,
                        const std::string& title);

// The most curves of a panel.
inline constexpr std::size_t kMostCurves = 24;

// The next curve of the panel; null if it has the most curves already.
FigureSeries* add_curve(FigurePanel& panel, const std::string& label, Mark mark);

// A zero keeps the axis linear: it would be a gap in a response.
void use_log_scale_if_wide(FigurePanel& panel);

}  // namespace simbench::reports

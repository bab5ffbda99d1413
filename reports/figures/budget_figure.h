// The error budget of a pipeline as bars: the part of each stage, and what remains.
#ifndef SIMBENCH_REPORTS_FIGURES_BUDGET_FIGURE_H_
#define SIMBENCH_REPORTS_FIGURES_BUDGET_FIGURE_H_

#include "evaluation/budget.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Means over seeds with the bands' ends as a second and third series of bars' marks: a panel each
// for AMD, absolute error and the physical spread.
Figure budget_figure(const evaluation::Budget& budget);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_BUDGET_FIGURE_H_

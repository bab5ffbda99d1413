// The error budget of a pipeline as bars: the part of each stage, and what remains.
#ifndef SIMBENCH_REPORTS_FIGURES_BUDGET_FIGURE_H_
#define SIMBENCH_REPORTS_FIGURES_BUDGET_FIGURE_H_

#include "evaluation/budget/budget.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// A panel each for AMD, the absolute error and the physical spread: means over the seeds as bars,
// the ends of the band from 5 to 95 % as points.
Figure budget_figure(const evaluation::Budget& budget);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_FIGURES_BUDGET_FIGURE_H_

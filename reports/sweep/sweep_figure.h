// The results of a sweep as a figure (reports/figures/figure.h), which anything that draws figures
// can draw.
//
// x is the first axis of the sweep: its first pointer's values, or 1, 2, ... where these are words.
// There is a curve for each pipeline and each step of the other axes.
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_FIGURE_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_FIGURE_H_

#include <string>
#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Panels of median AMD, absolute error, recall and margin. With no more than one point there is
// nothing to draw (Figure::absent).
Figure response_figure(const evaluation::SweepPlan& plan,
                       const std::vector<evaluation::ResponseRow>& rows);

// One panel: each host's median clock error, in the order of the sessions.
Figure host_order_figure(const evaluation::SweepPlan& plan,
                         const std::vector<evaluation::ResponseRow>& rows);

// One panel: how far the median AMD of n seeds is from that of all, in percent, against n.
Figure seeds_needed_figure(const evaluation::SweepPlan& plan,
                           const std::vector<evaluation::ResponseRow>& rows);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_SWEEP_SWEEP_FIGURE_H_

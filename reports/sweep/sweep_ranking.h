// Sweeps in which pipelines compete: their order along an axis, and what they reach for the packets
// that they send.
//
// The metric is what a leaderboard sorts by: of captures the absolute error, of the hosts' clocks
// alone the spread.
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_RANKING_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_RANKING_H_

#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/figures/figure.h"
#include "reports/text/block.h"

namespace simbench::reports {

// The order of the pipelines at each point, and between which values of the first axis it flips
// (evaluation/sweep/ranking.h).
Block ranking_block(const evaluation::SweepPlan& plan,
                    const std::vector<evaluation::ResponseRow>& rows);

// The metric beside the packets per second that all hosts together sent, pipeline by pipeline.
Block packets_block(const evaluation::SweepPlan& plan,
                    const std::vector<evaluation::ResponseRow>& rows);

// The same as curves over packets per second.
Figure packets_figure(const evaluation::SweepPlan& plan,
                      const std::vector<evaluation::ResponseRow>& rows);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_SWEEP_SWEEP_RANKING_H_

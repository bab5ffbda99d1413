// Sweeps in which pipelines compete: their order along an axis, and what they reach for the packets
// that they send.
//
// The metric is what a leaderboard sorts by: of captures the absolute error, of the hosts' clocks
// alone the spread.
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_RANKING_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_RANKING_H_

#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "evaluation/sweep/ranking.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/figures/figure.h"
#include "reports/text/block.h"

namespace simbench::reports {

const evaluation::Metric& ranked_metric(const evaluation::SweepPlan& plan);

// A point by the first pointer of each axis; what goes in lockstep with it is in the table.
std::string leading_text(const evaluation::SweepPlan& plan, std::size_t point);

// "chrony is better than ntp up to /hosts/count=2, worse from /hosts/count=4 on."
std::string flip_text(const evaluation::SweepPlan& plan, const evaluation::RankingFlip& flip);

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

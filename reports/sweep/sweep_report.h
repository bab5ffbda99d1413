// The results of a sweep: the answer and blocks for people, CSV for scripts, figures.
//
// Where pipelines compete, the metric is what a leaderboard sorts by: of captures the absolute
// error, of the hosts' clocks alone the spread.
//
//   document.head = paragraphs(sweep_answer(plan, rows));
#pragma once

#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "evaluation/sweep/ranking.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/figures/figure.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"

namespace simbench::reports {

// The manifest of a sweep, which identifies it (reports/sweep/sweep_folder.h). `study`: its name or
// "".
std::string sweep_manifest(const evaluation::SweepPlan& plan, const std::string& study);

// sweep.csv, one line for each point, pipeline and seed: the swept values under their JSON
// pointers, pipeline, seed, and the columns of evaluation::sweep_metrics(). Numbers are the
// shortest that read back as the same double; a value that does not exist is an empty cell. A
// last column has the changes of a scenario that is changed at all points.
std::string sweep_csv(const evaluation::SweepPlan& plan,
                      const std::vector<evaluation::SweepScore>& scores);

// hosts.csv, one line for each host of each of these: the same, then host (0 is the master) and
// error_ms, its mean clock error.
std::string sweep_hosts_csv(const evaluation::SweepPlan& plan,
                            const std::vector<evaluation::SweepScore>& scores);

// Which pipeline that a rig can run is best at how many points and between which values, where two
// change places, which swept parameter matters most, whether its sets can be trusted, and how
// certain that is. Pipelines that need the truth, and references, are left out, and those that
// failed at a point have no value there (evaluation/sweep/sweep_standing.h). `rows`, here and
// below: response(plan, ...). Throws what scenarios::load_scenario_text() throws of the plan's
// scenario.
AnswerText sweep_answer(const evaluation::SweepPlan& plan,
                        const std::vector<evaluation::ResponseRow>& rows);

// A point by the first pointer of each axis; what goes in lockstep with it is in the table.
std::string leading_text(const evaluation::SweepPlan& plan, std::size_t point);

// "chrony is better than ntp up to /hosts/count=2, worse from /hosts/count=4 on."
std::string flip_text(const evaluation::SweepPlan& plan, const evaluation::RankingFlip& flip);

// The order of the pipelines at each point, and between which values of the first axis it flips
// (evaluation/sweep/ranking.h).
Block ranking_block(const evaluation::SweepPlan& plan,
                    const std::vector<evaluation::ResponseRow>& rows);

// The metric beside the packets per second that all hosts together sent, pipeline by pipeline; the
// same as curves.
Block packets_block(const evaluation::SweepPlan& plan,
                    const std::vector<evaluation::ResponseRow>& rows);
Figure packets_figure(const evaluation::SweepPlan& plan,
                      const std::vector<evaluation::ResponseRow>& rows);

// The response of each pipeline at each point: the metrics with TablePlaces::response, the first
// one with its band.
Block response_block(const evaluation::SweepPlan& plan,
                     const std::vector<evaluation::ResponseRow>& rows);

// The median clock error of each host, in the order of their sessions.
Block host_order_block(const evaluation::SweepPlan& plan,
                       const std::vector<evaluation::ResponseRow>& rows);

// The 95 % interval of the median AMD of n seeds, and the number of seeds for a given interval.
Block seeds_needed_block(const evaluation::SweepPlan& plan,
                         const std::vector<evaluation::ResponseRow>& rows);

// A panel for each metric with TablePlaces::response_panel. x is the first axis of the sweep: its
// first pointer's values, or 0, 1, ... for words. There is a curve for each pipeline and each step
// of the other axes. With a single point, Figure::absent.
Figure response_figure(const evaluation::SweepPlan& plan,
                       const std::vector<evaluation::ResponseRow>& rows);

// One panel: each host's median clock error, in the order of the sessions.
Figure host_order_figure(const evaluation::SweepPlan& plan,
                         const std::vector<evaluation::ResponseRow>& rows);

// One panel: the 95 % interval of the median AMD of n seeds, in percent, against n.
Figure seeds_needed_figure(const evaluation::SweepPlan& plan,
                           const std::vector<evaluation::ResponseRow>& rows);

}  // namespace simbench::reports

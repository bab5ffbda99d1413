// The results of a sweep: blocks for people, CSV for scripts, figures.
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_REPORT_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_REPORT_H_

#include <string>
#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/figures/figure.h"
#include "reports/text/block.h"

namespace simbench::reports {

// The manifest of a sweep, which identifies it (reports/sweep/sweep_folder.h). `study`: its name or
// "".
std::string sweep_manifest(const evaluation::SweepPlan& plan, const std::string& study);

// sweep.csv, one line for each point, pipeline and seed: the swept values under their JSON
// pointers, pipeline, seed, and the columns of evaluation::sweep_metrics(). Numbers are the
// shortest that read back as the same double; a value that does not exist is an empty cell. Of a
// scenario that is changed at all points, a last column: changed.
std::string sweep_csv(const evaluation::SweepPlan& plan,
                      const std::vector<evaluation::SweepScore>& scores);

// hosts.csv, one line for each host of each of these: the same, then host (0 is the master) and
// error_ms, its mean clock error.
std::string sweep_hosts_csv(const evaluation::SweepPlan& plan,
                            const std::vector<evaluation::SweepScore>& scores);

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

#endif  // SIMBENCH_REPORTS_SWEEP_SWEEP_REPORT_H_

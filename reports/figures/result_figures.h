// Figures of finished results, without another run.
//
//   Archive archive = read_archive("results/monday");
//   read_seed_details(archive);
//   const std::vector<Figure> figures = frame_errors(archive);
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/budget/pipeline_budget.h"
#include "reports/archive/archive.h"
#include "reports/figures/figure.h"

namespace simbench::reports {

// Fig. 9 and 10: the terms of AMD and RMDV of every pulse at one seed, for the paper's four rows,
// or the first four of the results if these are missing. Needs read_seed_details().
Figure frame_errors(const Archive& archive, std::uint64_t seed);
// Returns a figure for each seed of the archive, in order.
std::vector<Figure> frame_errors(const Archive& archive);

// The scores of all seeds in ascending order over the share of seeds (the quantile function of the
// tables), with the published values as lines: a panel for each metric whose band the
// tables show. First one figure of up to 12 pipelines together, then one for each pipeline.
std::vector<Figure> distributions(const Archive& archive);

// The clock errors of the hosts by their place in the session: the paper's procedure synchronises
// one after another. The same figures as above. Needs read_seed_details().
std::vector<Figure> host_order(const Archive& archive);

// The error budget of a pipeline, with a panel each for AMD, the absolute error, the physical
// spread and, where it is divided, the host clock error: the mean parts and the remainder as bars,
// the ends of the 5-95 % band as points.
Figure budget_figure(const evaluation::PipelineBudget& budget);

}  // namespace simbench::reports

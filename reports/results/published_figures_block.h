// Published figures of any metric beside the seeds (evaluation/scoring/published_figures.h), for
// people. All texts are in the scenario's order, one entry for each figure whose pipeline has a
// row.
//
//   Document page{.title = "figures"};
//   if (const auto block = published_figures_block(results)) page.blocks.push_back(*block);
#ifndef SIMBENCH_REPORTS_RESULTS_PUBLISHED_FIGURES_BLOCK_H_
#define SIMBENCH_REPORTS_RESULTS_PUBLISHED_FIGURES_BLOCK_H_

#include <optional>

#include "evaluation/scoring/results.h"
#include "reports/text/block.h"

namespace simbench::reports {

// A table, the meaning of its verdicts, and what was measured on what; nothing without figures.
std::optional<Block> published_figures_block(const evaluation::Results& results);

// A line each, for one screen; nothing without figures.
std::optional<Block> published_figures_lines(const evaluation::Results& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_PUBLISHED_FIGURES_BLOCK_H_

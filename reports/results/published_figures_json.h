// Published figures and their comparison in results.json: an array "published_figures", which
// results without figures lack.
//
// An entry has what the scenario states, the percentile of the number among the seeds, of a bound
// the percentage of the seeds that keep it, each with its interval, and the verdict: "inside",
// "outside", "holds", "fails" or null (too few seeds). Reading takes what was published and
// compares it anew with the rows, as medians are computed anew.
//
//   Json root;
//   state_published_figures(results, root);
#ifndef SIMBENCH_REPORTS_RESULTS_PUBLISHED_FIGURES_JSON_H_
#define SIMBENCH_REPORTS_RESULTS_PUBLISHED_FIGURES_JSON_H_

#include <span>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

void state_published_figures(const evaluation::Results& results, Json& root);

// Throws scenarios::InputError for a pipeline without a row, a metric that there is not or that is
// no series, and for several numbers or none.
std::vector<evaluation::FigureComparison> read_published_figures(
    const JsonNode& root, std::span<const evaluation::Row> rows);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_PUBLISHED_FIGURES_JSON_H_

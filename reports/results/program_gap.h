// Real programs beside the algorithms that model them (scenarios/scenario.h, HostPrograms::model).
//
// The gap is the median over the seeds of the program's value divided by its model's, seed by seed:
// both met the same world. Of captures: AMD and the host clock error; of clock runs: the spread of
// the hosts' clocks over time and the RMS time error.
//
//   Document page{.title = "programs"};
//   if (const auto block = program_gap_block(results)) page.blocks.push_back(*block);
#ifndef SIMBENCH_REPORTS_RESULTS_PROGRAM_GAP_H_
#define SIMBENCH_REPORTS_RESULTS_PROGRAM_GAP_H_

#include <optional>

#include "evaluation/scoring/results.h"
#include "reports/text/block.h"

namespace simbench::reports {

// Nothing where no row is a program whose model has a row.
std::optional<Block> program_gap_block(const evaluation::Results& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_PROGRAM_GAP_H_

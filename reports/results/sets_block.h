// What gathering made of the stamps: a line per pipeline, for tables of policies beside each other.
#ifndef SIMBENCH_REPORTS_RESULTS_SETS_BLOCK_H_
#define SIMBENCH_REPORTS_RESULTS_SETS_BLOCK_H_

#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/text/text_table.h"

namespace simbench::reports {

TextTable sets_block(const std::vector<const evaluation::Row*>& rows);

// What its columns mean.
inline constexpr const char* kSetsLegend =
    "index errors: frames of complete sets that are not of the pulse of most others there. emitted "
    "after: from the last member's arrival. AMD of sets is small where sets were given up: see "
    "recall.";

// What is different about them on a real rig.
inline constexpr const char* kRealArrivalsLegend =
    "Arrivals on a real rig are read from the hosts' own clocks: where these are apart, \"emitted "
    "after\" is wrong by as much, and may be negative.";

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_SETS_BLOCK_H_

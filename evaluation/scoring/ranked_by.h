// What the rows of a result are ranked by: one rule for run, sweep, leaderboards, reports and
// clocks.
//
// Rows are ranked by a metric in which they really differ. The absolute error is none: what all
// rows share (half an exposure, the delay of delivery, a calibration's error) is mostly larger than
// what tells them apart. Captures are ranked by AMD, those whose exposures are steered by what is
// exposed together, runs of the hosts' clocks by the spread of the clocks, and a table of host
// synchronisations by the error of the hosts' clocks. A single camera has no AMD: only then, or
// where a user asks for it (--rank-by), the absolute error ranks.
//
//   const Metric& metric = ranked_metric(ranked_by(scenarios::TableKind::kPipelines));  // AMD
//   const Series& series = ranked_series(row, ranking_of(results));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "scenarios/choices.h"

namespace simbench::evaluation {

struct Results;

enum class RankedBy : std::uint8_t {
  kAmd,
  kRmdv,
  kAbsoluteError,
  kHostError,
  kExposureSpread,  // the 95 % quantile over pulses; rows that follow a trigger are references
  kClockSpread,     // of clock runs: the mean spread in time
};

// How a table of captures is ranked.
RankedBy ranked_by(scenarios::TableKind table);
// The ranking by a metric's id, "amd_ms"; nothing if results are not ranked by it.
std::optional<RankedBy> ranked_by_named(std::string_view metric_id);
// The ids by which captures may be ranked.
std::vector<std::string> ranking_metrics();

const Metric& ranked_metric(RankedBy ranked_by);
const Series& ranked_series(const Row& row, RankedBy ranked_by);

// What these results are ranked by: as they say, or the absolute error where no row has an AMD.
RankedBy ranking_of(const Results& results);

}  // namespace simbench::evaluation

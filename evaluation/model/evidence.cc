#include "evaluation/model/evidence.h"

#include <cmath>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

// rests_on: theory, this experiment, a real recording, published figures, assumption.
constexpr StageEvidence kStages[] = {
    {"trigger",
     {false, false, false, true, true},
     "sync modes and advised pulse rates as vendor and users document them; pulse jitter and the "
     "delays of cables and branches are assumed"},
    {"exposure",
     {false, false, false, true, true},
     "delay after the pulse, pulses ignored in genlock, waiting slaves: reported for the D455, but "
     "not measured here; the spread of exposures in the calibrated worlds is a fit to eight "
     "published numbers"},
    {"device clock",
     {true, false, false, true, true},
     "32-bit microseconds and their wrap as in the SDK's code, wander tested against its "
     "configured Allan deviation; rate errors and wander of a camera's quartz are assumed"},
    {"USB and host stack",
     {false, false, false, true, true},
     "whole latencies as reported for the D455; their parts, the distribution of the jitter and "
     "the sharing of a controller are assumed. simbench fit replaces them by a rig's own "
     "quantiles"},
    {"host oscillator",
     {true, false, false, true, true},
     "simulated Allan deviation follows the configured one; sizes are those of ordinary quartz. "
     "The experiment's hosts share one oscillator: their skews are set, and they have no wander"},
    {"clock interface (get and set)",
     {false, true, false, false, true},
     "the nodes' software clock is part of the experiment, and blocks for as long as the scenario "
     "says when it is set; that the calls of a real system cost so much, and the ticks of the "
     "calibrated worlds, are fitted, no document supports them"},
    {"network latency",
     {false, false, false, true, true},
     "near published round trips of one wired link; unequal links and bursts are assumed. The "
     "experiment imposes the scenario's latencies, so it cannot confirm them"},
    {"transport and kernel stamps",
     {false, true, false, false, false},
     "real sockets and kernel stamps under the scenario's delay, jitter, loss and reordering; the "
     "gap above shows the effects that the simulator omits. The experiment has no network card, "
     "switch or second kernel"},
    {"host_sync protocols",
     {true, true, false, true, false},
     "the same code in both worlds; closed forms, recorded outputs of chrony's regression and "
     "linuxptp's servos, and true clock errors of the experiment. The paper's own rig is not "
     "reproduced"},
    {"device_time",
     {true, false, true, true, false},
     "closed forms, and a recording of other cameras with a real drift of -215 ppm, but without "
     "true exposure times, so that a constant delay stays unknown"},
    {"gathering",
     {true, false, false, true, false},
     "exact small cases, and the test vectors of the projects with these policies; in the "
     "experiment gathering runs on stamps of simulated cameras"},
    {"metrics",
     {true, false, false, true, false},
     "the definitions of the paper with bounds that hold for any data; two published rows break "
     "the bound of eq. (4), so nothing is fitted to them"},
};

GapSide gap_side(const Series& series) {
  GapSide side;
  side.series = make_series(series.values);
  side.count = count_of_existing(series.values);
  for (std::size_t i = 0; i < kGapQuantiles.size(); ++i) {
    side.quantiles[i] = quantile(series.values, kGapQuantiles[i]);
  }
  return side;
}

ModelGapRow gap_row(const std::string& pipeline, const Metric& metric, const Row& measured_row,
                    const Row& simulated_row) {
  const Series& measured = metric.series(measured_row);
  const Series& simulated = metric.series(simulated_row);
  ModelGapRow row;
  row.pipeline = pipeline;
  row.metric = metric.id;
  row.measured = gap_side(measured);
  row.simulated = gap_side(simulated);
  row.ks = ks_distance(measured.values, simulated.values);
  row.ks_critical = ks_critical_distance(row.measured.count, row.simulated.count);
  const double found = row.measured.series.median;
  row.median_gap = (row.simulated.series.median - found) / found;
  if (found > kSmallestJudgedMs && !std::isnan(row.median_gap)) {
    row.within_20_percent = std::abs(row.median_gap) <= kLargestGap;
  }
  return row;
}

}  // namespace

std::string_view name_of(Evidence evidence) {
  switch (evidence) {
    case Evidence::kTheory:
      return "theory";
    case Evidence::kExperiment:
      return "this experiment";
    case Evidence::kRecording:
      return "a real recording";
    case Evidence::kPublished:
      return "published figures";
    case Evidence::kAssumption:
      return "assumption";
  }
  SIMBENCH_ASSERT(false, "an evidence has a name");
  return "";
}

std::span<const StageEvidence> model_evidence() { return kStages; }

std::vector<ModelGapRow> model_gap(const Results& measured, const Results& simulated) {
  std::vector<ModelGapRow> rows;
  for (const Row& found : measured.rows) {
    const Row* const predicted = find_row(simulated.rows, found.pipeline);
    if (predicted == nullptr) continue;
    for (const char* id : kGapMetrics) {
      ModelGapRow row = gap_row(found.pipeline, metric(id), found, *predicted);
      if (row.measured.count + row.simulated.count > 0) rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace simbench::evaluation

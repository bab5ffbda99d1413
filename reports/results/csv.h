// Results as CSV: a header line, then one line per pipeline, frame or host. Numbers in the shortest
// text that reads back as the same double; what does not exist is an empty cell.
#pragma once

#include <ostream>
#include <string>
#include <string_view>

#include "evaluation/scoring/results.h"
#include "scenarios/derivation.h"

namespace simbench::reports {

// One line per pipeline: the metrics in the columns of evaluation/scoring/metrics.h, with the
// published values before those of CsvForm::kValueAtEnd, and scored_seeds, standing and failed as
// in json.h. If something steers the exposures of a row, a column capture_alignment after
// host_sync. If there are published figures of other metrics, a column published_figures after
// failed: those of the pipeline with their verdicts ("amd_ms at_most 2.5 holds"; none: too few
// seeds to tell). If a row is not of a simulation or has notes, three more columns: ground_truth
// (as in reports/results/json.h), verified
// ("verified" or "unverified") and notes. If the scenario's world is a changed one, a last column:
// changed, the same text in each line ("changed: /trigger/rate_hz 45 → 30").
std::string csv(const evaluation::Results& results);

// scenario,pipeline,seed,metric,unit,value, and changed as above: a line for each metric that each
// seed has a value of, of captures or of clock runs.
std::string tidy_csv(const evaluation::Results& results);

// frames.csv: pipeline,seed,pulse,amd_ms,rmdv_ms, and changed as above: the pulse's terms of AMD
// and RMDV; needs EvaluationOptions::keep_pulses.
void write_frames_csv(const evaluation::Results& results, std::ostream& out);

// hosts.csv: these columns, synchronised being 1 or 0, and changed as above. From t_l_ms on: what
// the slave measured and added in the last pass of its session; empty where there is none.
inline constexpr std::string_view kHostsHeader =
    "pipeline,seed,host,host_error_ms,synchronised,t_l_ms,t_t_ms,t_d_ms,session_passes,"
    "get_time_ms,set_time_ms";
void write_hosts_csv(const evaluation::Results& results, std::ostream& out);

// The end of a header and of each line of a CSV: of a changed world with a last column, as above.
struct LineEnds {
  explicit LineEnds(const scenarios::Derivation& derivation);
  std::string header = "\n";
  std::string line = "\n";
};

}  // namespace simbench::reports

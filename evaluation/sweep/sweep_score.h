// What a sweep keeps of one run, as numbers and as text.
//
// The text is what goes into the log of finished runs and from one machine to another: the cells of
// the run's line in sweep.csv, then a semicolon, then the mean clock error of every host. Numbers
// are the shortest that read back as the same double, so the text loses nothing.
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// Definitions: evaluation/scoring/results.h. NaN is a quantity that does not exist.
struct SweepScore {
  double amd_ms = 0;
  double rmdv_ms = 0;
  double absolute_error_ms = 0;
  double bias_ms = 0;
  double host_error_ms = 0;
  double exposure_spread_ms = 0;
  double precision = 0;
  double recall = 0;
  double margin_ms = 0;  // T_int less the 99.9 % quantile of this seed's spreads
  double set_amd_ms = 0;
  double set_absolute_error_ms = 0;
  double emission_latency_ms = 0;
  double emitted_sets = 0;
  double pure_sets = 0;
  double complete_pulses = 0;
  double frames_dropped = 0;
  double unsynchronised_hosts = 0;
  std::vector<double> host_errors_ms{};  // signed mean, by host
};

// A number of the score, by the name of its column.
struct ScoreColumn {
  const char* name;
  double SweepScore::*member;
};
std::span<const ScoreColumn> score_columns();

// Of a row with this one seed.
SweepScore sweep_score(const Row& row);

std::string text_of(const SweepScore& score);
// Nothing if it is no such text.
std::optional<SweepScore> score_of(std::string_view text);
// The part of the text before the semicolon: cells for a CSV.
std::string_view cells_of(std::string_view text);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_

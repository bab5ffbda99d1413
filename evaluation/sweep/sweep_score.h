// What a sweep keeps of one run, as numbers and as text.
//
// The text is what goes into the log of finished runs and from one machine to another: the cells of
// the run's line in sweep.csv, then a semicolon, then the mean clock error of every host. Numbers
// are the shortest that read back as the same double, so the text loses nothing.
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// NaN is a value that does not exist.
struct SweepScore {
  std::vector<double> values;            // by sweep_metrics() (evaluation/scoring/metrics.h)
  std::vector<double> host_errors_ms{};  // signed mean, by host

  SweepScore();  // zero in every column

  // By the name of the column, which must exist: "amd_ms", "emitted_sets".
  double at(std::string_view column) const;
  double& at(std::string_view column);
};

// Of a row with this one seed.
SweepScore sweep_score(const Row& row);

std::string text_of(const SweepScore& score);
// Nothing if it is no such text.
std::optional<SweepScore> score_of(std::string_view text);
// The part of the text before the semicolon: cells for a CSV.
std::string_view cells_of(std::string_view text);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_SCORE_H_

// From a recording of a rig to parameters of a scenario, each with its evidence.
//
//  - the rate of each camera's clock against its host's (fit_stream.h); where it has several
//    streams, the one that knows it best;
//  - how late frames come: the excess of all streams together, as a quantile table, and its
//    correlation from frame to frame, as that of the normal variates of a Gaussian copula,
//    r = 2 sin(pi / 6 * Spearman's);
//  - the share of frames that the counters know of and that never came;
//  - from exchanges between hosts: the latency of one way, offsets and rates (fit_exchanges.h).
//
// What stamps alone cannot show, and no fit gives: the constant part of every delay, an asymmetry
// of a link, and jitter that cameras have in common (all are taken to be independent).
//
// Errors: FitError. Complexity: O(n log n) in the frames.
//
//   const RigFit fit = fit_rig(input);
#ifndef SIMBENCH_EVALUATION_FIT_FIT_H_
#define SIMBENCH_EVALUATION_FIT_FIT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/fit/fit_exchanges.h"
#include "evaluation/fit/fit_input.h"
#include "evaluation/fit/fit_stream.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

inline constexpr std::size_t kLongestTable = 1001;

struct RigFit {
  std::vector<StreamFit> streams;
  std::vector<FittedValue> skew_ppm;  // by camera
  std::vector<double> excess_ms;      // of all streams, sorted
  std::vector<double> delivery_quantiles_ms;
  std::optional<FittedValue> correlation;  // nothing: too few pairs, or no jitter at all
  std::int64_t frames = 0;
  std::int64_t missing = 0;
  Interval drop_interval;  // 95 %
  NetworkFit network;

  double drop_share() const;
};

RigFit fit_rig(const FitInput& input);

// At equally spaced probabilities 0 to 1; as many as there are values, kLongestTable at most.
std::vector<double> quantile_table(const std::vector<double>& sorted);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_FIT_FIT_H_

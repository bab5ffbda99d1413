// From a recording of a rig to parameters of a scenario, each with its evidence.
//
//  - the rate of each camera's clock against its host's; where it has several streams, the one that
//    knows it best;
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
#include <string>
#include <vector>

#include "evaluation/fit/fit_exchanges.h"
#include "evaluation/fit/fit_input.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

// What the stamp pairs of one stream say: the camera's rate, and how late each frame came.
//
// Arrivals are late, never early. So the highest line that lies under all of them is the camera's
// clock on the host's, but for a constant: the edge of the lower convex hull over the middle of the
// device stamps.
//
// A frame's excess is its delivery delay less the smallest one, which stamps cannot show: its
// height above that edge, block by block. Blocks last kBlockS at least, and have kBlockFrames at
// least, so that a rate that changes over minutes is not taken for delay. Excess holds everything
// else that varies between the camera's stamp and the arrival stamp: bus, kernel, scheduling, noise
// and steps of both stamps.
//
// The standard error of the rate is that of the hull lines of kParts interleaved parts (every
// kParts-th frame each), over sqrt(kParts): cautious, since a hull's error falls faster than that.
// It does not cover a rate that changes; rise_ms shows that.
//
// Correlation is Spearman's between the excess of a frame and of the next by the counter.
//
// Source: docs/reference/device_time.md section 1 (hull); algorithms/device_time/lower_hull.h.
// Complexity: O(n log n). Errors: FitError: too few frames, device stamps or arrivals that go back.
//
//   const StreamFit fit = fit_stream("left", stream);
inline constexpr std::size_t kFewestFrames = 100;
inline constexpr double kBlockS = 30;
inline constexpr std::size_t kBlockFrames = 300;

struct StreamFit {
  std::size_t camera = 0;
  std::string kind;
  std::int64_t frames = 0;
  std::int64_t missing = 0;  // by gaps of the counter
  double span_s = 0;
  double skew_ppm = 0;  // device rate / host rate - 1, lower hull
  double skew_error_ppm = 0;
  double least_squares_ppm = 0;  // the same by least squares, which the mean delay's drift moves
  // How far all frames of the worst tenth of the recording lie above the line: a rate that changed.
  double rise_ms = 0;
  std::vector<double> excess_ms;  // frame by frame, 0 at least
  double rank_correlation = 0;    // NaN without pairs, or without any difference
  std::int64_t pairs = 0;
};

// `camera` is for messages.
StreamFit fit_stream(const std::string& camera, const FitStream& stream);

// Spearman's, of successive values that are marked as successors (follows[i]: value i follows i-1).
double successive_rank_correlation(const std::vector<double>& values,
                                   const std::vector<bool>& follows);

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

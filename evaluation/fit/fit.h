// From a recording of a rig to parameters of a scenario, each with its evidence:
//
//  - the rate of each camera's clock relative to its host's, from the stream that determines it
//    best;
//  - the lateness of frames: the excess delay of all streams together, as a quantile table, and its
//    correlation from frame to frame, as that of the normal variates of a Gaussian copula, r = 2
//    sin(pi / 6 * Spearman's);
//  - the share of frames that the counters counted and that never arrived;
//  - from exchanges between hosts: the latency of one way, offsets and rates.
//
// No fit gives what stamps alone cannot show: the constant part of every delay, an asymmetry of a
// link, and jitter that cameras have in common (all are taken to be independent). What a recording
// has and no model can take is said to be left out.
//
// Errors: FitError, if no stream is left, or device stamps are not of the arrivals' unit.
// Complexity: O(n log n) in the frames and exchanges.
//
//   const RigFit fit = fit_rig(input);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/fit/fit_input.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

// The fit of the exchanges of a recording: latencies of the network, offsets and rates of the
// hosts.
//
// Only exchanges with all four stamps count, and only those during which neither host's clock was
// set. Recorded settings are undone: intervals are those of the steady clocks.
//
// A round trip is the sum of two ways, which stamps cannot separate. Both ways are assumed to have
// one distribution and to be independent. The table of one way is then the one whose sum with
// itself has the distribution of the round trips; some rounds of expectation and maximisation find
// it from a uniform one (more would follow the sample's noise). A constant asymmetry of a link
// stays hidden. The cost of messages between the stamp and the wire is part of it.
//
// A host's initial offset is that of its quickest exchange before any setting, within half a round
// trip; its rate relative to the master's is the slope of the offsets of the quickest quarter.
// Source: docs/reference/host_sync.md section 3; Dempster, Laird and Rubin 1977, "Maximum
// likelihood from incomplete data via the EM algorithm".

// A value with its standard error, which is known as well as so many degrees of freedom (Student's)
// have it.
struct FittedValue {
  double value = 0;
  double error = 0;
  double freedom = kManyDegrees;
  static constexpr double kManyDegrees = 1e6;  // as good as a normal distribution
};

// The 95 % interval of a value.
Interval interval_of(const FittedValue& value);

struct HostClockFit {
  std::uint32_t host = 0;                             // not the master
  std::optional<FittedValue> initial_offset_ms = {};  // from the master; error: half a round trip
  std::optional<FittedValue> skew_ppm = {};           // rate against the master's
};

struct NetworkFit {
  std::vector<double> round_trips_ms;
  std::vector<double> latency_quantiles_ms;  // empty: fewer than kFewestExchanges round trips
  std::vector<HostClockFit> hosts;           // those with exchanges with the master
};

inline constexpr std::size_t kFewestExchanges = 50;

NetworkFit fit_exchanges(const FitInput& input);

// Returns the quantile table of one way, two independent ones of which make up these round trips
// (not empty).
std::vector<double> one_way_table(const std::vector<double>& round_trips);

// The fit of one stream: the camera's rate, and the lateness of each frame.
//
// The rate is that of the line under the arrivals (rate_line.h), with its error and the error's
// degrees of freedom. It is the mean rate over the recording; the error has the jitter's share and
// that of a rate that wanders.
//
// A frame's excess is its delivery delay less the smallest one, which stamps cannot show: its
// height over the line of its block, from the block's lowest frame on. Blocks last kBlockS at
// least, and have kBlockFrames at least, so that a rate that changes over minutes is not taken for
// delay. Excess contains everything else that varies between the camera's stamp and the arrival
// stamp: bus, kernel, scheduling, noise and steps of both stamps.
//
// The rank correlation (Spearman's) is between the excess of a frame and of the next by the
// counter. Its error is that of the means of kErrorBlocks successive parts, which have what lasts
// longer than a frame.
//
// Source: docs/reference/device_time.md section 1.
// Errors: FitError: too few frames, or stamps of another unit (a drift beyond 1 %).
inline constexpr std::size_t kFewestFrames = 100;
inline constexpr double kBlockS = 30;
inline constexpr std::size_t kBlockFrames = 300;
inline constexpr std::size_t kErrorBlocks = 16;

struct StreamFit {
  std::size_t camera = 0;
  std::string kind;
  std::int64_t frames = 0;
  FrameAccount account;  // of the whole recording
  double span_s = 0;
  FittedValue skew_ppm;  // device rate / host rate - 1
  // The farthest that the lower quartile of a tenth of the recording is off the line: large if the
  // rate changed, or the delays did for long.
  double rise_ms = 0;
  std::vector<double> excess_ms;  // frame by frame, 0 at least
  FittedValue rank_correlation;   // NaN without pairs, or without any difference
  std::int64_t pairs = 0;
};

// `camera` is for messages.
StreamFit fit_stream(const std::string& camera, const FitStream& stream);

// Returns Spearman's correlation of successive values (follows[i]: value i follows value i - 1).
FittedValue successive_rank_correlation(const std::vector<double>& values,
                                        const std::vector<bool>& follows);

// From the slope of (host - device) over device time to the rate device / host - 1.
double skew_of_slope_ppm(double slope);

inline constexpr std::size_t kLongestTable = 1001;

// Frames that the cameras counted and that never arrived.
struct DropFit {
  std::int64_t lost = 0;
  std::int64_t counted = 0;  // with the lost ones
  // The 95 % interval of the share: Clopper and Pearson's, frames that are lost together as one.
  Interval interval{};

  double share() const { return static_cast<double>(lost) / static_cast<double>(counted); }
};

struct RigFit {
  std::vector<StreamFit> streams;                    // those with kFewestFrames
  std::vector<std::optional<FittedValue>> skew_ppm;  // by camera; nothing: none of its streams has
  std::vector<double> excess_ms;                     // of all streams, sorted
  std::vector<double> delivery_quantiles_ms;
  std::optional<FittedValue> correlation;  // nothing: too few pairs, or no jitter at all
  bool has_delays = false;  // false: in all streams arrivals and device stamps are the same
  std::int64_t frames = 0;
  std::optional<DropFit> drops;  // of the whole recording; nothing: no stream counts its frames
  NetworkFit network;
  std::vector<std::string> left_out;  // those of the input, and streams
};

RigFit fit_rig(const FitInput& input);

// Returns quantiles at equally spaced probabilities 0 to 1; one per value, kLongestTable at most.
std::vector<double> quantile_table(const std::vector<double>& sorted);

}  // namespace simbench::evaluation

// What the exchanges of a recording say: latencies of the network, offsets and rates of the hosts.
//
// Only exchanges with all four stamps count, and only those during which neither host's clock was
// set. Settings that are in the recording are undone: intervals are those of the steady clocks.
//
// A round trip is the sum of two ways, and no stamp tells one from the other. Assumed: both ways
// have one distribution and are independent. Then the table of one way is the one whose sum with
// itself has the round trips' distribution; some rounds of expectation and maximisation find it
// from a uniform one (more would follow the sample's noise). A constant asymmetry of a link stays
// hidden. What messages cost the hosts between stamp and wire is part of it.
//
// A host's offset before anything set it is that of its quickest exchange then, within half a round
// trip; its rate against the master's is the slope of the offsets of the quickest quarter.
//
// Source: docs/reference/host_sync.md section 3; Dempster, Laird and Rubin 1977, "Maximum
// likelihood from incomplete data via the EM algorithm". Complexity: O(n log n).
//
//   const NetworkFit network = fit_exchanges(input);
#ifndef SIMBENCH_EVALUATION_FIT_FIT_EXCHANGES_H_
#define SIMBENCH_EVALUATION_FIT_FIT_EXCHANGES_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/fit/fit_input.h"

namespace simbench::evaluation {

// A value with its standard error.
struct FittedValue {
  double value = 0;
  double error = 0;
};

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

// The quantile table of one way of which two independent ones make these round trips (not empty).
std::vector<double> one_way_table(const std::vector<double>& round_trips);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_FIT_FIT_EXCHANGES_H_

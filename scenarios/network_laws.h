// The laws of a scenario's links as values (laws/message_law.h).
//
//   const DatagramLaw law = datagram_law(scenario.network);
#pragma once

#include "laws/message_law.h"
#include "scenarios/scenario.h"

namespace simbench::scenarios {

inline DatagramLaw datagram_law(const Network& network) {
  return {.loss_probability = network.loss_probability,
          .duplicate_probability = network.duplicate_probability,
          .reorder_probability = network.reorder_probability,
          .reorder_max_ms = network.reorder_max_ms};
}

// The network outlives the law.
inline LatencyLaw latency_law(const Network& network) {
  const QuantileTable table_ms(network.latency_quantiles_ms);
  return {.fixed_ms = table_ms.empty() ? network.latency_fixed_ms : 0,
          .exponential_ms = network.latency_exponential_ms,
          .spike_probability = network.spike_probability,
          .spike_max_ms = network.spike_max_ms,
          .table_ms = table_ms};
}

}  // namespace simbench::scenarios

// What a link does to its messages: how long one takes, and which datagrams are lost, doubled or
// overtaken. The simulated network and the relay between real hosts obey the same laws.
//
// A latency is
//
//   fixed + Exp(mean) + spike (with a probability, uniform up to its largest)
//
// or, where a table of measured latencies is given, fixed + table. Datagrams keep their order but
// for those that are reordered, which are late by up to reorder_max_ms behind it; a copy of a
// datagram has a latency of its own and does not overtake the datagram.
//
// Each law draws the same number of random numbers for every message, whatever becomes of it, so
// that a probability that changes leaves the other draws as they are. `Draws` has uniform() in [0,
// 1), exponential(mean) and chance(probability). Unit: milliseconds; a drawn latency may be
// negative if fixed_ms is.
//
// Source: docs/reference/calibration.md section 2 ("lat()"); docs/reference/host_sync.md section 3.
//
//   const LatencyLaw latency{.fixed_ms = 0.2, .exponential_ms = 0.05};
//   const double one_way_ms = latency.draw_ms(draws);
//   const DatagramFate fate = DatagramLaw{.loss_probability = 0.01}.draw(draws);
#pragma once

#include <algorithm>
#include <cstdint>

#include "algorithms/ports/time.h"
#include "laws/quantile_table.h"

namespace simbench {

// A stream loses no message: each loss costs a timeout, doubled each time, up to so many (as Linux'
// tcp_retries2). What is lost once more breaks the simulated stream; the relay delivers it.
inline constexpr int kMaxRetransmissions = 15;

// Numbers the directions of all links.
constexpr std::uint64_t direction_of(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32) | to;
}

struct LatencyLaw {
  double fixed_ms = 0;           // of every message
  double exponential_ms = 0;     // the mean of what comes on top
  double spike_probability = 0;  // of a message
  double spike_max_ms = 0;
  QuantileTable table_ms{};  // empty, or in place of the exponential part and the spikes

  template <class Draws>
  double draw_ms(Draws& draws) const {
    if (!table_ms.empty()) return fixed_ms + table_ms.value_at(draws.uniform());
    const double latency_ms = fixed_ms + draws.exponential(exponential_ms);
    const bool has_spike = draws.chance(spike_probability);
    const double spike_ms = spike_max_ms * draws.uniform();
    return has_spike ? latency_ms + spike_ms : latency_ms;
  }
};

// When a datagram arrives, and when its copy does if there is one.
template <class Time>
struct DatagramArrivals {
  Time first;
  Time copy;
};

// What becomes of one datagram.
struct DatagramFate {
  bool is_lost = false;
  bool is_duplicated = false;
  bool is_reordered = false;
  double detour_ms = 0;

  // By their latencies alone the datagram would arrive at `arrival`, its copy at `copy_arrival`.
  // `last` is the arrival that the order of the link demands, and is kept up to date. For a
  // datagram that is not lost.
  template <class Time>
  DatagramArrivals<Time> arrivals(Time arrival, Time copy_arrival, Time& last) const {
    const Time in_order = std::max(arrival, last);
    if (!is_reordered) last = in_order;
    return {.first = is_reordered ? in_order + from_ms(detour_ms) : in_order,
            .copy = std::max(copy_arrival, in_order)};
  }
};

struct DatagramLaw {
  double loss_probability = 0;
  double duplicate_probability = 0;
  double reorder_probability = 0;
  double reorder_max_ms = 0;

  // Whether all datagrams arrive once and in order.
  bool is_none() const {
    return loss_probability <= 0 && duplicate_probability <= 0 && reorder_probability <= 0;
  }

  template <class Draws>
  DatagramFate draw(Draws& draws) const {
    return {.is_lost = draws.chance(loss_probability),
            .is_duplicated = draws.chance(duplicate_probability),
            .is_reordered = draws.chance(reorder_probability),
            .detour_ms = reorder_max_ms * draws.uniform()};
  }
};

}  // namespace simbench

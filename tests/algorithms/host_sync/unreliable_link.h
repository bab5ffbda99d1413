// A link of random faults, and messages that mean nothing, for what protocols must survive.
//
//   boost::random::mt19937_64 engine(17);
//   world.script_link(0, 1, unreliable_link(engine, kLatency, {.twice_after = from_ms(0.3),
//                                                              .late = {kLatency + from_ms(70)}}));
//   world.host(1).deliver(0, random_bytes(engine, 60));
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {

struct LinkFaults {
  Nanoseconds twice_after{};      // between the copies of a message that comes twice
  std::vector<Nanoseconds> late;  // when the copies of a late message come
};

// One of five messages, at random, is lost, one comes twice and one late. `engine` must outlive
// the link.
inline LinkScript unreliable_link(boost::random::mt19937_64& engine, Nanoseconds latency,
                                  LinkFaults faults) {
  return [&engine, latency, faults = std::move(faults)](std::size_t, const Bytes&) {
    switch (engine() % 5) {
      case 0:
        return std::vector<Nanoseconds>{};
      case 1:
        return std::vector<Nanoseconds>{latency, latency + faults.twice_after};
      case 2:
        return faults.late;
      default:
        return std::vector<Nanoseconds>{latency};
    }
  };
}

// Fewer than `below` bytes, at random.
inline Bytes random_bytes(boost::random::mt19937_64& engine, std::size_t below) {
  Bytes bytes(engine() % below);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(engine());
  return bytes;
}

}  // namespace simbench

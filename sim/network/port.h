// A port of the switch, or a host's towards it: messages pass one after the other.
//
// A message occupies the port for its bytes over the bandwidth, in order of arrival; a message that
// finds the port occupied waits. Without a bandwidth (0) nothing waits.
//
//   const LineRate rate(1000);                                  // 1 Gbit/s
//   TrueTime through = port.pass(arrival, rate.duration(1500));  // 12 us later, if it is free
#ifndef SIMBENCH_SIM_NETWORK_PORT_H_
#define SIMBENCH_SIM_NETWORK_PORT_H_

#include <algorithm>
#include <cmath>

#include "recording/true_time.h"

namespace simbench::sim {

class LineRate {
 public:
  explicit LineRate(double mbit_per_s) : ns_per_byte_(mbit_per_s == 0 ? 0 : 8'000 / mbit_per_s) {}
  bool is_infinite() const { return ns_per_byte_ == 0; }
  Nanoseconds duration(double bytes) const {
    return Nanoseconds(std::llround(bytes * ns_per_byte_));
  }

 private:
  double ns_per_byte_;
};

class Port {
 public:
  // How long what arrives at `at` would have to wait.
  Nanoseconds backlog(TrueTime at) const { return free_at_ > at ? free_at_ - at : Nanoseconds(0); }
  // When a message has passed that arrives at `at`, not before the one before it.
  TrueTime pass(TrueTime at, Nanoseconds duration) {
    free_at_ = std::max(free_at_, at) + duration;
    return free_at_;
  }

 private:
  TrueTime free_at_ = TrueTime::min();
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_NETWORK_PORT_H_

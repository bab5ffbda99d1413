// What messages pass one after the other: a port of a switch or of a host, a radio channel.
//
//   Port port;
//   const LineRate rate(1000);  // Mbit/s
//   const TrueTime out = port.pass(now, rate.duration(1500));
#pragma once

#include <algorithm>

#include "recording/true_time.h"

namespace simbench::sim {

class LineRate {
 public:
  // 0: infinite, nothing waits.
  explicit LineRate(double mbit_per_s) : ns_per_byte_(mbit_per_s == 0 ? 0 : 8'000 / mbit_per_s) {}
  bool is_infinite() const { return ns_per_byte_ == 0; }
  Nanoseconds duration(double bytes) const { return from_ns(bytes * ns_per_byte_); }

 private:
  double ns_per_byte_;
};

// A port of the switch, or a host's towards it: messages pass one after the other, in order of
// arrival.
class Port {
 public:
  // How long a message that arrives at `at` would wait.
  Nanoseconds backlog(TrueTime at) const { return free_at_ > at ? free_at_ - at : Nanoseconds(0); }
  // When a message that arrives at `at` has passed; messages pass in order.
  TrueTime pass(TrueTime at, Nanoseconds duration) {
    free_at_ = std::max(free_at_, at) + duration;
    return free_at_;
  }

 private:
  TrueTime free_at_ = TrueTime::min();
};

}  // namespace simbench::sim

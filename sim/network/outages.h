// Hosts and links that stop for a while (faults host_stops and link_stops).
//
// A stopped host gets no frames, no pulses and no polls, and its messages are neither sent nor
// received; its clocks go on, and so do its programs, which talk to nobody. Of a stopped link only
// the messages are lost. Times count from the start of the capture: before start() nothing stops.
//
// Complexity: linear in the number of such faults, a comparison without any.
//
//   Outages outages(scenario.faults);
//   outages.start(engine.now());  // the capture begins
//   if (outages.unreachable(3, engine.now())) ...
#ifndef SIMBENCH_SIM_NETWORK_OUTAGES_H_
#define SIMBENCH_SIM_NETWORK_OUTAGES_H_

#include <vector>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class Outages {
 public:
  explicit Outages(const std::vector<scenarios::Fault>& faults);

  void start(TrueTime capture_start);

  bool host_stopped(PeerId host, TrueTime at) const {
    return !outages_.empty() && stopped(host, at, false);
  }
  // The host is stopped or its link is.
  bool unreachable(PeerId host, TrueTime at) const {
    return !outages_.empty() && stopped(host, at, true);
  }

 private:
  struct Outage {
    PeerId host;
    bool of_link;
    Nanoseconds begin;  // after the start of the capture
    Nanoseconds end;
  };

  bool stopped(PeerId host, TrueTime at, bool or_its_link) const;

  std::vector<Outage> outages_;
  TrueTime start_ = TrueTime::max();
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_NETWORK_OUTAGES_H_

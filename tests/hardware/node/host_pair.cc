#include "tests/hardware/node/host_pair.h"

#include "tests/hardware/await.h"

namespace simbench::hardware {

SoftwareClock::Settings HostPair::settings(PeerId host, double skew_ppm, Nanoseconds offset) {
  const MonotonicTime zero = monotonic_now();
  return {.host = host,
          .oscillator = {zero, SteadyTime(std::chrono::seconds(1000 * (host + 1))), skew_ppm},
          .offset = offset,
          .system_clock = read_system_clock};
}

PeerNetworkSettings HostPair::network(PeerId host, std::uint16_t master_port) {
  return {.me = host,
          .listen = {"127.0.0.1", 0},
          .peers = {{"127.0.0.1", master_port}, {"127.0.0.1", 0}},
          .key = {}};
}

HostPair::HostPair(Nanoseconds offset, double skew0_ppm, double skew1_ppm)
    : clock0_(context_, settings(0, skew0_ppm, {})),
      clock1_(context_, settings(1, skew1_ppm, offset)),
      network0_(context_, network(0, 0), clock0_),
      network1_(context_, network(1, network0_.port()), clock1_) {
  network0_.start();
  network1_.start();
  hosts_[0] = std::make_unique<RealHost>(
      context_, 0, clock0_, network0_,
      [this](const RecordingEvent& event) { events_[0].push_back(event); });
  hosts_[1] = std::make_unique<RealHost>(
      context_, 1, clock1_, network1_,
      [this](const RecordingEvent& event) { events_[1].push_back(event); });
}

Nanoseconds HostPair::true_error() const {
  const MonotonicTime now = monotonic_now();
  return clock1_.system_at(now) - clock0_.system_at(now);
}

void HostPair::connect() {
  run_until(context_, [this] { return network0_.connected(1) && network1_.connected(0); });
}

}  // namespace simbench::hardware

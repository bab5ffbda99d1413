// Two real hosts over 127.0.0.1 in one io_context, whose clocks' true errors are known.
#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <vector>

#include "hardware/clock/software_clock.h"
#include "hardware/net/peer_network.h"
#include "hardware/node/real_host.h"

namespace simbench::hardware {

class HostPair {
 public:
  // Host 1's clock begins `offset` ahead of host 0's; the oscillators run at these skews.
  HostPair(Nanoseconds offset, double skew0_ppm, double skew1_ppm);

  boost::asio::io_context& context() { return context_; }
  SoftwareClock& clock(PeerId host) { return host == 0 ? clock0_ : clock1_; }
  RealHost& host(PeerId host) { return *hosts_[host]; }
  const std::vector<RecordingEvent>& events(PeerId host) const { return events_[host]; }
  // Host 1's system clock minus host 0's, at one instant.
  Nanoseconds true_error() const;
  // Runs the context until the hosts are connected.
  void connect();

 private:
  static SoftwareClock::Settings settings(PeerId host, double skew_ppm, Nanoseconds offset);
  static PeerNetworkSettings network(PeerId host, std::uint16_t master_port);

  boost::asio::io_context context_{1};
  SoftwareClock clock0_;
  SoftwareClock clock1_;
  std::vector<RecordingEvent> events_[2];
  PeerNetwork network0_;
  PeerNetwork network1_;
  std::unique_ptr<RealHost> hosts_[2];
};

}  // namespace simbench::hardware

// A simulated host's datagrams to groups of hosts.
//
// A message to a group is sent once: one call, which occupies the CPU as that of a channel
// (sim/host/sim_channel.h) but for a session's load, one passage of the stack and of the host's
// port; the switches replicate it (sim/network/network.h). Each member receives its copy on its
// datagram channel to the sender, the sender itself none. Numbers count over all groups of the
// host, and the draws of the sender's part are keyed by them.
//
//   host.world().network.groups().join(0xE0000181, 3);
//   const MessageId id = co_await host.multicast().send(0xE0000181, Bytes(44));
//   const SteadyTime until = host.steady_clock().now() + kStampTimeout;
//   const std::optional<HostTime> left = co_await host.multicast().transmit_stamp(id, until);
#ifndef SIMBENCH_SIM_HOST_SIM_MULTICAST_H_
#define SIMBENCH_SIM_HOST_SIM_MULTICAST_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"
#include "sim/host/departures.h"
#include "sim/host/message_stack.h"
#include "sim/network/network.h"

namespace simbench::sim {

class SimHost;

class SimMulticast final : private Endpoint {
 public:
  // `host` must outlive this and this its network's events.
  explicit SimMulticast(SimHost& host);

  Task<MessageId> send(std::uint32_t group, Bytes message);
  // As those of a channel.
  Task<std::optional<HostTime>> transmit_stamp(MessageId id, SteadyTime deadline);
  Task<std::optional<HardwareTime>> hardware_transmit_stamp(MessageId id, SteadyTime deadline);

 private:
  void on_arrival() override {}
  Nanoseconds to_card(MessageId id) override;
  void on_left(MessageId first, std::size_t count, TrueTime passed) override;

  MessageKey key(MessageId id) const;

  SimHost& host_;
  MessageId next_id_ = 0;
  Departures departures_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_SIM_MULTICAST_H_

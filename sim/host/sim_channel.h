// A simulated host's channels, to one peer and to groups of hosts.
//
// send() occupies the host's CPU for
//   send_cost_ms + Exp(send_cost_exponential_ms) + the session's load + the transmit stack:
// the message leaves the stack, and the call returns, at the end of that; the way to the card is
// still to come. The random part is keyed by (link, direction, transport, number of the message).
//
// receive() returns receive_wake_up_ms after the message was available and the call was waiting for
// it: a message that had arrived before the call costs the wake-up too; that of the host's stack
// (sim/host/message_stack.h) is of calls that wait. A message that reaches the card before the
// deadline is returned even if the stack and the wake-up end after it.
//
// A send that is cancelled before the message has left sends nothing; a cancelled receive leaves
// the message to the next one.
//
// Stamps: at "application", the receive stamp is the reading of the system clock, through its
// interface, when receive() returns, and there are no transmit stamps; at "kernel", both are taken
// by the host's stack, on the clock's ticks but not rounded to the interface's resolution.
//
// Hardware stamps are those of the host's card, if it stamps (sim/host/host_clocks.h). A burst of
// load (sim/network/load.h) makes the wake-up longer.
//
// A message to a group is sent once: one call, which occupies the CPU as above but for a session's
// load, one passage of the stack and of the host's port; the switches replicate it
// (sim/network/network.h). Each member receives its copy on its datagram channel to the sender, the
// sender itself none. Numbers count over all groups of the host, and the draws of the sender's part
// are keyed by them.
//
//   host.world().network.groups().join(0xE0000181, 3);
//   const MessageId id = co_await host.multicast().send(0xE0000181, Bytes(44));
//
// Source: docs/reference/calibration.md section 2 (steps 1, 2 and 4); docs/design.md section 4.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "algorithms/ports/host.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/departures.h"
#include "sim/host/message_stack.h"
#include "sim/network/network.h"

namespace simbench::sim {

class SimChannel final : public MessageChannel, private Departures {
 public:
  // `host` must outlive the channel and the channel its network's events.
  SimChannel(SimHost& host, PeerId peer, Transport transport);

  Task<MessageId> send(Bytes message) override { return send(std::move(message), std::nullopt); }
  // The network counts so many bytes of it, or what it has.
  Task<MessageId> send(Bytes message, std::optional<double> bytes_on_wire);
  Task<std::optional<ReceivedMessage>> receive(SteadyTime deadline) override;
  Task<std::optional<HostTime>> transmit_stamp(MessageId id, SteadyTime deadline) override {
    return stamp(id, deadline);
  }
  Task<std::optional<HardwareTime>> hardware_transmit_stamp(MessageId id,
                                                            SteadyTime deadline) override {
    return hardware_stamp(id, deadline);
  }

  // The number that a message to a group takes on the way to the peer.
  SimNetwork::Recipient next_of_group() { return {.path = path_, .id = next_id_++}; }

 private:
  void on_arrival() override;
  MessageKey key_of_sent(MessageId id) const override;

  Nanoseconds occupancy(MessageId id) const;
  TrueTime returns_at(const ArrivedMessage& message, TrueTime called);
  // By software. A message that came before the channel was opened has passed no stack.
  static TrueTime stamp_of(const ArrivedMessage& message) {
    return message.stamped.value_or(message.at);
  }
  MessageKey key_from_peer(MessageId id) const;
  // The key of the message's own draws.
  std::uint64_t key_of(MessageId id) const {
    constexpr std::uint64_t kOfAlignment = std::uint64_t{1} << 62;
    return 2 * id + (transport_ == Transport::kStream ? 1 : 0) +
           (transport_ == Transport::kAlignment ? kOfAlignment : 0);
  }

  PeerId peer_;
  Transport transport_;
  PathId path_;
  bool stamps_in_kernel_;
  double send_cost_ms_;
  MessageId next_id_ = 0;
  WaitPoint arrived_;
};

class SimMulticast final : public Departures {
 public:
  explicit SimMulticast(SimHost& host) : Departures(host, "groups") {}

  Task<MessageId> send(Groups::Id group, Bytes message,
                       std::optional<double> bytes_on_wire = std::nullopt);

 private:
  void on_arrival() override {}
  MessageKey key_of_sent(MessageId id) const override;

  MessageId next_id_ = 0;
};

}  // namespace simbench::sim

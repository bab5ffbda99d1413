#include "sim/host/sim_channel.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "sim/host/host_clocks.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kStreamSendCost("host: cost of sending on a stream");
constexpr ComponentKey kDatagramSendCost("host: cost of sending a datagram");
constexpr ComponentKey kAlignmentSendCost("host: cost of sending to align captures");
ComponentKey send_cost_key(Transport transport) {
  if (transport == Transport::kAlignment) return kAlignmentSendCost;
  return transport == Transport::kStream ? kStreamSendCost : kDatagramSendCost;
}
constexpr ComponentKey kGroupSendCost("host: cost of sending to a group");
constexpr ComponentKey kHardwareReceipt("host: hardware receive stamp");
constexpr ComponentKey kLateWakeUp("host: late wake-up");

}  // namespace

SimChannel::SimChannel(SimHost& host, PeerId peer, Transport transport)
    : Departures(host, "host" + std::to_string(peer)),
      peer_(peer),
      transport_(transport),
      path_(host.world().network.open(host.id(), peer, transport, *this)),
      stamps_in_kernel_(host.world().network_parameters.stamp_point ==
                        scenarios::StampPoint::kKernel),
      send_cost_ms_(host.world().hosts.send_cost_ms +
                    host.world().load.session(host.id(), peer).send_cost_ms),
      arrived_(host.world().context, host.name("receive from host" + std::to_string(peer))) {}

Nanoseconds SimChannel::occupancy(MessageId id) const {
  const HostWorld& world = host_.world();
  const double mean_ms = world.hosts.send_cost_exponential_ms;
  if (mean_ms == 0) return from_ms(send_cost_ms_);
  RandomStream draw(world.run_seed, send_cost_key(transport_), direction_of(host_.id(), peer_), id);
  return from_ms(send_cost_ms_ + draw.exponential(mean_ms));
}

Task<MessageId> SimChannel::send(Bytes message, std::optional<double> bytes_on_wire) {
  const MessageId id = next_id_++;
  const Nanoseconds stack = host_.stack().transmit(host_.true_now(), key_of_sent(id));
  const Cpu::Turn turn = host_.cpu().reserve(occupancy(id) + stack);
  if (turn.end > host_.true_now()) {
    co_await sleep_until(host_.world().context, turn.end, "send");
  }
  host_.world().network.send(path_, id, std::move(message), bytes_on_wire);
  co_return id;
}

Task<std::optional<ReceivedMessage>> SimChannel::receive(SteadyTime deadline) {
  Inbox& inbox = host_.world().network.inbox(path_);
  SIMBENCH_ASSERT(!arrived_.waiting(), "one receive at a time on a channel");
  const TrueTime called = host_.true_now();
  while (inbox.empty()) {
    if (host_.is_past(deadline)) co_return std::nullopt;
    co_await arrived_.wait(host_.next_look(deadline));
  }
  const TrueTime returns = returns_at(inbox.front(), called);
  if (returns > host_.true_now()) {
    co_await sleep_until(host_.world().context, returns, "receive: wake up");
  }
  // Taken only now, so that a receive cancelled during the wake-up loses no message.
  ArrivedMessage message = std::move(inbox.front());
  inbox.pop_front();
  const SystemClock& clock = host_.system_clock();
  const ClockInterface& interface = host_.clock_interface();
  const TrueTime stamped = stamps_in_kernel_ ? stamp_of(message) : host_.true_now();
  const HostTime exact = clock.read(stamped);
  std::optional<HardwareTime> hardware;
  if (const NicClock* nic = host_.nic()) {
    const MessageKey key = key_from_peer(message.id);
    RandomStream draw(host_.world().run_seed, kHardwareReceipt, key.direction, key.message);
    hardware = nic->stamp(message.at, draw);
  }
  co_return ReceivedMessage{
      .bytes = std::move(message.bytes),
      .received = stamps_in_kernel_ ? interface.tick_of(exact) : interface.read(exact),
      .received_steady = clock.steady(stamped),
      .received_hardware = hardware};
}

void SimChannel::on_arrival() {
  Inbox& inbox = host_.world().network.inbox(path_);
  // The messages of one segment come up together.
  auto first = inbox.end();
  while (first != inbox.begin() && !std::prev(first)->stamped) --first;
  if (first != inbox.end()) {
    const TrueTime stamped = host_.stack().receive(first->at, key_from_peer(first->id));
    for (; first != inbox.end(); ++first) first->stamped = stamped;
  }
  arrived_.notify();
}

// When a receive() that was called then, and has found the message, returns.
TrueTime SimChannel::returns_at(const ArrivedMessage& message, TrueTime called) {
  const TrueTime stamped = stamp_of(message);
  const MessageKey key = key_from_peer(message.id);
  const Nanoseconds wake_up = from_ms(host_.world().hosts.receive_wake_up_ms) +
                              host_.load_delay(kLateWakeUp, key.direction, key.message);
  const bool has_waited = called <= stamped;
  return std::max(host_.true_now(), stamped) + wake_up +
         (has_waited ? host_.stack().wake_up(stamped, key) : Nanoseconds(0));
}

MessageKey SimChannel::key_of_sent(MessageId id) const {
  return {.direction = direction_of(host_.id(), peer_), .message = key_of(id)};
}

MessageKey SimChannel::key_from_peer(MessageId id) const {
  return {.direction = direction_of(peer_, host_.id()), .message = key_of(id)};
}

MessageKey SimMulticast::key_of_sent(MessageId id) const {
  return {.direction = direction_of(host_.id(), Groups::kEveryone), .message = id};
}

Task<MessageId> SimMulticast::send(Groups::Id group, Bytes message,
                                   std::optional<double> bytes_on_wire) {
  const MessageId id = next_id_++;
  const HostWorld& world = host_.world();
  std::vector<SimNetwork::Recipient> recipients;
  for (const PeerId member : world.network.groups().members(group)) {
    if (member == host_.id()) continue;
    recipients.push_back(host_.datagram_channel(member).next_of_group());
  }
  const MessageKey own = key_of_sent(id);
  RandomStream draw(world.run_seed, kGroupSendCost, own.direction, own.message);
  const double cost_ms =
      world.hosts.send_cost_ms + draw.exponential(world.hosts.send_cost_exponential_ms);
  const Nanoseconds stack = host_.stack().transmit(host_.true_now(), own);
  const Cpu::Turn turn = host_.cpu().reserve(from_ms(cost_ms) + stack);
  if (turn.end > host_.true_now()) {
    co_await sleep_until(world.context, turn.end, "send to a group");
  }
  world.network.send_to_group(host_.id(), id, std::move(recipients), std::move(message), *this,
                              bytes_on_wire);
  co_return id;
}

}  // namespace simbench::sim

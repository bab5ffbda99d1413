#include "sim/host/sim_multicast.h"

#include <utility>
#include <vector>

#include "sim/host/sim_channel.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kSendCost("host: cost of sending to a group");

}  // namespace

SimMulticast::SimMulticast(SimHost& host) : host_(host), departures_(host, "groups") {}

MessageKey SimMulticast::key(MessageId id) const {
  return {.direction = direction_of(host_.id(), Groups::kEveryone), .message = id};
}

Task<MessageId> SimMulticast::send(std::uint32_t group, Bytes message) {
  const MessageId id = next_id_++;
  const HostWorld& world = host_.world();
  std::vector<SimNetwork::Recipient> recipients;
  for (const PeerId member : world.network.groups().members(group)) {
    if (member == host_.id()) continue;
    recipients.push_back(host_.datagram_channel(member).next_of_group());
  }
  const MessageKey own = key(id);
  RandomStream draw(world.run_seed, kSendCost, own.direction, own.message);
  const double cost_ms =
      world.hosts.send_cost_ms + draw.exponential(world.hosts.send_cost_exponential_ms);
  const Nanoseconds stack = host_.stack().transmit(host_.true_now(), own);
  const Cpu::Turn turn = host_.cpu().reserve(from_ms(cost_ms) + stack);
  if (turn.end > host_.true_now()) {
    co_await sleep_until(world.context, turn.end, "send to a group");
  }
  world.network.send_to_group(host_.id(), id, std::move(recipients), std::move(message), *this);
  co_return id;
}

Nanoseconds SimMulticast::to_card(MessageId id) {
  return host_.stack().to_card(host_.true_now(), key(id));
}

void SimMulticast::on_left(MessageId first, std::size_t count, TrueTime passed) {
  departures_.on_left(first, count, passed);
}

Task<std::optional<HostTime>> SimMulticast::transmit_stamp(MessageId id, SteadyTime deadline) {
  return departures_.stamp(id, deadline);
}

Task<std::optional<HardwareTime>> SimMulticast::hardware_transmit_stamp(MessageId id,
                                                                        SteadyTime deadline) {
  return departures_.hardware_stamp(id, key(id), deadline);
}

}  // namespace simbench::sim

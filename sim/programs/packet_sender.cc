#include "sim/programs/packet_sender.h"

#include <linux/errqueue.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "sim/host/host_clocks.h"
#include "sim/host/sim_channel.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::sim {

std::int64_t stamp_of(const std::optional<HostTime>& stamp) {
  return stamp ? epoch_ns(*stamp) : shim::kNoStamp;
}

std::int64_t stamp_of(const std::optional<HardwareTime>& stamp) {
  return stamp ? nanoseconds_of(*stamp) + kEpochNs : shim::kNoStamp;
}

PacketSender::PacketSender(SimHost& host)
    : host_(host), has_left_(host.world().context, host.name("programs' messages pass the card")) {}

void PacketSender::enrol(UdpSocket& socket) {
  socket.number = ++enrolled_;
  sockets_.emplace(socket.number, &socket);
}

void PacketSender::dismiss(UdpSocket& socket) { sockets_.erase(socket.number); }

UdpSocket* PacketSender::find(std::uint64_t socket) const {
  const auto found = sockets_.find(socket);
  return found == sockets_.end() ? nullptr : found->second;
}

Task<MessageId> PacketSender::send_part(const Way& way, const WirePacket& part) {
  const double bytes = bytes_on_wire(part);
  if (way.peer) co_return co_await host_.datagram_channel(*way.peer).send(to_message(part), bytes);
  co_return co_await host_.multicast().send(way.group, to_message(part), bytes);
}

Task<std::optional<HostTime>> PacketSender::software_stamp(const Leaving& leaving,
                                                           SteadyTime deadline) {
  if (leaving.way.peer) {
    return host_.datagram_channel(*leaving.way.peer).transmit_stamp(leaving.message, deadline);
  }
  return host_.multicast().stamp(leaving.message, deadline);
}

Task<std::optional<HardwareTime>> PacketSender::hardware_stamp(const Leaving& leaving,
                                                               SteadyTime deadline) {
  if (leaving.way.peer) {
    return host_.datagram_channel(*leaving.way.peer)
        .hardware_transmit_stamp(leaving.message, deadline);
  }
  return host_.multicast().hardware_stamp(leaving.message, deadline);
}

Task<void> PacketSender::send(std::uint64_t socket, Way way, WirePacket packet, unsigned stamps,
                              QueuedDatagram told) {
  Leaving leaving{.socket = socket, .way = way, .told = std::move(told)};
  const std::vector<WirePacket> parts = fragments_of(std::move(packet));
  bool is_first = true;
  for (const WirePacket& part : parts) {
    const MessageId message = co_await send_part(way, part);
    if (std::exchange(is_first, false)) leaving.message = message;
  }
  if (stamps == 0) co_return;
  leaving.lacks_hardware =
      (stamps & shim::kHardwareStamps) != 0 && card_stamping_.departures && host_.nic() != nullptr;
  // As Linux, which takes both only where both are asked for.
  leaving.lacks_software = (stamps & shim::kSoftwareStamps) != 0 &&
                           (!leaving.lacks_hardware || (stamps & shim::kBothStamps) != 0);
  if (leaving.lacks_software) {
    const std::optional<HostTime> left =
        co_await software_stamp(leaving, host_.steady_clock().now());
    if (left) {
      tell(socket, leaving.told, stamp_of(left), shim::kNoStamp);
      leaving.lacks_software = false;
    }
  }
  if (!leaving.lacks_hardware && !leaving.lacks_software) co_return;
  leaving_.push_back(std::move(leaving));
  has_left_.notify();
}

void PacketSender::tell(std::uint64_t socket, QueuedDatagram told, std::int64_t system,
                        std::int64_t hardware) {
  UdpSocket* found = find(socket);
  if (found == nullptr) return;
  told.arrival.system = system;
  told.arrival.hardware = hardware;
  told.arrival.origin = SO_EE_ORIGIN_TIMESTAMPING;
  told.arrival.error = ENOMSG;
  queue_error(*found, std::move(told));
}

std::int64_t PacketSender::stamp_now() const {
  if (host_.world().network_parameters.stamp_point != scenarios::StampPoint::kKernel) {
    return shim::kNoStamp;
  }
  const HostTime now = host_.system_clock().read(host_.true_now());
  return epoch_ns(host_.clock_interface().tick_of(now));
}

void PacketSender::stamp_at_once(UdpSocket& socket, unsigned stamps, QueuedDatagram told) {
  const std::int64_t now = stamp_now();
  if ((stamps & shim::kSoftwareStamps) == 0 || now == shim::kNoStamp) return;
  tell(socket.number, std::move(told), now, shim::kNoStamp);
}

Task<void> PacketSender::stamp_departures() {
  for (;;) {
    while (leaving_.empty()) co_await has_left_.wait();
    Leaving leaving = std::move(leaving_.front());
    leaving_.pop_front();
    const SteadyTime deadline = host_.steady_clock().now() + kStampTimeout;
    if (leaving.lacks_software) {
      const std::optional<HostTime> left = co_await software_stamp(leaving, deadline);
      if (left) tell(leaving.socket, leaving.told, stamp_of(left), shim::kNoStamp);
    }
    if (!leaving.lacks_hardware) continue;
    const std::optional<HardwareTime> passed = co_await hardware_stamp(leaving, deadline);
    if (!passed) continue;
    tell(leaving.socket, std::move(leaving.told), shim::kNoStamp, stamp_of(passed));
  }
}

}  // namespace simbench::sim

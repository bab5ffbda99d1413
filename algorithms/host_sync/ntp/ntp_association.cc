#include "algorithms/host_sync/ntp/ntp_association.h"

#include <chrono>
#include <utility>

namespace simbench {
namespace {

constexpr Nanoseconds kIdle = std::chrono::hours(1);  // a server's wait is endless, in steps
constexpr std::uint8_t kVersion = 4;
constexpr std::uint8_t kStratumLocal = 1;
constexpr std::uint32_t kReferenceLocal = 0x4C4F434C;  // "LOCL"
constexpr std::int8_t kPrecision = -23;                // 100 ns
constexpr double kShortFormatUnit = 1.0 / 65536;

NtpPacket server_packet(std::uint8_t mode, HostTime reference) {
  NtpPacket packet;
  packet.version = kVersion;
  packet.mode = mode;
  packet.stratum = kStratumLocal;
  packet.precision = kPrecision;
  packet.reference_id = kReferenceLocal;
  packet.reference = to_ntp(reference);
  return packet;
}

bool is_synchronised_server(const NtpPacket& packet) {
  return packet.leap != kNtpLeapAlarm && packet.stratum >= 1 && packet.stratum <= kNtpStratumMax &&
         packet.transmit != NtpTimestamp{};
}

}  // namespace

double NtpMeasurement::offset_s() const { return to_seconds(clock_offset(t1, t2, t3, t4)); }

double NtpMeasurement::delay_s() const { return to_seconds((t4 - t1) - (t3 - t2)); }

double NtpBroadcast::offset_s() const { return to_seconds(t3 - t4); }

bool is_valid_ntp_reply(const NtpPacket& reply, NtpTimestamp sent) {
  return reply.mode == kNtpModeServer && reply.origin == sent && reply.receive != NtpTimestamp{} &&
         is_synchronised_server(reply);
}

bool is_valid_ntp_broadcast(const NtpPacket& packet) {
  return packet.mode == kNtpModeBroadcast && is_synchronised_server(packet);
}

NtpAssociation::NtpAssociation(Host& host, PeerId server, NtpStamps stamps, std::uint8_t version)
    : host_(host),
      server_(server),
      stamps_(stamps),
      version_(version),
      channel_(host.open_channel(server, Transport::kDatagram)) {}

Task<std::optional<NtpMeasurement>> NtpAssociation::exchange(Nanoseconds timeout) {
  NtpMeasurement measurement;
  measurement.t1 = co_await host_.clock().now();
  NtpPacket request;
  request.version = version_;
  request.transmit = to_ntp(measurement.t1);
  Bytes bytes = encode(request);
  const SteadyTime deadline = host_.steady_clock().now() + timeout;
  const MessageId id = co_await channel_.send(std::move(bytes));
  if (stamps_ == NtpStamps::kKernel) {
    const std::optional<HostTime> left = co_await channel_.transmit_stamp(id, deadline);
    measurement.t1 = left.value_or(measurement.t1);
  }
  while (true) {
    const std::optional<ReceivedMessage> received = co_await channel_.receive(deadline);
    if (!received) co_return std::nullopt;
    const std::optional<NtpPacket> reply = decode_ntp_packet(received->bytes);
    if (!reply || !is_valid_ntp_reply(*reply, request.transmit)) continue;
    measurement.t2 = from_ntp(reply->receive, measurement.t1);
    measurement.t3 = from_ntp(reply->transmit, measurement.t1);
    measurement.t4 = received->received;
    measurement.received = received->received_steady;
    measurement.root_delay_s = reply->root_delay * kShortFormatUnit;
    measurement.root_dispersion_s = reply->root_dispersion * kShortFormatUnit;
    host_.report_exchange(measurement.exchange(server_));
    co_return measurement;
  }
}

Task<std::optional<NtpBroadcast>> NtpAssociation::next_broadcast(SteadyTime deadline) {
  while (true) {
    const std::optional<ReceivedMessage> received = co_await channel_.receive(deadline);
    if (!received) co_return std::nullopt;
    const std::optional<NtpPacket> packet = decode_ntp_packet(received->bytes);
    if (!packet || !is_valid_ntp_broadcast(*packet)) continue;
    NtpBroadcast broadcast;
    broadcast.t3 = from_ntp(packet->transmit, received->received);
    broadcast.t4 = received->received;
    broadcast.received = received->received_steady;
    host_.report_exchange(broadcast.exchange(server_));
    co_return broadcast;
  }
}

Task<void> serve_ntp(Host& host, PeerId client, double root_dispersion_s) {
  MessageChannel& channel = host.open_channel(client, Transport::kDatagram);
  while (true) {
    const std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received) continue;
    const std::optional<NtpPacket> request = decode_ntp_packet(received->bytes);
    if (!request || request->mode != kNtpModeClient) continue;
    NtpPacket reply = server_packet(kNtpModeServer, received->received);
    reply.version = request->version;
    reply.poll = request->poll;
    reply.root_dispersion = static_cast<std::uint32_t>(root_dispersion_s / kShortFormatUnit);
    reply.origin = request->transmit;
    reply.receive = to_ntp(received->received);
    const HostTime t3 = co_await host.clock().now();
    reply.transmit = to_ntp(t3);
    Bytes bytes = encode(reply);
    co_await channel.send(std::move(bytes));
  }
}

Task<void> broadcast_ntp(Host& host, std::vector<PeerId> clients, Nanoseconds interval) {
  while (true) {
    for (const PeerId client : clients) {
      const HostTime t3 = co_await host.clock().now();
      NtpPacket packet = server_packet(kNtpModeBroadcast, t3);
      packet.transmit = to_ntp(t3);
      Bytes bytes = encode(packet);
      co_await host.open_channel(client, Transport::kDatagram).send(std::move(bytes));
    }
    co_await host.sleep_for(interval);
  }
}

}  // namespace simbench

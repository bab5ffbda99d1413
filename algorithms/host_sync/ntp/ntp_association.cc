#include "algorithms/host_sync/ntp/ntp_association.h"

#include <boost/endian/conversion.hpp>
#include <deque>
#include <utility>

#include "algorithms/host_sync/cross_stamps.h"
#include "algorithms/host_sync/join.h"

namespace simbench {
namespace {

constexpr std::int64_t kSeconds1900To1970 = 2'208'988'800;

struct SplitTime {
  std::int64_t seconds;  // since 1900, whole, rounded down
  std::uint64_t ns;      // the rest, below a second
};

SplitTime split(HostTime time) {
  const std::int64_t total_ns = nanoseconds_of(time);
  const std::int64_t seconds = floor_div(total_ns, kSecondNs);
  return {seconds + kSeconds1900To1970, static_cast<std::uint64_t>(total_ns - seconds * kSecondNs)};
}

void store(unsigned char* at, NtpTimestamp stamp) {
  boost::endian::store_big_u32(at, stamp.seconds);
  boost::endian::store_big_u32(at + 4, stamp.fraction);
}

NtpTimestamp load(const unsigned char* at) {
  return {boost::endian::load_big_u32(at), boost::endian::load_big_u32(at + 4)};
}

}  // namespace

NtpTimestamp to_ntp(HostTime time) {
  const SplitTime parts = split(time);
  // A nanosecond is 4.3 fractions: rounding to nearest both ways restores the nanosecond.
  const std::uint64_t fraction = ((parts.ns << 32) + kSecondNs / 2) / kSecondNs;
  return {static_cast<std::uint32_t>(parts.seconds), static_cast<std::uint32_t>(fraction)};
}

HostTime from_ntp(NtpTimestamp stamp, HostTime near) {
  const SplitTime base = split(near);
  const auto ahead =
      static_cast<std::int32_t>(stamp.seconds - static_cast<std::uint32_t>(base.seconds));
  const std::int64_t seconds = base.seconds + ahead - kSeconds1900To1970;
  const std::uint64_t ns =
      (static_cast<std::uint64_t>(stamp.fraction) * kSecondNs + (1ULL << 31)) >> 32;
  return HostTime(Nanoseconds(seconds * kSecondNs + static_cast<std::int64_t>(ns)));
}

Bytes encode(const NtpPacket& packet) {
  Bytes bytes(kNtpPacketBytes);
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  at[0] = static_cast<unsigned char>(((packet.leap & 3U) << 6) | ((packet.version & 7U) << 3) |
                                     (packet.mode & 7U));
  at[1] = packet.stratum;
  at[2] = static_cast<unsigned char>(packet.poll);
  at[3] = static_cast<unsigned char>(packet.precision);
  boost::endian::store_big_u32(at + 4, packet.root_delay);
  boost::endian::store_big_u32(at + 8, packet.root_dispersion);
  boost::endian::store_big_u32(at + 12, packet.reference_id);
  store(at + 16, packet.reference);
  store(at + 24, packet.origin);
  store(at + 32, packet.receive);
  store(at + 40, packet.transmit);
  return bytes;
}

std::optional<NtpPacket> decode_ntp_packet(const Bytes& bytes) {
  if (bytes.size() != kNtpPacketBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  NtpPacket packet;
  packet.leap = static_cast<std::uint8_t>(at[0] >> 6);
  packet.version = static_cast<std::uint8_t>((at[0] >> 3) & 7U);
  packet.mode = static_cast<std::uint8_t>(at[0] & 7U);
  if (packet.version < 1 || packet.version > 4) return std::nullopt;
  packet.stratum = at[1];
  packet.poll = static_cast<std::int8_t>(at[2]);
  packet.precision = static_cast<std::int8_t>(at[3]);
  packet.root_delay = boost::endian::load_big_u32(at + 4);
  packet.root_dispersion = boost::endian::load_big_u32(at + 8);
  packet.reference_id = boost::endian::load_big_u32(at + 12);
  packet.reference = load(at + 16);
  packet.origin = load(at + 24);
  packet.receive = load(at + 32);
  packet.transmit = load(at + 40);
  return packet;
}

Nanoseconds clock_offset(HostTime t1, HostTime t2, HostTime t3, HostTime t4) {
  return ((t2 - t1) + (t3 - t4)) / 2;
}

namespace {

constexpr std::uint8_t kNtpVersion = 4;
constexpr std::uint8_t kStratumLocal = 1;
constexpr std::uint32_t kReferenceLocal = 0x4C4F434C;  // "LOCL"
constexpr std::int8_t kPrecision = -23;                // 100 ns
constexpr double kShortFormatUnit = 1.0 / 65536;
constexpr int kMaxUnanswered = 4;        // requests in interleaved mode
constexpr std::size_t kRepliesKept = 5;  // one more

NtpPacket server_packet(std::uint8_t mode, HostTime reference) {
  NtpPacket packet;
  packet.version = kNtpVersion;
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

bool is_interleaved_reply(const NtpPacket& reply, const NtpPacket& request) {
  return request.receive != NtpTimestamp{} && reply.origin == request.receive;
}

bool is_valid_ntp_reply(const NtpPacket& reply, const NtpPacket& request) {
  return reply.mode == kNtpModeServer && reply.receive != NtpTimestamp{} &&
         (reply.origin == request.transmit || is_interleaved_reply(reply, request)) &&
         is_synchronised_server(reply);
}

bool is_valid_ntp_broadcast(const NtpPacket& packet) {
  return packet.mode == kNtpModeBroadcast && is_synchronised_server(packet);
}

}  // namespace

double NtpMeasurement::offset_s() const { return to_seconds(clock_offset(t1, t2, t3, t4)); }

double NtpMeasurement::delay_s() const { return to_seconds((t4 - t1) - (t3 - t2)); }

double NtpBroadcast::offset_s() const { return to_seconds(t3 - t4); }

namespace {

// What the system clock read when the card's clock read that.
Task<HostTime> on_system_clock(Host& host, HardwareTime stamp) {
  const CrossStamp now = co_await narrowest_cross_stamp(host);
  co_return now.before + (now.after - now.before) / 2 + (stamp - now.hardware);
}

// When a message arrived that was received just now; nothing if the card was to stamp it and did
// not.
Task<std::optional<HostTime>> arrival_of(Host& host, const ReceivedMessage& message,
                                         NtpStamps stamps) {
  if (stamps == NtpStamps::kProgram) {
    const HostTime now = co_await host.clock().now();
    co_return now;
  }
  if (stamps != NtpStamps::kCard) co_return message.received;
  if (!message.received_hardware || host.hardware_clock() == nullptr) co_return std::nullopt;
  const HostTime arrived = co_await on_system_clock(host, *message.received_hardware);
  co_return arrived;
}

// When the message left, by its host's stamp.
Task<std::optional<HostTime>> stamped_departure(Host& host, MessageChannel& channel,
                                                MessageStamps& departures, MessageId id) {
  const std::optional<std::int64_t> left = co_await departures.departure(channel, id);
  if (!left) co_return std::nullopt;
  if (departures.source() != StampSource::kCard) co_return HostTime(Nanoseconds(*left));
  const HostTime converted = co_await on_system_clock(host, HardwareTime(Nanoseconds(*left)));
  co_return converted;
}

}  // namespace

NtpAssociation::NtpAssociation(Host& host, PeerId server, NtpStamps stamps, std::uint8_t version)
    : host_(host),
      server_(server),
      stamps_(stamps),
      version_(version),
      channel_(host.open_channel(server, Transport::kDatagram)),
      departures_(host, stamps == NtpStamps::kCard ? StampSource::kCard : StampSource::kKernel) {}

Task<std::optional<NtpMeasurement>> NtpAssociation::exchange(Nanoseconds timeout) {
  NtpMeasurement measurement;
  measurement.is_translated = stamps_ == NtpStamps::kCard;
  measurement.t1 = co_await host_.clock().now();
  NtpPacket request;
  request.version = version_;
  request.transmit = to_ntp(measurement.t1);
  if (interleaves_ && unanswered_ < kMaxUnanswered) {
    request.origin = server_received_;
    request.receive = reply_received_;
  }
  ++unanswered_;
  Bytes bytes = encode(request);
  const SteadyTime deadline = host_.steady_clock().now() + timeout;
  const MessageId id = co_await channel_.send(std::move(bytes));
  if (stamps_ == NtpStamps::kKernel || stamps_ == NtpStamps::kCard) {
    const std::optional<HostTime> left =
        co_await stamped_departure(host_, channel_, departures_, id);
    measurement.is_stamped = left.has_value();
    if (left) measurement.t1 = *left;
  }
  while (true) {
    const std::optional<ReceivedMessage> received = co_await channel_.receive(deadline);
    if (!received) co_return std::nullopt;
    const std::optional<NtpPacket> reply = decode_ntp_packet(received->bytes);
    if (!reply || !is_valid_ntp_reply(*reply, request)) continue;
    unanswered_ = 0;
    const std::optional<HostTime> arrived = co_await arrival_of(host_, *received, stamps_);
    if (!arrived) co_return std::nullopt;
    server_received_ = reply->receive;
    reply_received_ = to_ntp(*arrived);
    measurement.t2 = from_ntp(reply->receive, measurement.t1);
    measurement.t3 = from_ntp(reply->transmit, measurement.t1);
    measurement.t4 = *arrived;
    measurement.received = received->received_steady;
    measurement.is_interleaved = is_interleaved_reply(*reply, request);
    measurement.root_delay_s = reply->root_delay * kShortFormatUnit;
    measurement.root_dispersion_s = reply->root_dispersion * kShortFormatUnit;
    if (!measurement.is_interleaved) host_.report_exchange(measurement.exchange(server_));
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

namespace {

// The replies to one client and when they left.
class NtpReplies {
 public:
  NtpReplies(Host& host, MessageChannel& channel, NtpStamps stamps)
      : host_(host),
        channel_(channel),
        stamps_(stamps),
        departures_(host, stamps == NtpStamps::kCard ? StampSource::kCard : StampSource::kKernel) {}

  // A reply was sent just now whose receive and transmit stamps these are.
  Task<void> sent(NtpTimestamp receive, HostTime transmit, MessageId id) {
    Sent reply{.receive = receive, .id = id};
    if (stamps_ == NtpStamps::kProgram) reply.left = transmit;
    // The card's clock runs by itself: its stamp is converted at once.
    if (stamps_ == NtpStamps::kCard) {
      reply.left = co_await stamped_departure(host_, channel_, departures_, id);
    }
    sent_.push_back(reply);
    if (sent_.size() > kRepliesKept) sent_.pop_front();
  }

  // When the reply left whose receive stamp is `receive`; nothing if that is not known.
  Task<std::optional<HostTime>> departure(NtpTimestamp receive) {
    for (const Sent& reply : sent_) {
      if (reply.receive != receive) continue;
      const bool is_kernels = stamps_ == NtpStamps::kApplication || stamps_ == NtpStamps::kKernel;
      if (!is_kernels) co_return reply.left;
      const SteadyTime deadline = host_.steady_clock().now() + kStampTimeout;
      const std::optional<HostTime> left = co_await channel_.transmit_stamp(reply.id, deadline);
      co_return left;
    }
    co_return std::nullopt;
  }

 private:
  struct Sent {
    NtpTimestamp receive;
    MessageId id = 0;
    std::optional<HostTime> left{};
  };

  Host& host_;
  MessageChannel& channel_;
  NtpStamps stamps_;
  MessageStamps departures_;
  std::deque<Sent> sent_;
};

NtpPacket reply_to(const NtpPacket& request, HostTime arrived, const NtpServing& serving) {
  NtpPacket reply = server_packet(kNtpModeServer, arrived);
  if (serving.is_synchronised && !*serving.is_synchronised) reply.leap = kNtpLeapAlarm;
  reply.version = request.version;
  reply.poll = request.poll;
  reply.root_dispersion = static_cast<std::uint32_t>(serving.root_dispersion_s / kShortFormatUnit);
  reply.origin = request.transmit;
  reply.receive = to_ntp(arrived);
  return reply;
}

Task<void> serve_client(Host& host, PeerId client, NtpServing serving) {
  MessageChannel& channel = host.open_channel(client, Transport::kDatagram);
  NtpReplies replies(host, channel, serving.stamps);
  while (true) {
    const std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (!received) continue;
    const std::optional<NtpPacket> request = decode_ntp_packet(received->bytes);
    if (!request || request->mode != kNtpModeClient) continue;
    const std::optional<HostTime> arrived = co_await arrival_of(host, *received, serving.stamps);
    if (!arrived) continue;
    NtpPacket reply = reply_to(*request, *arrived, serving);
    const std::optional<HostTime> left = co_await replies.departure(request->origin);
    HostTime t3 = left.value_or(HostTime{});
    if (left) reply.origin = request->receive;
    if (!left || serving.stamps == NtpStamps::kProgram) t3 = co_await host.clock().now();
    reply.transmit = to_ntp(left.value_or(t3));
    Bytes bytes = encode(reply);
    const MessageId id = co_await channel.send(std::move(bytes));
    co_await replies.sent(reply.receive, t3, id);
  }
}

}  // namespace

Task<void> serve_ntp(Host& host, std::vector<PeerId> clients, NtpServing serving) {
  if (serving.stamps == NtpStamps::kCard && host.hardware_clock() == nullptr) co_return;
  std::vector<Task<void>> servers;
  servers.reserve(clients.size());
  for (const PeerId client : clients) servers.push_back(serve_client(host, client, serving));
  co_await join_all(std::move(servers));
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

#include "algorithms/host_sync/two_way/two_way_probe.h"

#include <boost/endian/conversion.hpp>
#include <utility>

namespace simbench {
namespace {

constexpr std::uint16_t kMagic = 0x5754;
constexpr std::uint8_t kVersion = 1;
// Times this far from zero can still be subtracted in 64 bits.
constexpr std::int64_t kMostNs = 4'000'000'000'000'000'000;

bool is_possible(HostTime time) {
  return nanoseconds_of(time) <= kMostNs && nanoseconds_of(time) >= -kMostNs;
}

}  // namespace

Bytes encode(const TwoWayMessage& message) {
  Bytes bytes(kTwoWayMessageBytes);
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  boost::endian::store_little_u16(at, kMagic);
  at[2] = kVersion;
  at[3] = static_cast<unsigned char>(message.kind);
  boost::endian::store_little_u32(at + 4, message.index);
  boost::endian::store_little_s64(at + 8, nanoseconds_of(message.arrived));
  boost::endian::store_little_u32(at + 16, message.replied_index);
  boost::endian::store_little_s64(at + 20, nanoseconds_of(message.replied));
  return bytes;
}

std::optional<TwoWayMessage> decode_two_way_message(const Bytes& bytes) {
  if (bytes.size() != kTwoWayMessageBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  if (boost::endian::load_little_u16(at) != kMagic || at[2] != kVersion) return std::nullopt;
  TwoWayMessage message;
  message.kind = static_cast<TwoWayMessage::Kind>(at[3]);
  message.index = boost::endian::load_little_u32(at + 4);
  message.arrived = HostTime(Nanoseconds(boost::endian::load_little_s64(at + 8)));
  message.replied_index = boost::endian::load_little_u32(at + 16);
  message.replied = HostTime(Nanoseconds(boost::endian::load_little_s64(at + 20)));
  if (!is_possible(message.arrived) || !is_possible(message.replied)) return std::nullopt;
  if (message.index == 0 || message.replied_index > message.index) return std::nullopt;
  if (message.replied_index == 0 && message.replied != HostTime{}) return std::nullopt;
  if (message.kind == TwoWayMessage::Kind::kReply) return message;
  const bool is_request = message.kind == TwoWayMessage::Kind::kRequest &&
                          message.replied_index < message.index && message.arrived == HostTime{} &&
                          message.replied == HostTime{};
  if (!is_request) return std::nullopt;
  return message;
}

namespace {

constexpr Nanoseconds kIdle{3'600'000'000'000};
// A host that stamps departures tells them soon, or not at all.
constexpr Nanoseconds kStampTimeout{10'000'000};
// A request this much older than the last one is not late: its sender has started again.
constexpr std::uint32_t kLateRequests = 64;

}  // namespace

Task<SteadyTime> departure_of(Host& host, MessageChannel& channel, MessageId id, SteadyTime begin,
                              std::shared_ptr<const SteeredClock> clock) {
  const SteadyTime returned = host.steady_clock().now();
  const std::optional<HostTime> stamp =
      co_await channel.transmit_stamp(id, returned + kStampTimeout);
  if (!stamp) co_return returned;
  const SteadyTime departure = clock->when(*stamp);
  co_return departure < begin ? returned : departure;
}

Task<void> TwoWayServer::answer(ReceivedMessage received) {
  clock_->observe(received.received, received.received_steady);
  const std::optional<TwoWayMessage> request = decode_two_way_message(received.bytes);
  if (!request || request->kind != TwoWayMessage::Kind::kRequest) co_return;
  const bool is_late =
      request->index <= last_index_ && last_index_ - request->index < kLateRequests;
  if (is_late) co_return;
  MessageChannel& channel = host_.open_channel(client_, Transport::kDatagram);
  TwoWayMessage reply{.kind = TwoWayMessage::Kind::kReply,
                      .index = request->index,
                      .arrived = clock_->at(received.received_steady),
                      .replied_index = 0,
                      .replied = {}};
  if (is_naive_) {
    reply.replied_index = reply.index;
    reply.replied = clock_->at(host_.steady_clock().now());
  }
  for (const Departure& departure : departures_) {
    if (departure.index != request->replied_index) continue;
    reply.replied_index = departure.index;
    reply.replied = departure.at;
  }
  Bytes bytes = encode(reply);
  const SteadyTime begin = host_.steady_clock().now();
  const MessageId id = co_await channel.send(std::move(bytes));
  last_index_ = request->index;
  if (is_naive_) co_return;
  const SteadyTime departure = co_await departure_of(host_, channel, id, begin, clock_);
  departures_.push_back({request->index, clock_->at(departure)});
  if (departures_.size() > kDepartures) departures_.pop_front();
}

Task<void> serve_two_way(Host& host, PeerId client, std::shared_ptr<SteeredClock> clock,
                         bool is_naive) {
  TwoWayServer server(host, client, std::move(clock), is_naive);
  MessageChannel& channel = host.open_channel(client, Transport::kDatagram);
  while (true) {
    std::optional<ReceivedMessage> received =
        co_await channel.receive(host.steady_clock().now() + kIdle);
    if (received) co_await server.answer(std::move(*received));
  }
}

Task<std::optional<TwoWayExchange>> TwoWayClient::ask(Nanoseconds timeout) {
  MessageChannel& channel = host_.open_channel(server_, Transport::kDatagram);
  present_ = Open{.index = ++index_, .exchange = {}, .t1 = {}, .t4 = {}};
  const SteadyTime begin = host_.steady_clock().now();
  const std::uint32_t wanted = last_ && !is_naive_ ? last_->index : 0;
  Bytes bytes = encode(TwoWayMessage{.index = index_, .replied_index = wanted});
  const MessageId id = co_await channel.send(std::move(bytes));
  SteadyTime sent = begin;
  if (!is_naive_) sent = co_await departure_of(host_, channel, id, begin, clock_);
  present_.exchange.sent = sent;
  while (true) {
    std::optional<ReceivedMessage> received = co_await channel.receive(begin + timeout);
    if (!received) co_return std::nullopt;
    clock_->observe(received->received, received->received_steady);
    const std::optional<TwoWayMessage> reply = decode_two_way_message(received->bytes);
    if (!reply || reply->kind != TwoWayMessage::Kind::kReply || reply->index != index_) continue;
    ++answered_;
    co_return complete(*reply, received->received_steady);
  }
}

std::optional<TwoWayExchange> TwoWayClient::complete(const TwoWayMessage& reply,
                                                     SteadyTime received) {
  present_.exchange.arrived = reply.arrived;
  present_.exchange.received = received;
  present_.t1 = clock_->at(present_.exchange.sent);
  present_.t4 = clock_->at(received);
  std::optional<TwoWayExchange> completed;
  if (reply.replied_index == present_.index) {
    completed = report(present_, reply.replied);
  } else if (last_ && reply.replied_index == last_->index) {
    completed = report(*last_, reply.replied);
  }
  last_ = present_;
  return completed;
}

TwoWayExchange TwoWayClient::report(Open& open, HostTime replied) {
  open.exchange.replied = replied;
  host_.report_exchange(
      {.peer = server_, .t1 = open.t1, .t2 = open.exchange.arrived, .t3 = replied, .t4 = open.t4});
  return open.exchange;
}

}  // namespace simbench

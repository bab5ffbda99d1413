#include "algorithms/host_sync/messages.h"

#include <boost/endian/conversion.hpp>

namespace simbench {
namespace {

using boost::endian::load_little_s64;
using boost::endian::load_little_u16;
using boost::endian::load_little_u32;
using boost::endian::store_little_s64;
using boost::endian::store_little_u32;

constexpr std::uint16_t kSessionMagic = 0x3259;
constexpr std::uint16_t kTwoWayMagic = 0x5754;
constexpr std::uint16_t kCommonViewMagic = 0x5643;
constexpr std::size_t kCommonViewMessageBytes = 28;
constexpr std::uint8_t kMessageVersion = 1;
constexpr std::uint8_t kCommonViewRequest = 1;
constexpr std::uint8_t kCommonViewAnswer = 2;
// Times this far from zero can still be subtracted in 64 bits.
constexpr std::int64_t kMostNs = 4'000'000'000'000'000'000;

// Writes what all messages begin with; returns where they begin.
unsigned char* begin_message(Bytes& bytes, std::uint16_t magic, std::uint8_t kind) {
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  boost::endian::store_little_u16(at, magic);
  at[2] = kMessageVersion;
  at[3] = kind;
  return at;
}

// Where the message begins; null if the bytes are no message of that size and protocol.
const unsigned char* message_in(const Bytes& bytes, std::size_t size, std::uint16_t magic) {
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  if (bytes.size() != size || load_little_u16(at) != magic) return nullptr;
  return at[2] == kMessageVersion ? at : nullptr;
}

HostTime load_time(const unsigned char* at) { return HostTime(Nanoseconds(load_little_s64(at))); }

bool is_possible(HostTime time) {
  return nanoseconds_of(time) <= kMostNs && nanoseconds_of(time) >= -kMostNs;
}

bool carries_index(MessageKind kind) {
  return kind == MessageKind::kStamp || kind == MessageKind::kRequest;
}

bool carries_time(MessageKind kind) {
  return kind == MessageKind::kStamp || kind == MessageKind::kSetTime ||
         kind == MessageKind::kSlaveTime;
}

}  // namespace

Bytes encode(const SessionMessage& message) {
  Bytes bytes(kSessionMessageBytes);
  auto* at = begin_message(bytes, kSessionMagic, static_cast<std::uint8_t>(message.kind));
  store_little_u32(at + 4, message.pass);
  store_little_u32(at + 8, message.index);
  store_little_s64(at + 12, nanoseconds_of(message.time));
  return bytes;
}

std::optional<SessionMessage> decode_session_message(const Bytes& bytes) {
  const unsigned char* at = message_in(bytes, kSessionMessageBytes, kSessionMagic);
  if (at == nullptr || at[3] < static_cast<unsigned char>(MessageKind::kReady) ||
      at[3] > static_cast<unsigned char>(MessageKind::kGiveUp)) {
    return std::nullopt;
  }
  const SessionMessage message{.kind = static_cast<MessageKind>(at[3]),
                               .pass = load_little_u32(at + 4),
                               .index = load_little_u32(at + 8),
                               .time = load_time(at + 12)};
  if (message.index != 0 && !carries_index(message.kind)) return std::nullopt;
  if (message.time != HostTime{} && !carries_time(message.kind)) return std::nullopt;
  return message;
}

Bytes encode(const TwoWayMessage& message) {
  Bytes bytes(kTwoWayMessageBytes);
  auto* at = begin_message(bytes, kTwoWayMagic, static_cast<std::uint8_t>(message.kind));
  store_little_u32(at + 4, message.index);
  store_little_s64(at + 8, nanoseconds_of(message.arrived));
  store_little_u32(at + 16, message.replied_index);
  store_little_s64(at + 20, nanoseconds_of(message.replied));
  return bytes;
}

std::optional<TwoWayMessage> decode_two_way_message(const Bytes& bytes) {
  const unsigned char* at = message_in(bytes, kTwoWayMessageBytes, kTwoWayMagic);
  if (at == nullptr) return std::nullopt;
  const TwoWayMessage message{.kind = static_cast<TwoWayMessage::Kind>(at[3]),
                              .index = load_little_u32(at + 4),
                              .arrived = load_time(at + 8),
                              .replied_index = load_little_u32(at + 16),
                              .replied = load_time(at + 20)};
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

Bytes encode(const CommonViewMessage& message) {
  Bytes bytes(kCommonViewMessageBytes);
  auto* at = begin_message(bytes, kCommonViewMagic,
                           message.is_answer ? kCommonViewAnswer : kCommonViewRequest);
  store_little_u32(at + 4, message.index);
  if (!message.pulse) return bytes;
  store_little_s64(at + 8, nanoseconds_of(message.pulse->at));
  store_little_s64(at + 16, message.pulse->sigma_ns);
  store_little_u32(at + 24, 1);
  return bytes;
}

std::optional<CommonViewMessage> decode_common_view_message(const Bytes& bytes) {
  const unsigned char* at = message_in(bytes, kCommonViewMessageBytes, kCommonViewMagic);
  if (at == nullptr || (at[3] != kCommonViewRequest && at[3] != kCommonViewAnswer)) {
    return std::nullopt;
  }
  CommonViewMessage message{.is_answer = at[3] == kCommonViewAnswer,
                            .index = load_little_u32(at + 4)};
  const CommonViewMessage::Pulse pulse{.at = load_time(at + 8),
                                       .sigma_ns = load_little_s64(at + 16)};
  const std::uint32_t pulses = load_little_u32(at + 24);
  if (message.index == 0 || pulse.sigma_ns < 0 || !is_possible(pulse.at)) return std::nullopt;
  if (pulses == 0) {
    if (pulse != CommonViewMessage::Pulse{}) return std::nullopt;
    return message;
  }
  if (pulses != 1 || !message.is_answer) return std::nullopt;
  message.pulse = pulse;
  return message;
}

}  // namespace simbench

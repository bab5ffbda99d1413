#include "algorithms/host_sync/yoon2021/wire.h"

#include <boost/endian/conversion.hpp>

namespace simbench {
namespace {

constexpr std::uint16_t kMagic = 0x3259;
constexpr std::uint8_t kVersion = 1;

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
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  boost::endian::store_little_u16(at, kMagic);
  at[2] = kVersion;
  at[3] = static_cast<unsigned char>(message.kind);
  boost::endian::store_little_u32(at + 4, message.pass);
  boost::endian::store_little_u32(at + 8, message.index);
  boost::endian::store_little_s64(at + 12, nanoseconds_of(message.time));
  return bytes;
}

std::optional<SessionMessage> decode_session_message(const Bytes& bytes) {
  if (bytes.size() != kSessionMessageBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  if (boost::endian::load_little_u16(at) != kMagic || at[2] != kVersion) return std::nullopt;
  if (at[3] < static_cast<unsigned char>(MessageKind::kReady) ||
      at[3] > static_cast<unsigned char>(MessageKind::kGiveUp)) {
    return std::nullopt;
  }
  SessionMessage message;
  message.kind = static_cast<MessageKind>(at[3]);
  message.pass = boost::endian::load_little_u32(at + 4);
  message.index = boost::endian::load_little_u32(at + 8);
  message.time = HostTime(Nanoseconds(boost::endian::load_little_s64(at + 12)));
  if (message.index != 0 && !carries_index(message.kind)) return std::nullopt;
  if (message.time != HostTime{} && !carries_time(message.kind)) return std::nullopt;
  return message;
}

}  // namespace simbench

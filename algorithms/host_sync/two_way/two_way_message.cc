#include "algorithms/host_sync/two_way/two_way_message.h"

#include <boost/endian/conversion.hpp>

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

}  // namespace simbench

#include "algorithms/host_sync/pulses/common_view_message.h"

#include <boost/endian/conversion.hpp>

namespace simbench {
namespace {

constexpr std::size_t kBytes = 28;
constexpr std::uint16_t kMagic = 0x5643;
constexpr std::uint8_t kVersion = 1;
// Times this far from zero can still be subtracted in 64 bits.
constexpr std::int64_t kMostNs = 4'000'000'000'000'000'000;
constexpr std::uint8_t kRequest = 1;
constexpr std::uint8_t kAnswer = 2;

}  // namespace

Bytes encode(const CommonViewMessage& message) {
  Bytes bytes(kBytes);
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  boost::endian::store_little_u16(at, kMagic);
  at[2] = kVersion;
  at[3] = message.is_answer ? kAnswer : kRequest;
  boost::endian::store_little_u32(at + 4, message.index);
  if (!message.pulse) return bytes;
  boost::endian::store_little_s64(at + 8, nanoseconds_of(message.pulse->at));
  boost::endian::store_little_s64(at + 16, message.pulse->sigma_ns);
  boost::endian::store_little_u32(at + 24, 1);
  return bytes;
}

std::optional<CommonViewMessage> decode_common_view_message(const Bytes& bytes) {
  if (bytes.size() != kBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  if (boost::endian::load_little_u16(at) != kMagic || at[2] != kVersion) return std::nullopt;
  if (at[3] != kRequest && at[3] != kAnswer) return std::nullopt;
  CommonViewMessage message;
  message.is_answer = at[3] == kAnswer;
  message.index = boost::endian::load_little_u32(at + 4);
  const std::int64_t pulse_ns = boost::endian::load_little_s64(at + 8);
  const std::int64_t sigma_ns = boost::endian::load_little_s64(at + 16);
  const std::uint32_t pulses = boost::endian::load_little_u32(at + 24);
  if (message.index == 0 || sigma_ns < 0) return std::nullopt;
  if (pulse_ns > kMostNs || pulse_ns < -kMostNs) return std::nullopt;
  if (pulses == 0) {
    if (pulse_ns != 0 || sigma_ns != 0) return std::nullopt;
    return message;
  }
  if (pulses != 1 || !message.is_answer) return std::nullopt;
  message.pulse = CommonViewMessage::Pulse{HostTime(Nanoseconds(pulse_ns)), sigma_ns};
  return message;
}

}  // namespace simbench

#include "algorithms/host_sync/ptp/ptp_message.h"

#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>

namespace simbench {
namespace {

constexpr std::size_t kShortBytes = 44;
constexpr std::size_t kLongBytes = 54;
constexpr std::size_t kAnnounceBytes = 64;
constexpr std::uint8_t kPtpVersion = 2;
constexpr std::uint16_t kTwoStep = 0x0200;
constexpr std::uint16_t kSimple = 0x2400;
constexpr std::uint8_t kNoInterval = 0x7f;
constexpr std::uint16_t kPort = 1;
// Times this far from zero can still be subtracted in 64 bits.
constexpr std::int64_t kMostSeconds = 4'000'000'000;

// The follow-up information of 802.1AS.
constexpr std::size_t kInformationBytes = 32;
constexpr std::array<unsigned char, 10> kInformationHead = {0, 3, 0, 28, 0x00, 0x80, 0xc2, 0, 0, 1};
constexpr std::uint8_t kGeneralised = 0x10;

bool is_known(std::uint8_t type) { return type <= 0x3 || (type >= 0x8 && type <= 0xb); }

bool is_response(PtpType type) {
  return type == PtpType::kPeerDelayResponse || type == PtpType::kDelayResponse ||
         type == PtpType::kPeerDelayFollowUp;
}

std::size_t length_of(PtpType type) {
  if (type == PtpType::kAnnounce) return kAnnounceBytes;
  return is_response(type) || type == PtpType::kPeerDelayRequest ? kLongBytes : kShortBytes;
}

std::size_t length_of(const PtpMessage& message) {
  return length_of(message.type) + (message.scaled_rate_offset ? kInformationBytes : 0);
}

// Whether behind a Follow_Up at `at` of so many bytes there is the information of 802.1AS.
bool has_information(const unsigned char* at, std::size_t bytes) {
  return bytes == kShortBytes + kInformationBytes &&
         std::equal(kInformationHead.begin(), kInformationHead.end(), at + kShortBytes);
}

std::uint8_t control_of(PtpType type) {
  switch (type) {
    case PtpType::kSync:
      return 0;
    case PtpType::kDelayRequest:
      return 1;
    case PtpType::kFollowUp:
      return 2;
    case PtpType::kDelayResponse:
      return 3;
    default:
      return 5;
  }
}

std::uint16_t flags_of(const PtpMessage& message) {
  if (message.is_simple) return kSimple;
  const bool is_two_step =
      message.type == PtpType::kSync || message.type == PtpType::kPeerDelayResponse;
  return is_two_step ? kTwoStep : 0;
}

void store_port(unsigned char* at, PeerId host) {
  boost::endian::store_big_u64(at, host);
  boost::endian::store_big_u16(at + 8, kPort);
}

}  // namespace

Nanoseconds correction_of(const PtpMessage& message) {
  return Nanoseconds(message.correction >> 16);
}

Bytes encode(const PtpMessage& message) {
  Bytes bytes(length_of(message));
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  at[0] = static_cast<unsigned char>(message.type);
  if (message.is_generalised) at[0] |= kGeneralised;
  at[1] = kPtpVersion;
  boost::endian::store_big_u16(at + 2, static_cast<std::uint16_t>(bytes.size()));
  at[4] = message.domain;
  boost::endian::store_big_u16(at + 6, flags_of(message));
  boost::endian::store_big_s64(at + 8, message.correction);
  store_port(at + 20, message.sender);
  boost::endian::store_big_u16(at + 30, message.sequence);
  at[32] = control_of(message.type);
  at[33] = kNoInterval;
  const std::int64_t seconds = floor_div(message.time_ns, kSecondNs);
  const std::int64_t rest_ns = message.time_ns - seconds * kSecondNs;
  boost::endian::store_big_s48(at + 34, seconds);
  boost::endian::store_big_u32(at + 40, static_cast<std::uint32_t>(rest_ns));
  if (is_response(message.type)) store_port(at + 44, message.asked_by);
  if (message.type == PtpType::kAnnounce) boost::endian::store_big_u64(at + 53, message.sender);
  if (message.scaled_rate_offset) {
    std::copy(kInformationHead.begin(), kInformationHead.end(), at + kShortBytes);
    boost::endian::store_big_s32(at + kShortBytes + kInformationHead.size(),
                                 *message.scaled_rate_offset);
  }
  return bytes;
}

std::optional<PtpMessage> decode_ptp_message(const Bytes& bytes) {
  if (bytes.size() < kShortBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  const std::uint8_t type = at[0] & 0x0f;
  if (!is_known(type) || (at[1] & 0x0f) != kPtpVersion) return std::nullopt;
  PtpMessage message;
  message.type = static_cast<PtpType>(type);
  if (message.type == PtpType::kFollowUp && has_information(at, bytes.size())) {
    message.scaled_rate_offset =
        boost::endian::load_big_s32(at + kShortBytes + kInformationHead.size());
  }
  if (bytes.size() != length_of(message)) return std::nullopt;
  if (boost::endian::load_big_u16(at + 2) != bytes.size()) return std::nullopt;
  message.is_generalised = (at[0] & 0xf0) == kGeneralised;
  message.domain = at[4];
  message.is_simple = (boost::endian::load_big_u16(at + 6) & kSimple) == kSimple;
  message.correction = boost::endian::load_big_s64(at + 8);
  message.sender = static_cast<PeerId>(boost::endian::load_big_u64(at + 20));
  message.sequence = boost::endian::load_big_u16(at + 30);
  const std::int64_t seconds = boost::endian::load_big_s48(at + 34);
  const std::uint32_t rest_ns = boost::endian::load_big_u32(at + 40);
  if (rest_ns >= kSecondNs || seconds >= kMostSeconds || seconds <= -kMostSeconds) {
    return std::nullopt;
  }
  message.time_ns = seconds * kSecondNs + rest_ns;
  if (is_response(message.type)) {
    message.asked_by = static_cast<PeerId>(boost::endian::load_big_u64(at + 44));
  }
  return message;
}

}  // namespace simbench

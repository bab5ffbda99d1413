#include "algorithms/host_sync/huygens/huygens_messages.h"

#include <boost/endian/conversion.hpp>
#include <cmath>

namespace simbench {
namespace {

using boost::endian::load_little_s64;
using boost::endian::load_little_u16;
using boost::endian::load_little_u32;
using boost::endian::store_little_s64;
using boost::endian::store_little_u16;
using boost::endian::store_little_u32;

constexpr std::uint16_t kHuygensMagic = 0x5948;
constexpr std::uint8_t kHuygensVersion = 1;
constexpr std::int64_t kMostRawNs = std::int64_t{1} << 61;
constexpr double kRateUnits = 1152921504606846976.0;  // 2^60
constexpr std::int64_t kMostRate = std::int64_t{1} << 53;

constexpr std::size_t kHeadBytes = 4;
constexpr std::size_t kProbeBytes = 29;
constexpr std::size_t kBoundsBytes = 22;
constexpr std::size_t kLineBytes = 32;
constexpr std::size_t kSteerBytes = 20;

bool is_time(std::int64_t ns) { return ns <= kMostRawNs && ns >= -kMostRawNs; }

// The bytes of a message of that kind (its place in HuygensMessage, from 1).
Bytes begin_bytes(std::size_t size, std::uint8_t kind) {
  Bytes bytes(size);
  auto* at = reinterpret_cast<unsigned char*>(bytes.data());
  store_little_u16(at, kHuygensMagic);
  at[2] = kHuygensVersion;
  at[3] = kind;
  return bytes;
}

unsigned char* body_of(Bytes& bytes) {
  return reinterpret_cast<unsigned char*>(bytes.data()) + kHeadBytes;
}
const unsigned char* body_of(const Bytes& bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data()) + kHeadBytes;
}

Bytes encode_one(const RosterMessage& message) {
  Bytes bytes = begin_bytes(kHeadBytes + 2 + 4 * message.peers.size(), 1);
  unsigned char* at = body_of(bytes);
  store_little_u16(at, static_cast<std::uint16_t>(message.peers.size()));
  for (std::size_t i = 0; i < message.peers.size(); ++i) {
    store_little_u32(at + 2 + 4 * i, message.peers[i]);
  }
  return bytes;
}

std::optional<HuygensMessage> decode_roster(const Bytes& bytes) {
  if (bytes.size() < kHeadBytes + 2) return std::nullopt;
  const unsigned char* at = body_of(bytes);
  const std::size_t count = load_little_u16(at);
  if (count > RosterMessage::kMostPeers) return std::nullopt;
  if (bytes.size() != kHeadBytes + 2 + 4 * count) return std::nullopt;
  RosterMessage message;
  message.peers.reserve(count);
  for (std::size_t i = 0; i < count; ++i) message.peers.push_back(load_little_u32(at + 2 + 4 * i));
  return message;
}

Bytes encode_one(const ProbeMessage& message) {
  Bytes bytes = begin_bytes(kProbeBytes, 2);
  unsigned char* at = body_of(bytes);
  store_little_u32(at, message.pair);
  at[4] = message.member;
  store_little_u32(at + 5, message.left_pair);
  store_little_s64(at + 9, message.left_ns[0]);
  store_little_s64(at + 17, message.left_ns[1]);
  return bytes;
}

std::optional<HuygensMessage> decode_probe(const Bytes& bytes) {
  if (bytes.size() != kProbeBytes) return std::nullopt;
  const unsigned char* at = body_of(bytes);
  const ProbeMessage message{.pair = load_little_u32(at),
                             .member = at[4],
                             .left_pair = load_little_u32(at + 5),
                             .left_ns = {load_little_s64(at + 9), load_little_s64(at + 17)}};
  if (message.pair == 0 || message.member > 1 || message.left_pair >= message.pair) {
    return std::nullopt;
  }
  if (!is_time(message.left_ns[0]) || !is_time(message.left_ns[1])) return std::nullopt;
  const bool has_times = message.left_ns != std::array<std::int64_t, 2>{};
  if (message.left_pair == 0 && has_times) return std::nullopt;
  return message;
}

Bytes encode_one(const BoundsMessage& message) {
  Bytes bytes = begin_bytes(kBoundsBytes + 16 * message.vertices.size(), 3);
  unsigned char* at = body_of(bytes);
  store_little_s64(at, message.begin_ns);
  store_little_s64(at + 8, message.end_ns);
  store_little_u16(at + 16, static_cast<std::uint16_t>(message.vertices.size()));
  for (std::size_t i = 0; i < message.vertices.size(); ++i) {
    store_little_s64(at + 18 + 16 * i, message.vertices[i].x);
    store_little_s64(at + 26 + 16 * i, message.vertices[i].y);
  }
  return bytes;
}

std::optional<HuygensMessage> decode_bounds(const Bytes& bytes) {
  if (bytes.size() < kBoundsBytes) return std::nullopt;
  const unsigned char* at = body_of(bytes);
  const std::size_t count = load_little_u16(at + 16);
  if (count > BoundsMessage::kMostVertices) return std::nullopt;
  if (bytes.size() != kBoundsBytes + 16 * count) return std::nullopt;
  BoundsMessage message{
      .begin_ns = load_little_s64(at), .end_ns = load_little_s64(at + 8), .vertices = {}};
  if (!is_time(message.begin_ns) || !is_time(message.end_ns)) return std::nullopt;
  message.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const LinePoint point{.x = load_little_s64(at + 18 + 16 * i),
                          .y = load_little_s64(at + 26 + 16 * i)};
    if (!is_time(point.x) || !is_time(point.y)) return std::nullopt;
    if (i > 0 && point.x <= message.vertices.back().x) return std::nullopt;
    message.vertices.push_back(point);
  }
  return message;
}

Bytes encode_one(const LineMessage& message) {
  Bytes bytes = begin_bytes(kLineBytes, 4);
  unsigned char* at = body_of(bytes);
  store_little_u32(at, message.b);
  store_little_s64(at + 4, message.line.x_ns);
  store_little_s64(at + 12, message.line.lead_ns);
  store_little_s64(at + 20, std::llround(message.line.rate * kRateUnits));
  return bytes;
}

std::optional<HuygensMessage> decode_line(const Bytes& bytes) {
  if (bytes.size() != kLineBytes) return std::nullopt;
  const unsigned char* at = body_of(bytes);
  const std::int64_t rate = load_little_s64(at + 20);
  // Below 1, and such that a double holds it.
  if (rate > kMostRate || rate < -kMostRate) return std::nullopt;
  const LineMessage message{.b = load_little_u32(at),
                            .line = {.x_ns = load_little_s64(at + 4),
                                     .lead_ns = load_little_s64(at + 12),
                                     .rate = static_cast<double>(rate) / kRateUnits}};
  if (!is_time(message.line.x_ns) || !is_time(message.line.lead_ns)) return std::nullopt;
  return message;
}

Bytes encode_one(const SteerMessage& message) {
  Bytes bytes = begin_bytes(kSteerBytes, 5);
  unsigned char* at = body_of(bytes);
  store_little_s64(at, message.raw_ns);
  store_little_s64(at + 8, nanoseconds_of(message.master));
  return bytes;
}

std::optional<HuygensMessage> decode_steer(const Bytes& bytes) {
  if (bytes.size() != kSteerBytes) return std::nullopt;
  const unsigned char* at = body_of(bytes);
  const SteerMessage message{.raw_ns = load_little_s64(at),
                             .master = HostTime(Nanoseconds(load_little_s64(at + 8)))};
  if (!is_time(message.raw_ns) || !is_time(nanoseconds_of(message.master))) return std::nullopt;
  return message;
}

}  // namespace

bool operator==(const BoundsMessage& a, const BoundsMessage& b) { return encode(a) == encode(b); }

Bytes encode(const HuygensMessage& message) {
  return std::visit([](const auto& one) { return encode_one(one); }, message);
}

std::optional<HuygensMessage> decode_huygens_message(const Bytes& bytes) {
  if (bytes.size() < kHeadBytes) return std::nullopt;
  const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
  if (load_little_u16(at) != kHuygensMagic || at[2] != kHuygensVersion) return std::nullopt;
  switch (at[3]) {
    case 1:
      return decode_roster(bytes);
    case 2:
      return decode_probe(bytes);
    case 3:
      return decode_bounds(bytes);
    case 4:
      return decode_line(bytes);
    case 5:
      return decode_steer(bytes);
    default:
      return std::nullopt;
  }
}

}  // namespace simbench

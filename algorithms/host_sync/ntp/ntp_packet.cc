#include "algorithms/host_sync/ntp/ntp_packet.h"

#include <boost/endian/conversion.hpp>

namespace simbench {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kSeconds1900To1970 = 2'208'988'800;

struct SplitTime {
  std::int64_t seconds;  // since 1900, whole, rounded down
  std::uint64_t ns;      // the rest, below a second
};

SplitTime split(HostTime time) {
  const std::int64_t total_ns = nanoseconds_of(time);
  std::int64_t seconds = total_ns / kSecondNs;
  std::int64_t rest_ns = total_ns % kSecondNs;
  if (rest_ns < 0) {
    rest_ns += kSecondNs;
    --seconds;
  }
  return {seconds + kSeconds1900To1970, static_cast<std::uint64_t>(rest_ns)};
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

}  // namespace simbench

// The 48-byte packet of NTP and SNTP, and its 64-bit timestamps.
//
// An NTP timestamp counts seconds and 2^-32 s fractions since 1900 and wraps every 136 years (an
// era; era 1 begins on 7 February 2036), so it names an instant only together with a time known to
// within 68 years: decoding takes one. Here a HostTime is nanoseconds since 1970; both conversions
// together are exact. A timestamp of zero means "not known" (RFC 4330 section 3).
//
// Source: RFC 5905 sections 6, 7.3 and 8; RFC 4330 sections 3 to 5 (the client's checks).
//
//   NtpPacket request;
//   request.transmit = to_ntp(t1);
//   Bytes bytes = encode(request);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_PACKET_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_PACKET_H_

#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"

namespace simbench {

struct NtpTimestamp {
  std::uint32_t seconds = 0;   // since 1900, modulo 2^32
  std::uint32_t fraction = 0;  // in 2^-32 s
  friend bool operator==(NtpTimestamp, NtpTimestamp) = default;
};

NtpTimestamp to_ntp(HostTime time);

// The instant nearest to `near` that `stamp` can mean.
HostTime from_ntp(NtpTimestamp stamp, HostTime near);

inline constexpr std::uint8_t kNtpModeClient = 3;
inline constexpr std::uint8_t kNtpModeServer = 4;
inline constexpr std::uint8_t kNtpLeapAlarm = 3;  // the server's clock is not synchronised

struct NtpPacket {
  std::uint8_t leap = 0;     // 0 to 3
  std::uint8_t version = 3;  // 1 to 4
  std::uint8_t mode = kNtpModeClient;
  std::uint8_t stratum = 0;
  std::int8_t poll = 0;               // log2 s
  std::int8_t precision = 0;          // log2 s
  std::uint32_t root_delay = 0;       // in 2^-16 s
  std::uint32_t root_dispersion = 0;  // in 2^-16 s
  std::uint32_t reference_id = 0;
  NtpTimestamp reference;
  NtpTimestamp origin;    // t1, echoed by the server
  NtpTimestamp receive;   // t2
  NtpTimestamp transmit;  // t1 in a request, t3 in a reply
  friend bool operator==(const NtpPacket&, const NtpPacket&) = default;
};

inline constexpr std::size_t kNtpPacketBytes = 48;

Bytes encode(const NtpPacket& packet);

// Nothing, unless it is 48 bytes (no extension, no authenticator) of a version from 1 to 4.
std::optional<NtpPacket> decode_ntp_packet(const Bytes& bytes);

// The server's time minus the client's, from the four stamps of an exchange (RFC 5905 section 8):
// ((t2 - t1) + (t3 - t4)) / 2, without overflow for any stamps within 146 years of each other.
Nanoseconds clock_offset(HostTime t1, HostTime t2, HostTime t3, HostTime t4);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_PACKET_H_

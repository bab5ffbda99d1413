// One NTP association: a client and its server exchange 48-byte packets, unicast or broadcast.
//
// Stamps: a packet carries the clock's reading from before it is sent. What else a host stamps:
//
//   NtpStamps      t1, of the client                   t2, t4, on arrival   departure, interleaved
//   kApplication   that reading                        the host's           the kernel's
//   kKernel        the kernel's where there is one     the host's           the kernel's
//   kProgram       that reading                        the program's        that reading
//   kCard          the card's                          the card's           the card's
//
// The host's are those of its receive calls; the program's are readings of the clock after them.
// The card's are converted to the system clock by a cross stamp taken right after them, as their
// clock runs by itself; the rates of the two clocks count as equal in between. The server cannot
// put a later stamp into t3, which has left by then: its sending time counts to one direction only,
// and half of it is an error.
//
// Interleaved mode does away with that error: a reply carries the stamp of when the reply before it
// left. The client asks by echoing, as the origin, the server's last receive stamp; the
// server answers so if it has that stamp, and as usual otherwise. It keeps the last five replies;
// after four requests without a reply the client asks as usual.
//
// Source: RFC 5905 sections 6 to 9; RFC 4330 sections 3 to 5 (the client's checks);
// docs/reference/host_sync.md section 2; draft-ietf-ntp-interleaved-modes section 2 (RFC 9769).
//
//   NtpAssociation association(host, master, NtpStamps::kApplication);
//   const std::optional<NtpMeasurement> reply = co_await association.exchange(from_ms(1000));
//   if (reply) use(reply->offset_s(), reply->delay_s());
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algorithms/host_sync/stamps.h"
#include "algorithms/ports/host.h"

namespace simbench {

// Seconds and fractions since 1900. It wraps every 136 years (an era; era 1 begins on 7 February
// 2036), so it names an instant only together with a time known to within 68 years. Here a HostTime
// is nanoseconds since 1970; both conversions together are exact. Zero means "not known".
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

// Nothing unless it is 48 bytes (no extension, no authenticator) of a version from 1 to 4.
std::optional<NtpPacket> decode_ntp_packet(const Bytes& bytes);

// The server's time minus the client's, from the four stamps of an exchange (RFC 5905 section 8):
// ((t2 - t1) + (t3 - t4)) / 2, without overflow for any stamps within 146 years of each other.
Nanoseconds clock_offset(HostTime t1, HostTime t2, HostTime t3, HostTime t4);

inline constexpr std::uint8_t kNtpModeBroadcast = 5;
inline constexpr std::uint8_t kNtpStratumMax = 15;

enum class NtpStamps : std::uint8_t { kApplication, kKernel, kProgram, kCard };

struct NtpMeasurement {
  HostTime t1{};
  HostTime t2{};
  HostTime t3{};
  HostTime t4{};
  SteadyTime received{};        // when t4 was taken
  bool is_interleaved = false;  // t3 is that of the reply before
  bool is_stamped = false;      // t1 is the kernel's or the card's
  bool is_translated = false;   // the stamps are a card's, put on the system clock
  double root_delay_s = 0;
  double root_dispersion_s = 0;

  double offset_s() const;  // server minus client
  double delay_s() const;   // round trip without the server's part; negative if a clock stepped
  Exchange exchange(PeerId server) const { return {server, t1, t2, t3, t4, is_translated}; }
};

// A broadcast has t3 and t4 only.
struct NtpBroadcast {
  HostTime t3{};
  HostTime t4{};
  SteadyTime received{};

  double offset_s() const;  // server minus client, less the delay of the packet
  Exchange exchange(PeerId server) const { return {.peer = server, .t3 = t3, .t4 = t4}; }
};

// The client's side. It ignores late, duplicated and foreign packets, as RFC 5905 section 8
// requires: a reply must echo the transmit stamp of the last request, come from a synchronised
// server of stratum 1 to 15 (so a kiss-o'-death is none) and carry its own transmit stamp.
class NtpAssociation {
 public:
  // The host must outlive the association. Requests are of `version`.
  NtpAssociation(Host& host, PeerId server, NtpStamps stamps, std::uint8_t version = 4);

  // Requests from now on ask for the interleaved mode. Its exchanges, which are complete only with
  // the next reply, are the caller's to report.
  void interleave() { interleaves_ = true; }

  // What the host lacks of the stamps asked for; empty if nothing is known (MessageStamps).
  std::string lacking() const { return departures_.lacking(); }

  // Sends a request and reports the exchange; nothing if no valid reply comes within `timeout`.
  Task<std::optional<NtpMeasurement>> exchange(Nanoseconds timeout);

  // Reports the next valid broadcast; nothing if none comes before `deadline`.
  Task<std::optional<NtpBroadcast>> next_broadcast(SteadyTime deadline);

 private:
  Host& host_;
  PeerId server_;
  NtpStamps stamps_;
  std::uint8_t version_;
  MessageChannel& channel_;
  MessageStamps departures_;
  bool interleaves_ = false;
  int unanswered_ = 0;
  NtpTimestamp server_received_;  // t2 of the last reply
  NtpTimestamp reply_received_;   // and its t4
};

struct NtpServing {
  double root_dispersion_s = 0;  // what the server announces as its clock's error bound, to 65535
  NtpStamps stamps = NtpStamps::kApplication;
  // Whether its own clock is right: until then it says that it is not. Null: it always is.
  std::shared_ptr<const bool> is_synchronised{};
};

// Serves these clients for ever, as a local reference of stratum 1, in the version of each request.
// One without a card for its stamps serves nobody.
Task<void> serve_ntp(Host& host, std::vector<PeerId> clients, NtpServing serving = {});

// Sends a broadcast (mode 5) to each client every `interval`, for ever.
Task<void> broadcast_ntp(Host& host, std::vector<PeerId> clients, Nanoseconds interval);

}  // namespace simbench

// One NTP association: a client and its server exchange 48-byte packets, unicast or broadcast.
//
// NtpAssociation is the client's side. exchange() sends a request (mode 3) and waits for the reply
// to it; next_broadcast() waits for a packet of mode 5. Whatever else arrives - late, duplicated or
// foreign replies, noise - is ignored, as RFC 5905 section 8 asks: a reply must echo the transmit
// stamp of the last request, come from a synchronised server of stratum 1 to 15 and carry its own
// transmit stamp; a kiss-o'-death (stratum 0) is none.
//
// serve_ntp() is the server's side for one client, endless: a local reference of stratum 1.
// broadcast_ntp() sends a packet of mode 5 to every client at an interval, endless.
//
// Stamps: a packet carries the reading of the clock before it is sent. With NtpStamps::kKernel the
// client replaces its own t1 by the kernel's transmit stamp where there is one; the reply that
// carries t3 has left by the time the server knows better, so the server's sending time then counts
// to one direction only, and half of it is an error.
//
// Source: RFC 5905 sections 7 to 9; docs/reference/host_sync.md section 2.
//
//   NtpAssociation association(host, master, NtpStamps::kApplication);
//   const std::optional<NtpMeasurement> reply = co_await association.exchange(from_ms(1000));
//   if (reply) use(reply->offset_s(), reply->delay_s());
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_ASSOCIATION_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_ASSOCIATION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/host_sync/ntp/ntp_packet.h"
#include "algorithms/ports/host.h"

namespace simbench {

inline constexpr std::uint8_t kNtpModeBroadcast = 5;
inline constexpr std::uint8_t kNtpStratumMax = 15;

enum class NtpStamps : std::uint8_t { kApplication, kKernel };

// What an exchange measured.
struct NtpMeasurement {
  HostTime t1{};
  HostTime t2{};
  HostTime t3{};
  HostTime t4{};
  SteadyTime received{};  // when t4 was taken
  double root_delay_s = 0;
  double root_dispersion_s = 0;

  double offset_s() const;  // server minus client
  double delay_s() const;   // round trip without the server's part; negative if a clock stepped
  Exchange exchange(PeerId server) const { return {server, t1, t2, t3, t4}; }
};

// What a broadcast tells: t3 and t4 only.
struct NtpBroadcast {
  HostTime t3{};
  HostTime t4{};
  SteadyTime received{};

  double offset_s() const;  // server minus client, less the delay of the packet
  Exchange exchange(PeerId server) const { return {server, {}, {}, t3, t4}; }
};

// Whether a client may use this packet as the reply to the request that carried `sent`.
bool is_valid_ntp_reply(const NtpPacket& reply, NtpTimestamp sent);

// Whether a client may use this packet as a broadcast.
bool is_valid_ntp_broadcast(const NtpPacket& packet);

class NtpAssociation {
 public:
  // The host must outlive the association. Requests are of `version`.
  NtpAssociation(Host& host, PeerId server, NtpStamps stamps, std::uint8_t version = 4);

  // One request and its reply, put on record; nothing if no valid reply comes within `timeout`.
  Task<std::optional<NtpMeasurement>> exchange(Nanoseconds timeout);

  // The next valid broadcast, put on record; nothing if none comes before `deadline`.
  Task<std::optional<NtpBroadcast>> next_broadcast(SteadyTime deadline);

 private:
  Host& host_;
  PeerId server_;
  NtpStamps stamps_;
  std::uint8_t version_;
  MessageChannel& channel_;
};

// Answers the requests of one client, for ever, in the version asked in. `root_dispersion_s`, up to
// 65535, is what the server claims its own clock may be off by.
Task<void> serve_ntp(Host& host, PeerId client, double root_dispersion_s = 0);

// Sends a broadcast to each client every `interval`, for ever.
Task<void> broadcast_ntp(Host& host, std::vector<PeerId> clients, Nanoseconds interval);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_ASSOCIATION_H_

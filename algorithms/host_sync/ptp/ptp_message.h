// The messages of the Precision Time Protocol, version 2, as bytes.
//
// Header of 34 bytes, big-endian, then the body (44 bytes in all for Sync, Follow_Up and Delay_Req,
// 64 for Announce, 54 for the others):
//
//   offset  size  field
//   0       1     transport specific (0; 1 of 802.1AS) in the high nibble, message type in the low
//                 one
//   1       1     version, 2
//   2       2     length in bytes
//   4       1     domain
//   6       2     flags; 0x0200 two-step; 0x2400 of SPTP (unicast, profile-specific 1)
//   8       8     correction, signed, in 2^-16 ns; transparent clocks add to it on the way
//   20      10    port identity of the sender: 8 bytes clock, 2 bytes port (1)
//   30      2     sequence number
//   32      1     control: 0 Sync, 1 Delay_Req, 2 Follow_Up, 3 Delay_Resp, 5 others
//   33      1     log2 of the interval; 0x7f: none
//   34      10    time: 48-bit seconds, 32-bit nanoseconds
//   44      10    Delay_Resp, Pdelay_Resp, Pdelay_Resp_Follow_Up: the requesting port
//   44      20    Announce: 0, but the grandmaster's clock at 53: the sender
//   44      32    Follow_Up of 802.1AS: the follow-up information TLV (type 3, length 28, 00-80-C2,
//                 subtype 1), at 54 cumulativeScaledRateOffset, else 0
//
// Seconds are taken as signed, so that a clock before its zero can be sent.
//
// Source: IEEE 1588-2008 clause 13; IEEE 802.1AS-2020, 11.4.4; facebook/time, ptp/sptp/README.md.
//
//   Bytes bytes = encode(PtpMessage{.type = PtpType::kSync, .sequence = 7});
#pragma once

#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"

namespace simbench {

enum class PtpType : std::uint8_t {
  kSync = 0x0,
  kDelayRequest = 0x1,
  kPeerDelayRequest = 0x2,
  kPeerDelayResponse = 0x3,
  kFollowUp = 0x8,
  kDelayResponse = 0x9,
  kPeerDelayFollowUp = 0xa,
  kAnnounce = 0xb,
};

struct PtpMessage {
  PtpType type = PtpType::kSync;
  PeerId sender = 0;
  std::uint16_t sequence = 0;
  std::int64_t correction = 0;  // 2^-16 ns
  std::int64_t time_ns = 0;     // within +-4e18
  PeerId asked_by = 0;          // in responses; else 0
  bool is_simple = false;       // of SPTP (sptp.h)
  std::uint8_t domain = 0;
  bool is_generalised = false;                       // of 802.1AS (gptp.h)
  std::optional<std::int32_t> scaled_rate_offset{};  // in its Follow_Up, 2^-41
  friend bool operator==(const PtpMessage&, const PtpMessage&) = default;
};

// The correction in nanoseconds, rounded down.
Nanoseconds correction_of(const PtpMessage& message);

Bytes encode(const PtpMessage& message);

// Nothing unless it is a PTPv2 message of one of these types. Other flags, control, interval and
// what an Announce tells of the grandmaster are ignored.
std::optional<PtpMessage> decode_ptp_message(const Bytes& bytes);

}  // namespace simbench

// The messages of simbench's own host_sync protocols as bytes: Algorithms 1 and 2, the two-way
// exchanges, common view.
//
// All are little-endian, and those of one protocol have one size, so that both directions cost the
// same on the wire. All begin alike:
//
//   offset  size  field
//   0       2     magic: 0x3259 ("Y2"), 0x5754 ("TW"), 0x5643 ("CV")
//   2       1     version, 1
//   3       1     kind
//
// Decoding gives nothing unless the bytes are exactly what encode() makes of some message. Times of
// TwoWayMessage and CommonViewMessage lie within +-4e18 ns, so that they can be subtracted.
//
//   Bytes bytes = encode(SessionMessage{.kind = MessageKind::kReady, .pass = 1});
//   std::optional<SessionMessage> message = decode_session_message(bytes);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"

namespace simbench {

enum class MessageKind : std::uint8_t {
  kReady = 1,      // master: a pass begins
  kStamp = 2,      // master: its clock, to measure the network delay with
  kRequest = 3,    // slave: send the next stamp (latency estimate "intended" only)
  kMeasured = 4,   // slave: t_d is known
  kSetTime = 5,    // master: T_m
  kSlaveTime = 6,  // slave: T_s
  kSuccess = 7,    // master: the session is over, the clock is accepted
  kGiveUp = 8,     // master: the session is over, the clock is not accepted
};

// A message of Algorithms 1 and 2. Pass and index are not in the paper: they let a peer tell a late
// or duplicated datagram from the one it waits for.
//
//   4       4     pass: the turn of Algorithm 1's loop, from 1
//   8       4     index: the number of a stamp or request within its pass, from 0; else 0
//   12      8     time: a host's clock in ns, for kStamp, kSetTime, kSlaveTime; else 0
struct SessionMessage {
  MessageKind kind = MessageKind::kReady;
  std::uint32_t pass = 0;
  std::uint32_t index = 0;
  HostTime time{};
  friend bool operator==(const SessionMessage&, const SessionMessage&) = default;
};

inline constexpr std::size_t kSessionMessageBytes = 20;

Bytes encode(const SessionMessage& message);
std::optional<SessionMessage> decode_session_message(const Bytes& bytes);

// A message of the two-way protocols.
//
//   4       4     index: the number of the exchange, from 1
//   8       8     arrived: reply: when the request reached the master, its clock, ns; else 0
//   16      4     replied_index: reply: the exchange whose reply left at `replied`; request: the
//                 one whose departure is wanted; 0: none
//   20      8     replied: reply: ns, else 0
//
// A reply that carries its own departure has replied_index == index; the clock was read before the
// send call. A measured departure comes with a later reply (interleaved mode, RFC 9769): the client
// requests that of the last reply it received.
struct TwoWayMessage {
  enum class Kind : std::uint8_t { kRequest = 1, kReply = 2 };
  Kind kind = Kind::kRequest;
  std::uint32_t index = 0;
  HostTime arrived{};
  std::uint32_t replied_index = 0;
  HostTime replied{};
  friend bool operator==(const TwoWayMessage&, const TwoWayMessage&) = default;
};

inline constexpr std::size_t kTwoWayMessageBytes = 28;

Bytes encode(const TwoWayMessage& message);
std::optional<TwoWayMessage> decode_two_way_message(const Bytes& bytes);

// A message of common view: a slave's request (kind 1), or the master's answer (2) with the time at
// which it saw a pulse.
//
//   4       4     index of the request, from 1
//   8       8     answer: the pulse, on the master's system clock, ns; else 0
//   16      8     answer: its standard deviation, ns; else 0
//   24      4     answer: 1 if there is a pulse; else 0
struct CommonViewMessage {
  struct Pulse {
    HostTime at{};
    std::int64_t sigma_ns = 0;  // not negative
    friend bool operator==(const Pulse&, const Pulse&) = default;
  };
  bool is_answer = false;
  std::uint32_t index = 0;
  std::optional<Pulse> pulse{};  // in answers
  friend bool operator==(const CommonViewMessage&, const CommonViewMessage&) = default;
};

Bytes encode(const CommonViewMessage& message);
std::optional<CommonViewMessage> decode_common_view_message(const Bytes& bytes);

}  // namespace simbench

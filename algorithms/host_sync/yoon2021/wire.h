// The messages of Algorithms 1 and 2 as bytes.
//
// Every message is 20 bytes, little-endian, whatever its kind, so that all of a session's messages
// cost the same on the wire:
//
//   offset  size  field
//   0       2     magic 0x3259 ("Y2")
//   2       1     version, 1
//   3       1     kind
//   4       4     pass: which turn of Algorithm 1's loop it belongs to, from 1
//   8       4     index: the number of a stamp or request within its pass, from 0; else 0
//   12      8     time: a host's clock in nanoseconds, for kStamp, kSetTime, kSlaveTime; else 0
//
// Pass and index are not in the paper. They let a peer tell a late or duplicated datagram from the
// one it waits for.
//
//   Bytes bytes = encode(SessionMessage{.kind = MessageKind::kReady, .pass = 1});
//   std::optional<SessionMessage> message = decode_session_message(bytes);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_YOON2021_WIRE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_YOON2021_WIRE_H_

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

struct SessionMessage {
  MessageKind kind = MessageKind::kReady;
  std::uint32_t pass = 0;
  std::uint32_t index = 0;
  HostTime time{};
  friend bool operator==(const SessionMessage&, const SessionMessage&) = default;
};

inline constexpr std::size_t kSessionMessageBytes = 20;

Bytes encode(const SessionMessage& message);

// Nothing, if the bytes are not exactly what encode() makes of some message.
std::optional<SessionMessage> decode_session_message(const Bytes& bytes);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_YOON2021_WIRE_H_

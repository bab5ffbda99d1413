// The messages of Huygens (huygens.h) as bytes, little-endian:
//
//   offset  size  field
//   0       2     magic: 0x5948 ("HY")
//   2       1     version, 1
//   3       1     kind
//
// Times are counts of nanoseconds within +-2^61; a lead is b's raw clock minus a's. Decoding gives
// nothing unless the bytes are exactly what encode() makes of some message.
//
//   Bytes bytes = encode(HuygensMessage(ProbeMessage{.pair = 3, .member = 1}));
//   std::optional<HuygensMessage> message = decode_huygens_message(bytes);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "algorithms/host_sync/huygens/coded_probes.h"
#include "algorithms/ports/host.h"
#include "laws/line_fit.h"

namespace simbench {

// Kind 1, master to slave: the hosts that it probes and that probe it.
//
//   4       2     their number, at most kMostPeers
//   6       4 n   their numbers
struct RosterMessage {
  static constexpr std::size_t kMostPeers = 256;
  std::vector<PeerId> peers;
  friend bool operator==(const RosterMessage&, const RosterMessage&) = default;
};

// Kind 2: a probe, and when those of the pair before it left.
//
//   4       4     number of the pair, from 1
//   8       1     0 or 1: which of the pair
//   9       4     number of the pair that left then; 0: none
//   13      16    when its two left, sender's raw clock, ns
struct ProbeMessage {
  std::uint32_t pair = 1;
  std::uint8_t member = 0;
  std::uint32_t left_pair = 0;
  std::array<std::int64_t, 2> left_ns{};
  friend bool operator==(const ProbeMessage&, const ProbeMessage&) = default;
};

// Kind 3, b to a: the lower hull of the pure probes from a to b during a span of a's raw clock.
//
//   4       16    begin and end of the span, ns
//   20      2     number of vertices, at most kMostVertices
//   22      16 n  x and lead of each, ns
struct BoundsMessage {
  static constexpr std::size_t kMostVertices = 64;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<LinePoint> vertices;
};
bool operator==(const BoundsMessage& a, const BoundsMessage& b);

// Kind 4, a to master: the line of its pair with b.
//
//   4       4     b
//   8       8     x on a's raw clock, ns
//   16      8     lead there, ns
//   24      8     rate, in 2^-60; at most 2^-7
struct LineMessage {
  PeerId b = 0;
  PairLine line;
  friend bool operator==(const LineMessage&, const LineMessage&) = default;
};

// Kind 5, master to slave: what the master's system clock read when the slave's raw clock read
// that.
//
//   4       8     slave's raw clock, ns
//   12      8     master's system clock, ns
struct SteerMessage {
  std::int64_t raw_ns = 0;
  HostTime master{};
  friend bool operator==(const SteerMessage&, const SteerMessage&) = default;
};

using HuygensMessage =
    std::variant<RosterMessage, ProbeMessage, BoundsMessage, LineMessage, SteerMessage>;

Bytes encode(const HuygensMessage& message);
std::optional<HuygensMessage> decode_huygens_message(const Bytes& bytes);

}  // namespace simbench

// The message of the two-way protocols as bytes.
//
// 28 bytes, little-endian, the same for request and reply, so that both directions cost the same
// time on the wire:
//
//   offset  size  field
//   0       2     magic 0x5754 ("TW")
//   2       1     version, 1
//   3       1     kind: 1 request, 2 reply
//   4       4     index: the number of the exchange, from 1
//   8       8     arrived: reply: when the request reached the master, its clock, ns; else 0
//   16      4     replied_index: reply: the exchange whose reply left at `replied`; request: the
//                 one whose departure is wanted; 0: none
//   20      8     replied: reply: ns, else 0
//
// A reply that carries its own departure has replied_index == index; it was read before the send
// call. A departure that was measured can only be told with a later reply (interleaved mode, RFC
// 9769): the client asks for that of the last reply it had.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_MESSAGE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_MESSAGE_H_

#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"

namespace simbench {

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

// Nothing, if the bytes are not what encode() makes of some message with times within +-4e18 ns.
std::optional<TwoWayMessage> decode_two_way_message(const Bytes& bytes);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_MESSAGE_H_

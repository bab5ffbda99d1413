// The messages in which the master tells its slaves when it saw a pulse.
//
// 28 bytes, little-endian, request and answer alike:
//
//   offset  size  field
//   0       2     magic 0x5643 ("CV")
//   2       1     version, 1
//   3       1     kind: 1 request, 2 answer
//   4       4     index of the request, from 1
//   8       8     answer: the pulse, on the master's system clock, ns; else 0
//   16      8     answer: its standard deviation, ns; else 0
//   24      4     answer: 1 if there is a pulse; else 0
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_COMMON_VIEW_MESSAGE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_COMMON_VIEW_MESSAGE_H_

#include <cstdint>
#include <optional>

#include "algorithms/ports/host.h"

namespace simbench {

struct CommonViewMessage {
  // What the master saw.
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

// Nothing, if the bytes are not what encode() makes of some message with times within +-4e18 ns.
std::optional<CommonViewMessage> decode_common_view_message(const Bytes& bytes);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PULSES_COMMON_VIEW_MESSAGE_H_

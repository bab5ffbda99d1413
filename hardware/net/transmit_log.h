// Which of the last messages of a socket left when: joins what was sent with the stamps that the
// kernel gives later. Pure; bounded to the last kKept messages.
#ifndef SIMBENCH_HARDWARE_NET_TRANSMIT_LOG_H_
#define SIMBENCH_HARDWARE_NET_TRANSMIT_LOG_H_

#include <cstdint>
#include <deque>
#include <optional>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

class TransmitLog {
 public:
  static constexpr std::size_t kKept = 1024;

  // Message `id` (they ascend) was handed to the kernel by a call that began at `called`; the
  // kernel names its stamp `number`.
  void sent(MessageId id, std::uint32_t number, MonotonicTime called);
  // Unknown numbers, second stamps, and stamps from before the call are left out.
  void stamped(std::uint32_t number, MonotonicTime at);
  // No stamp that is still missing will come.
  void forget_numbers();

  struct Entry {
    MessageId id = 0;
    std::optional<std::uint32_t> number;
    MonotonicTime called{};
    std::optional<MonotonicTime> left;
  };
  // Null if it was not sent, or long ago.
  const Entry* find(MessageId id) const;

 private:
  std::deque<Entry> entries_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_TRANSMIT_LOG_H_

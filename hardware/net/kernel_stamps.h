// When bytes came from the network and went to it, as the kernel says (SO_TIMESTAMPING), in
// CLOCK_MONOTONIC.
//
// The kernel stamps in CLOCK_REALTIME. A stamp is converted as soon as it is read, by reading that
// clock between two readings of the monotonic one; what the reading leaves open is under a
// microsecond on an idle machine. Should somebody step the system clock between stamp and reading,
// the converted stamp is wrong by the step: one that lies outside what is possible (after the
// reading, or more than kOldestStamp before it) is not used.
//
// Receive stamps: of the last segment (TCP) or the datagram (UDP) that a read took from. Where the
// kernel gives none, the time of the read.
// Transmit stamps: when the driver took the packet with the last byte of a send call. They come by
// the socket's error queue, named by the offset of that byte in the stream, or by the number of the
// datagram, both from the moment at which they were requested.
//
// Source: the kernel's Documentation/networking/timestamping.rst.
#ifndef SIMBENCH_HARDWARE_NET_KERNEL_STAMPS_H_
#define SIMBENCH_HARDWARE_NET_KERNEL_STAMPS_H_

#include <sys/socket.h>

#include <cstdint>
#include <ctime>
#include <deque>
#include <optional>
#include <span>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

inline constexpr Nanoseconds kOldestStamp = std::chrono::seconds(10);

// Asks for stamps of everything from now on. False if the kernel has none.
bool request_kernel_stamps(int socket);
// The same of what is received only: nothing has to take stamps from the error queue.
bool request_receive_stamps(int socket);
// Starts the numbers of datagrams at 0 again: a send that failed may or may not have taken one.
void restart_stamp_numbers(int socket);

struct ReceivedPiece {
  std::size_t bytes = 0;  // 0 without an error: the stream has ended
  int error = 0;          // errno
  bool truncated = false;
  bool stamped_by_kernel = false;
  MonotonicTime received{};
};

// Reads without waiting. `from` (for datagrams) may be null.
ReceivedPiece receive_stamped(int socket, std::span<std::byte> to, sockaddr_storage* from);

struct TransmitStamp {
  std::uint32_t number = 0;
  MonotonicTime at{};
};

// The next stamp from the error queue, if there is one. What else lies there is thrown away.
std::optional<TransmitStamp> next_transmit_stamp(int socket);

// A CLOCK_REALTIME instant of the recent past; nothing if it cannot be of the recent past.
std::optional<MonotonicTime> monotonic_of(const timespec& realtime);

// Which of the last messages of a socket left when: joins what was sent with the stamps that the
// kernel gives later. Pure; bounded to the last kKept messages.
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

#endif  // SIMBENCH_HARDWARE_NET_KERNEL_STAMPS_H_

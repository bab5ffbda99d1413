// The kernel's stamps of received and sent bytes (SO_TIMESTAMPING), in CLOCK_MONOTONIC.
//
// The kernel stamps in CLOCK_REALTIME. A stamp is converted as soon as it is read, by a paired
// reading of both clocks; the error is below a microsecond on an idle machine. If the system clock
// is stepped between stamp and reading, the converted stamp is wrong by the step. A stamp that is
// impossible (after the reading, or more than kOldestStamp before it) is discarded.
//
// Receive stamps: of the last segment (TCP) or the datagram (UDP) that a read took from; without
// one, the time of the read.
// Transmit stamps: when the driver took the packet with the last byte of a send call. They come by
// the socket's error queue, identified by the offset of that byte in the stream or by the number of
// the datagram, both counted from the request for stamps.
//
// Source: the kernel's Documentation/networking/timestamping.rst.
#pragma once

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
// Asks for stamps of received data only; nothing then fills the error queue.
bool request_receive_stamps(int socket);
// Starts the numbers of datagrams at 0 again: a send that failed may or may not have taken one.
void restart_stamp_numbers(int socket);

struct ReceivedPiece {
  std::size_t bytes = 0;  // 0 without an error: the stream has ended
  int error = 0;          // errno
  bool truncated = false;
  MonotonicTime received{};
};

// Reads without waiting. `from` (for datagrams) may be null.
ReceivedPiece receive_stamped(int socket, std::span<std::byte> to, sockaddr_storage* from);

struct TransmitStamp {
  std::uint32_t number = 0;
  MonotonicTime at{};
};

// The next stamp from the error queue, if there is one. Discards everything else in the queue.
std::optional<TransmitStamp> next_transmit_stamp(int socket);

// Converts a CLOCK_REALTIME instant; nothing if it is not of the recent past.
std::optional<MonotonicTime> monotonic_of(const timespec& realtime);

// When each of the last kKept messages of a socket left: joins sent messages with the stamps that
// the kernel reports later. Pure.
class TransmitLog {
 public:
  static constexpr std::size_t kKept = 1024;

  // Message `id` (they ascend) was handed to the kernel by a call that began at `called`; the
  // kernel names its stamp `number`.
  void sent(MessageId id, std::uint32_t number, MonotonicTime called);
  // Ignores unknown numbers, second stamps, and stamps from before the call.
  void stamped(std::uint32_t number, MonotonicTime at);
  // Missing stamps will not come any more.
  void forget_numbers();

  struct Entry {
    MessageId id = 0;
    std::optional<std::uint32_t> number;
    MonotonicTime called{};
    std::optional<MonotonicTime> left;
  };
  // Null if it was not sent, or is too old.
  const Entry* find(MessageId id) const;

 private:
  std::deque<Entry> entries_;
};

// Moves all stamps from the socket's error queue to the log. False if there was none.
bool take_transmit_stamps(int socket, TransmitLog& log);

}  // namespace simbench::hardware

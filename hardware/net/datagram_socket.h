// A UDP socket that stamps datagrams when they arrive and leave: by the kernel's stamps if there
// are any (hardware/net/kernel_stamps.h), else by the times of the calls.
//
// Neither sending nor receiving waits. One thread; its coroutines must keep it alive.
//
//   DatagramSocket socket(context);
//   socket.bind({address, 47110}, error);
//   socket.send(id, bytes, peer);
//   const std::optional<MonotonicTime> left = co_await socket.left(id, deadline);
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cstdint>
#include <optional>
#include <span>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"
#include "hardware/net/datagram.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/notice.h"

namespace simbench::hardware {

class DatagramSocket {
 public:
  using Endpoint = boost::asio::ip::udp::endpoint;

  struct Received {
    std::span<const std::byte> bytes;  // valid until the next receive()
    bool truncated = false;
    Endpoint from;
    MonotonicTime at{};
  };

  explicit DatagramSocket(boost::asio::io_context& context);

  // Opens it anew.
  void bind(const Endpoint& at, boost::system::error_code& error);
  // Ends all waits.
  void close();
  bool is_ip6() const;

  // Waits until there is something to read. False: closed.
  Task<bool> readable();
  // Nothing if no datagram is there.
  std::optional<Received> receive();

  // Ids ascend. A datagram that cannot be sent is lost.
  void send(MessageId id, const Bytes& datagram, const Endpoint& to);
  // When it left; nothing if it never did, is too old, or has no stamp by the deadline.
  Task<std::optional<MonotonicTime>> left(MessageId id, MonotonicTime deadline);

 private:
  bool take_stamps();
  void restart_numbers();

  boost::asio::io_context& context_;
  boost::asio::ip::udp::socket socket_;
  bool closed_ = false;
  std::array<std::byte, kMaxDatagramBytes + 1> buffer_{};
  bool stamps_ = false;            // the kernel stamps
  std::uint32_t next_number_ = 0;  // as the kernel counts
  TransmitLog transmitted_;
  Notice stamped_;
};

}  // namespace simbench::hardware

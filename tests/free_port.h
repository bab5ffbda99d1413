// A port of this machine that is free for TCP and UDP. It is below the ports that the kernel gives
// to outgoing connections, so that no such connection takes it before the test does.
#pragma once

#include <unistd.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <cstdint>
#include <stdexcept>

namespace simbench {

inline std::uint16_t free_port() {
  using boost::asio::ip::tcp;
  using boost::asio::ip::udp;
  constexpr std::uint16_t kFirst = 10'000;
  constexpr std::uint16_t kPorts = 20'000;
  const auto loopback = boost::asio::ip::address_v4::loopback();
  // Test programs that run at the same time begin far from each other (golden section: those of
  // the next eight process numbers are a thousand ports apart), since a port is free while a test
  // has killed its owner. No two threads get the same.
  static std::atomic<std::uint32_t> next = static_cast<std::uint32_t>(getpid() % kPorts) * 12'361;
  boost::asio::io_context context;
  for (int tries = 0; tries < 1000; ++tries) {
    const auto port = static_cast<std::uint16_t>(kFirst + next++ % kPorts);
    boost::system::error_code error;
    tcp::socket stream(context, tcp::v4());
    udp::socket datagram(context, udp::v4());
    stream.bind({loopback, port}, error);
    if (!error) datagram.bind({loopback, port}, error);
    if (!error) return port;
  }
  throw std::runtime_error("no free port");
}

}  // namespace simbench

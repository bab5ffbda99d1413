// A TCP and UDP port of this machine that was free a moment ago.
#ifndef SIMBENCH_TESTS_FREE_PORT_H_
#define SIMBENCH_TESTS_FREE_PORT_H_

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>

namespace simbench {

inline std::uint16_t free_port() {
  using boost::asio::ip::tcp;
  boost::asio::io_context context;
  const tcp::acceptor acceptor(context, {boost::asio::ip::address_v4::loopback(), 0});
  return acceptor.local_endpoint().port();
}

}  // namespace simbench

#endif  // SIMBENCH_TESTS_FREE_PORT_H_

// Addresses, and TCP connections by a deadline: resolves a name and tries each of its addresses.
//
//   auto socket = co_await connect_socket(context.get_executor(), "host3", 47110, deadline);
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

// "10.0.0.3:47110", "[::1]:47110".
std::string address_text(const std::string& address, std::uint16_t port);

// Throws StreamError(kUnreachable), also for an unknown name and at the deadline.
Task<boost::asio::ip::tcp::socket> connect_socket(boost::asio::any_io_executor executor,
                                                  std::string address, std::uint16_t port,
                                                  MonotonicTime deadline);

// Parses a numeric address, or resolves a name at once (blocking): for the start of a program.
// Throws StreamError(kUnreachable).
boost::asio::ip::address resolved_now(const std::string& address);

}  // namespace simbench::hardware

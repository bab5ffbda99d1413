// The addresses of a host, by its name.
//
// libc finds names as /etc/nsswitch.conf says: in files, by DNS, by mDNS (pi.local), in
// directories. It loads a library for each of these services. A program that is linked statically
// (SIMBENCH_PORTABLE) has a libc that may not load those of another libc: they crash it. It asks
// the system's own `getent` instead, in a process of its own, and finds the same names.
//
//   const auto addresses =
//       co_await addresses_of(context.get_executor(), "pi.local", deadline);
//
// Source: getent(1), nsswitch.conf(5).
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/address.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

// In the order in which they should be tried; a numeric address is itself. Throws
// StreamError(kUnreachable): an unknown name, no getent, or the deadline.
Task<std::vector<boost::asio::ip::address>> addresses_of(boost::asio::any_io_executor executor,
                                                         std::string name, MonotonicTime deadline);

// Asks getent, in any build; else as addresses_of().
Task<std::vector<boost::asio::ip::address>> addresses_by_getent(
    boost::asio::any_io_executor executor, std::string name, MonotonicTime deadline);

// What `getent ahosts` has printed: each address once. Lines of other kinds are passed over.
std::vector<boost::asio::ip::address> addresses_in(std::string_view printed);

}  // namespace simbench::hardware

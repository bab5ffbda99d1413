// Names of hosts: the world's hosts are "host0", "host1", ..., by IPv4 and IPv6; "localhost" and
// addresses are known too, and nothing else.
//
//   FoundHost found{};
//   if (find_host("host1", found)) use(found.addresses[0]);  // fd00::2
#pragma once

#include <cstddef>
#include <cstdint>

#include "shim/protocol.h"

namespace simbench::shim {

inline constexpr int kMostAddresses = 2;
inline constexpr std::size_t kMostName = 64;

// In the order in which Linux would try them (RFC 6724): IPv6 first.
struct FoundHost {
  int count = 0;
  IpAddress addresses[kMostAddresses]{};
  std::uint32_t scope = 0;  // "fe80::1%eth0"
  bool is_number = false;
  bool is_written_as_ipv6 = false;  // "::ffff:10.0.0.1" too
};

// False for a name that nobody has.
bool find_host(const char* name, FoundHost& found);
// An empty text for an address without a name.
void write_name_of(const IpAddress& address, char* name, std::size_t size);

}  // namespace simbench::shim

// Where a host's packets go, and under which address: its routing table, which is the same on all
// hosts (shim/addresses.h has their addresses).
//
//   127.0.0.0/8, ::1, and the host's own     to the host itself, at once
//   0.0.0.0, ::                              likewise, as the loopback
//   10.0.0.0/16, fd00::/64, fe80::/64        by the first card, to the host that has it
//   224.0.0.0/4, ff00::/8 and broadcasts     by the first card, to all that take part
// Other hosts, and those of a network that are none, are unreachable at once; a real one says that
// of its neighbours after three seconds. Further cards lead to no address.
//
// Source: ip(7), ipv6(7); RFC 6724; what Linux 6.1 says on a veth of the same addresses.
//
//   const Routes routes(0, 6);
//   const Route route = routes.to(shim::ipv4_address(0x0A000002, 123), {});  // to host 1
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "algorithms/ports/exchange.h"
#include "shim/protocol.h"
#include "sim/network/groups.h"

namespace simbench::sim {

// The host that has an address of a network; nothing for others.
std::optional<PeerId> owner_of(const shim::IpAddress& address, std::size_t hosts);

// A host's addresses in a network, and the one of such a kind.
enum class AddressKind : std::uint8_t { kIpv4, kUniqueLocal, kLinkLocal };
AddressKind kind_of(const shim::IpAddress& address);
shim::IpAddress address_of(PeerId host, AddressKind kind);

struct Route {
  int error = 0;  // an errno; nothing else is said then
  std::uint32_t interface = 0;
  shim::IpAddress source{};
  // To the host itself if it has none of these.
  std::optional<PeerId> peer{};
  std::optional<Groups::Id> group{};
};

// What a socket is bound to, as far as others of its port may stand in its way.
struct BoundTo {
  shim::IpAddress host{};
  bool only_ipv6 = false;
  std::uint32_t interface = 0;  // 0: any
};
// Whether both would take what comes for some address.
bool overlap(const BoundTo& one, const BoundTo& other);

// With the interface only where the address alone does not say it.
shim::Address scoped(shim::Address address, std::uint32_t interface);

class Routes {
 public:
  // What a socket asks for; 0: any.
  struct Wish {
    std::uint32_t interface = 0;        // SO_BINDTODEVICE
    std::uint32_t group_interface = 0;  // IP_MULTICAST_IF
    bool must_name_link = false;        // connect(), unlike a send
  };

  Routes(PeerId own, std::size_t hosts);

  Route to(const shim::Address& address, const Wish& wish) const;
  // Whether a socket that has these may be bound to the address, an errno or 0; sets its scope.
  int check_own(shim::Address& address, bool only_ipv6, std::uint32_t interface) const;
  // Whether the host itself has it: its own, 127.0.0.0/8 and ::1.
  bool is_own(const shim::IpAddress& address) const;
  // The network's broadcast, or that of all.
  static bool is_broadcast(const shim::IpAddress& address);
  // As the switches know it.
  static Groups::Id group_of(const shim::IpAddress& address);

  std::uint32_t ipv4() const { return ipv4_; }

 private:
  Route to_itself(const shim::Address& address, const Wish& wish) const;
  Route to_group(const shim::Address& address, const Wish& wish) const;
  Route to_neighbour(const shim::Address& address, const Wish& wish) const;

  std::uint32_t ipv4_;
  std::size_t hosts_;
  shim::IpAddress unique_local_;
  shim::IpAddress link_local_;
};

}  // namespace simbench::sim

#include "sim/programs/routes.h"

#include <cerrno>

#include "processes/placeholders.h"
#include "shim/addresses.h"

namespace simbench::sim {
namespace {

using shim::IpAddress;
using shim::kFirstCard;
using shim::kLoopbackInterface;

constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;
constexpr std::uint32_t kNetBroadcast = processes::kFirstAddress | ~processes::kNetmask;

std::uint32_t unique_local_number(PeerId host) { return host + 1; }

}  // namespace

std::optional<PeerId> owner_of(const IpAddress& address, std::size_t hosts) {
  const std::uint32_t number = shim::number_in(address);
  std::uint32_t host = number - processes::kFirstAddress;
  if (!shim::is_ipv4(address)) {
    if (address == shim::unique_local(number)) {
      host = number - unique_local_number(0);
    } else {
      // The first byte of the IPv4 address is the same for all hosts.
      const std::uint32_t ipv4 = (processes::kFirstAddress & 0xFF000000) | (number & 0x00FFFFFF);
      if (address != shim::link_local(ipv4)) return std::nullopt;
      host = ipv4 - processes::kFirstAddress;
    }
  }
  if (host >= hosts) return std::nullopt;
  return host;
}

AddressKind kind_of(const IpAddress& address) {
  if (shim::is_ipv4(address)) return AddressKind::kIpv4;
  return shim::is_link_local(address) ? AddressKind::kLinkLocal : AddressKind::kUniqueLocal;
}

IpAddress address_of(PeerId host, AddressKind kind) {
  const std::uint32_t ipv4 = processes::address_of(host);
  switch (kind) {
    case AddressKind::kUniqueLocal:
      return shim::unique_local(unique_local_number(host));
    case AddressKind::kLinkLocal:
      return shim::link_local(ipv4);
    case AddressKind::kIpv4:
      break;
  }
  return shim::mapped(ipv4);
}

Routes::Routes(PeerId own, std::size_t hosts)
    : ipv4_(processes::address_of(own)),
      hosts_(hosts),
      unique_local_(address_of(own, AddressKind::kUniqueLocal)),
      link_local_(address_of(own, AddressKind::kLinkLocal)) {}

bool overlap(const BoundTo& one, const BoundTo& other) {
  if (one.interface != 0 && other.interface != 0 && one.interface != other.interface) return false;
  if (shim::is_small(other.host, 0)) return !(other.only_ipv6 && shim::is_ipv4(one.host));
  if (shim::is_small(one.host, 0)) return !(one.only_ipv6 && shim::is_ipv4(other.host));
  if (one.host == other.host) return true;
  const bool are_ipv4 = shim::is_ipv4(one.host) && shim::is_ipv4(other.host);
  return are_ipv4 && (shim::is_any(one.host) || shim::is_any(other.host));
}

shim::Address scoped(shim::Address address, std::uint32_t interface) {
  address.scope = shim::needs_scope(address.host) ? interface : 0;
  return address;
}

int Routes::check_own(shim::Address& address, bool only_ipv6, std::uint32_t interface) const {
  if (only_ipv6 && shim::is_ipv4(address.host)) return EINVAL;
  const std::uint32_t stated = address.scope != 0 ? address.scope : interface;
  address = scoped(address, stated);
  if (shim::needs_scope(address.host)) {
    if (stated == 0) return EINVAL;
    if (stated != kFirstCard) return EADDRNOTAVAIL;
  }
  return shim::is_any(address.host) || is_own(address.host) ? 0 : EADDRNOTAVAIL;
}

bool Routes::is_own(const IpAddress& address) const {
  return shim::is_loopback(address) || address == shim::mapped(ipv4_) || address == unique_local_ ||
         address == link_local_;
}

bool Routes::is_broadcast(const IpAddress& address) {
  const std::uint32_t number = shim::number_in(address);
  return shim::is_ipv4(address) && (number == kBroadcast || number == kNetBroadcast);
}

Groups::Id Routes::group_of(const IpAddress& address) {
  if (is_broadcast(address)) return Groups::kEveryone;
  const std::uint32_t number = shim::number_in(address);
  // RFC 2464, section 7.
  return shim::is_ipv4(address) ? number : Groups::of_ethernet(0x333300000000 | number);
}

Route Routes::to(const shim::Address& address, const Wish& wish) const {
  if (shim::is_any(address.host) || is_own(address.host)) return to_itself(address, wish);
  if (shim::is_group(address.host) || is_broadcast(address.host)) return to_group(address, wish);
  return to_neighbour(address, wish);
}

Route Routes::to_itself(const shim::Address& address, const Wish& wish) const {
  const bool is_ipv4 = shim::is_ipv4(address.host);
  const bool is_loopback = shim::is_any(address.host) || shim::is_loopback(address.host);
  if (shim::is_link_local(address.host)) {
    const std::uint32_t scope = address.scope != 0 ? address.scope : wish.interface;
    if (scope == 0 && wish.must_name_link) return {.error = EINVAL};
    if (scope != 0 && scope != kFirstCard) return {.error = ENETUNREACH};
  }
  if (!is_loopback) return {.interface = kFirstCard, .source = address.host};
  if (wish.interface > kLoopbackInterface) return {.error = ENETUNREACH};
  return {.interface = kLoopbackInterface,
          .source = is_ipv4 ? shim::mapped(0x7F000001) : shim::kLoopback6};
}

Route Routes::to_group(const shim::Address& address, const Wish& wish) const {
  const bool is_ipv4 = shim::is_ipv4(address.host);
  std::uint32_t interface = address.scope != 0 ? address.scope : wish.interface;
  if (interface == 0) interface = wish.group_interface;
  if (interface == 0 && wish.must_name_link && shim::needs_scope(address.host)) {
    return {.error = EINVAL};
  }
  if (interface != 0 && interface != kFirstCard) return {.error = ENETUNREACH};
  Route route{
      .interface = kFirstCard, .source = shim::mapped(ipv4_), .group = group_of(address.host)};
  if (!is_ipv4) route.source = shim::needs_scope(address.host) ? link_local_ : unique_local_;
  return route;
}

Route Routes::to_neighbour(const shim::Address& address, const Wish& wish) const {
  const std::uint32_t scope =
      shim::is_link_local(address.host) && address.scope != 0 ? address.scope : wish.interface;
  if (scope == 0 && wish.must_name_link && shim::is_link_local(address.host)) {
    return {.error = EINVAL};
  }
  const std::optional<PeerId> peer = owner_of(address.host, hosts_);
  if (!peer || (scope != 0 && scope != kFirstCard)) return {.error = ENETUNREACH};
  Route route{.interface = kFirstCard, .source = shim::mapped(ipv4_), .peer = peer};
  if (shim::is_link_local(address.host)) {
    route.source = link_local_;
  } else if (!shim::is_ipv4(address.host)) {
    route.source = unique_local_;
  }
  return route;
}

}  // namespace simbench::sim

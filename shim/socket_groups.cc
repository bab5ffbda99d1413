#include "shim/socket_groups.h"

#include <arpa/inet.h>
#include <errno.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <string.h>

#include "shim/interfaces.h"
#include "shim/sockets.h"
#include "shim/streams.h"

namespace simbench::shim {
namespace {

// The interface that a request about a group of IPv4 names, by number or by address; 0: any.
bool find_group_interface(int number, std::uint32_t host, std::uint32_t& found) {
  InterfaceFacts facts{};
  found = static_cast<std::uint32_t>(number);
  if (number != 0) return find_interface(found, facts);
  if (host == INADDR_ANY) return true;
  found = kFirstCard;
  return host == identity().address;
}

int join(int fd, bool joins, const Address& group, int kind = 0) {
  return static_cast<int>(
      ask({.call = Call::kJoin, .fd = fd, .a = joins ? 1 : 0, .b = kind}, {&group, sizeof group}));
}

// struct ip_mreq has the first two members.
bool read_membership(const void* value, socklen_t size, ip_mreqn& membership) {
  membership = {};
  if (size < sizeof(ip_mreq)) return false;
  memcpy(&membership, value, size < sizeof membership ? sizeof(ip_mreq) : sizeof membership);
  return true;
}

int set_membership(int fd, bool joins, const void* value, socklen_t size) {
  ip_mreqn membership{};
  if (!read_membership(value, size, membership)) return refuse(EINVAL);
  std::uint32_t interface = 0;
  if (!find_group_interface(membership.imr_ifindex, ntohl(membership.imr_address.s_addr),
                            interface)) {
    return refuse(ENODEV);
  }
  Address group = ipv4_address(ntohl(membership.imr_multiaddr.s_addr), 0);
  group.scope = interface;
  return join(fd, joins, group);
}

int set_membership6(int fd, bool joins, const void* value, socklen_t size) {
  ipv6_mreq wanted{};
  if (size < sizeof wanted) return refuse(EINVAL);
  memcpy(&wanted, value, sizeof wanted);
  const Address group{.host = address_at(&wanted.ipv6mr_multiaddr),
                      .scope = wanted.ipv6mr_interface,
                      .family = AF_INET6};
  if (is_ipv4(group.host)) return refuse(EINVAL);  // another option's
  return join(fd, joins, group);
}

// By MCAST_JOIN_GROUP, which names its family.
int set_membership_of_either(int fd, bool joins, const void* value, socklen_t size) {
  group_req wanted{};
  if (size < sizeof wanted) return refuse(EINVAL);
  memcpy(&wanted, value, sizeof wanted);
  Address group{};
  if (wanted.gr_group.ss_family == AF_INET6) {
    sockaddr_in6 name{};
    memcpy(&name, &wanted.gr_group, sizeof name);
    group = {.host = address_at(&name.sin6_addr), .family = AF_INET6};
  } else if (wanted.gr_group.ss_family == AF_INET) {
    sockaddr_in name{};
    memcpy(&name, &wanted.gr_group, sizeof name);
    group = ipv4_address(ntohl(name.sin_addr.s_addr), 0);
  } else {
    return refuse(EINVAL);
  }
  group.scope = wanted.gr_interface;
  return join(fd, joins, group);
}

int set_packet_membership(int fd, bool joins, const void* value, socklen_t size) {
  packet_mreq wanted{};
  if (size < sizeof wanted) return refuse(EINVAL);
  memcpy(&wanted, value, sizeof wanted);
  PacketAddress host{};
  memcpy(host.card, wanted.mr_address, sizeof host.card);
  const Address group{.host = packed(host),
                      .scope = static_cast<std::uint32_t>(wanted.mr_ifindex),
                      .family = AF_PACKET};
  return join(fd, joins, group, wanted.mr_type);
}

int keep_group_interface(int fd, bool is_v6, std::uint32_t interface) {
  SocketState& state = state_of(fd);
  (is_v6 ? state.group_interface6 : state.group_interface) = interface;
  if (!is_socket(fd)) return 0;
  const auto option = static_cast<std::int64_t>(SocketOption::kGroupInterface);
  const Request request{
      .call = Call::kSetOption, .fd = fd, .a = option | (is_v6 ? kOfIpv6 : 0), .b = interface};
  return ask(request) < 0 ? -1 : 0;
}

// Where multicasts leave.
int set_group_interface(int fd, const void* value, socklen_t size) {
  if (is_stream(fd)) return refuse(EINVAL);
  ip_mreqn wanted{};
  if (size >= sizeof(ip_mreq)) {
    read_membership(value, size, wanted);
  } else if (size >= sizeof(in_addr)) {
    memcpy(&wanted.imr_address, value, sizeof(in_addr));
  } else {
    return refuse(EINVAL);
  }
  std::uint32_t interface = 0;
  const bool is_known =
      find_group_interface(wanted.imr_ifindex, ntohl(wanted.imr_address.s_addr), interface);
  return is_known ? keep_group_interface(fd, false, interface) : refuse(EADDRNOTAVAIL);
}

int set_group_interface6(int fd, const void* value, socklen_t size) {
  if (is_stream(fd)) return refuse(ENOPROTOOPT);
  std::uint32_t interface = 0;
  if (size < sizeof interface) return refuse(EINVAL);
  memcpy(&interface, value, sizeof interface);
  InterfaceFacts facts{};
  if (interface != 0 && !find_interface(interface, facts)) return refuse(ENODEV);
  return keep_group_interface(fd, true, interface);
}

int set_ipv4_option(int fd, int option, const void* value, socklen_t size) {
  switch (option) {
    case IP_ADD_MEMBERSHIP:
    case IP_DROP_MEMBERSHIP:
      return set_membership(fd, option == IP_ADD_MEMBERSHIP, value, size);
    case MCAST_JOIN_GROUP:
    case MCAST_LEAVE_GROUP:
      return set_membership_of_either(fd, option == MCAST_JOIN_GROUP, value, size);
    case IP_MULTICAST_IF:
      return set_group_interface(fd, value, size);
    default:
      return kIsNone;
  }
}

int set_ipv6_option(int fd, int option, const void* value, socklen_t size) {
  switch (option) {
    case IPV6_JOIN_GROUP:
    case IPV6_LEAVE_GROUP:
      return set_membership6(fd, option == IPV6_JOIN_GROUP, value, size);
    case MCAST_JOIN_GROUP:
    case MCAST_LEAVE_GROUP:
      return set_membership_of_either(fd, option == MCAST_JOIN_GROUP, value, size);
    case IPV6_MULTICAST_IF:
      return set_group_interface6(fd, value, size);
    default:
      return kIsNone;
  }
}

}  // namespace

int set_group_option(int fd, int level, int option, const void* value, socklen_t size) {
  const int family = family_of(fd);
  if (family == AF_PACKET) {
    const bool joins = option == PACKET_ADD_MEMBERSHIP;
    if (level != SOL_PACKET || (!joins && option != PACKET_DROP_MEMBERSHIP)) return kIsNone;
    return set_packet_membership(fd, joins, value, size);
  }
  if (level == IPPROTO_IP) return set_ipv4_option(fd, option, value, size);
  if (level == IPPROTO_IPV6 && family == AF_INET6) return set_ipv6_option(fd, option, value, size);
  return kIsNone;
}

int get_group_option(int fd, int level, int option, void* value, socklen_t* size) {
  std::uint32_t found = 0;
  if (level == IPPROTO_IPV6 && option == IPV6_MULTICAST_IF && family_of(fd) == AF_INET6) {
    found = state_of(fd).group_interface6;
  } else if (level == IPPROTO_IP && option == IP_MULTICAST_IF && family_of(fd) != AF_PACKET) {
    found = state_of(fd).group_interface == kFirstCard ? htonl(identity().address) : 0;
  } else {
    return kIsNone;
  }
  if (*size > sizeof found) *size = sizeof found;
  memcpy(value, &found, *size);
  return 0;
}

}  // namespace simbench::shim

// Addresses as programs write them, and as they read them: of IPv4, IPv6 and packet sockets.
#include <errno.h>
#include <linux/if_arp.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <string.h>

#include "shim/sockets.h"
#include "shim/streams.h"

namespace simbench::shim {
namespace {

// What IPv6 had before it had scopes; enough for a name (RFC 2133).
constexpr socklen_t kLeastName6 = offsetof(sockaddr_in6, sin6_scope_id);

bool fail(int error) {
  errno = error;
  return false;
}

bool read_ipv4(const sockaddr* name, socklen_t size, Address& address) {
  sockaddr_in in{};
  if (size < sizeof in) return fail(EINVAL);
  memcpy(&in, name, sizeof in);
  address = ipv4_address(ntohl(in.sin_addr.s_addr), ntohs(in.sin_port));
  return true;
}

bool read_ipv6(const sockaddr* name, socklen_t size, Address& address) {
  sockaddr_in6 in{};
  if (size < kLeastName6) return fail(EINVAL);
  memcpy(&in, name, size < sizeof in ? size : sizeof in);
  address = {.host = address_at(&in.sin6_addr),
             .scope = in.sin6_scope_id,
             .port = ntohs(in.sin6_port),
             .family = AF_INET6};
  if (!needs_scope(address.host)) address.scope = 0;
  return true;
}

bool read_packet(const sockaddr* name, socklen_t size, Address& address) {
  sockaddr_ll link{};
  if (size < sizeof link) return fail(EINVAL);
  memcpy(&link, name, sizeof link);
  if (link.sll_family != AF_PACKET) return fail(EINVAL);
  PacketAddress host{};
  memcpy(host.card, link.sll_addr, sizeof host.card);
  address = {.host = packed(host),
             .scope = static_cast<std::uint32_t>(link.sll_ifindex),
             .port = ntohs(link.sll_protocol),
             .family = AF_PACKET};
  return true;
}

// A socket of IPv4; no family is that of 0.0.0.0, or of any address that is sent to.
bool read_for_ipv4(NameUse use, const sockaddr* name, socklen_t size, Address& address) {
  if (size < sizeof(sockaddr_in)) return fail(EINVAL);
  if (name->sa_family != AF_INET && name->sa_family != AF_UNSPEC) return fail(EAFNOSUPPORT);
  if (!read_ipv4(name, size, address)) return false;
  const bool is_odd = name->sa_family == AF_UNSPEC && use == NameUse::kBind;
  return is_odd && !is_any(address.host) ? fail(EAFNOSUPPORT) : true;
}

// One of IPv6, which may name hosts of IPv4 too but for connections and binding.
bool read_for_ipv6(bool is_stream, NameUse use, const sockaddr* name, socklen_t size,
                   Address& address) {
  const bool may_be_ipv4 = use != NameUse::kBind && !is_stream;
  if (may_be_ipv4 && name->sa_family == AF_INET) return read_ipv4(name, size, address);
  if (size < kLeastName6) return fail(EINVAL);
  if (name->sa_family != AF_INET6) {
    if (use == NameUse::kSend && name->sa_family == AF_UNSPEC) return true;  // to the peer
    return fail(use == NameUse::kSend ? EINVAL : EAFNOSUPPORT);
  }
  return read_ipv6(name, size, address);
}

}  // namespace

bool read_address(int fd, NameUse use, const sockaddr* name, socklen_t size, Address& address) {
  address = {};
  if (name == nullptr || size < sizeof name->sa_family) return fail(EINVAL);
  const int family = family_of(fd);
  if (family == AF_PACKET) return read_packet(name, size, address);
  if (use == NameUse::kConnect && name->sa_family == AF_UNSPEC) return true;
  if (family == AF_INET) return read_for_ipv4(use, name, size, address);
  return read_for_ipv6(is_stream(fd), use, name, size, address);
}

namespace {

template <class Name>
void write_name(const Name& name, sockaddr* to, socklen_t* size) {
  memcpy(to, &name, *size < sizeof name ? *size : sizeof name);
  *size = sizeof name;
}

sockaddr_ll packet_name(const Address& address) {
  const PacketAddress host = unpacked(address.host);
  sockaddr_ll link{};
  link.sll_family = AF_PACKET;
  link.sll_protocol = htons(address.port);
  link.sll_ifindex = static_cast<int>(address.scope);
  if (address.scope != 0) {
    link.sll_hatype = address.scope == kLoopbackInterface ? ARPHRD_LOOPBACK : ARPHRD_ETHER;
    link.sll_halen = sizeof host.card;
  }
  link.sll_pkttype = host.kind;
  memcpy(link.sll_addr, host.card, sizeof host.card);
  return link;
}

}  // namespace

void write_address(const Address& address, sockaddr* name, socklen_t* size) {
  if (name == nullptr || size == nullptr) return;
  if (address.family == AF_INET) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_port = htons(address.port);
    in.sin_addr.s_addr = htonl(number_in(address.host));
    write_name(in, name, size);
  } else if (address.family == AF_INET6) {
    sockaddr_in6 in{};
    in.sin6_family = AF_INET6;
    in.sin6_port = htons(address.port);
    memcpy(&in.sin6_addr, &address.host, sizeof in.sin6_addr);
    in.sin6_scope_id = address.scope;
    write_name(in, name, size);
  } else if (address.family == AF_PACKET) {
    write_name(packet_name(address), name, size);
  } else {
    *size = 0;
  }
}

}  // namespace simbench::shim

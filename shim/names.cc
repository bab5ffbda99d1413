// getaddrinfo() and getnameinfo(). Services are numbers, or one of those below.
#include "shim/names.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "shim/addresses.h"
#include "shim/interfaces.h"
#include "shim/link.h"

namespace simbench::shim {
namespace {

void write_own_name(char* name, std::size_t size) {
  snprintf(name, size, "host%u", identity().address - identity().first_address);
}

// "fe80::1%eth0" or "%2"; only addresses that need it have one.
bool find_scope(const char* text, const IpAddress& address, std::uint32_t& scope) {
  if (!needs_scope(address)) return false;
  InterfaceFacts facts{};
  if (find_interface(text, facts)) {
    scope = facts.index;
    return true;
  }
  char* end = nullptr;
  const unsigned long number = strtoul(text, &end, 10);
  scope = static_cast<std::uint32_t>(number);
  return *text >= '0' && *text <= '9' && *end == '\0' && number <= UINT32_MAX;
}

bool find_number(const char* name, FoundHost& found) {
  in_addr parsed{};
  found.is_number = true;
  found.count = 1;
  if (inet_aton(name, &parsed) != 0) {
    found.addresses[0] = mapped(ntohl(parsed.s_addr));
    return true;
  }
  char text[INET6_ADDRSTRLEN + 1] = "";
  const char* percent = strchr(name, '%');
  const std::size_t size =
      percent != nullptr ? static_cast<std::size_t>(percent - name) : strlen(name);
  if (size >= sizeof text) return false;
  memcpy(text, name, size);
  if (inet_pton(AF_INET6, text, found.addresses[0].bytes) != 1) return false;
  found.is_written_as_ipv6 = true;
  return percent == nullptr || find_scope(percent + 1, found.addresses[0], found.scope);
}

}  // namespace

bool find_host(const char* name, FoundHost& found) {
  found = {};
  if (find_number(name, found)) return true;
  found = {};
  if (strcmp(name, "localhost") == 0) {
    found.count = 2;
    found.addresses[0] = kLoopback6;
    found.addresses[1] = mapped(INADDR_LOOPBACK);
    return true;
  }
  if (strcmp(name, "ip6-localhost") == 0 || strcmp(name, "ip6-loopback") == 0) {
    found.count = 1;
    found.addresses[0] = kLoopback6;
    return true;
  }
  if (strncmp(name, "host", 4) != 0 || name[4] < '0' || name[4] > '9') return false;
  char* end = nullptr;
  const unsigned long number = strtoul(name + 4, &end, 10);
  if (*end != '\0' || number >= identity().hosts) return false;
  const auto host = static_cast<std::uint32_t>(number);
  found.count = 2;
  found.addresses[0] = unique_local(host + 1);
  found.addresses[1] = mapped(identity().first_address + host);
  return true;
}

void write_name_of(const IpAddress& address, char* name, std::size_t size) {
  const std::uint32_t number = number_in(address);
  name[0] = '\0';
  if (address == mapped(INADDR_LOOPBACK) || address == kLoopback6) {
    snprintf(name, size, "localhost");
  } else if (is_ipv4(address) && number - identity().first_address < identity().hosts) {
    snprintf(name, size, "host%u", number - identity().first_address);
  } else if (address == unique_local(number) && number - 1 < identity().hosts) {
    snprintf(name, size, "host%u", number - 1);
  }
}

namespace {

// Kinds of sockets, as bits.
constexpr unsigned kOfTcp = 1;
constexpr unsigned kOfUdp = 2;
constexpr unsigned kOfNone = 4;  // a protocol without ports

struct Service {
  const char* name;
  std::uint16_t port;
  unsigned kinds;
};
constexpr Service kServices[] = {{"ntp", 123, kOfUdp},
                                 {"ptp-event", 319, kOfTcp | kOfUdp},
                                 {"ptp-general", 320, kOfTcp | kOfUdp},
                                 {"echo", 7, kOfTcp | kOfUdp},
                                 {"time", 37, kOfTcp | kOfUdp}};

// `kinds`: the sockets that have it.
bool find_service(const char* name, bool must_be_a_number, std::uint16_t& port, unsigned& kinds) {
  char* end = nullptr;
  const unsigned long number = strtoul(name, &end, 10);
  kinds = kOfTcp | kOfUdp | kOfNone;
  if (*name != '\0' && *end == '\0' && number <= UINT16_MAX) {
    port = static_cast<std::uint16_t>(number);
    return true;
  }
  for (const Service& each : kServices) {
    if (must_be_a_number || strcmp(name, each.name) != 0) continue;
    port = each.port;
    kinds = each.kinds;
    return true;
  }
  return false;
}

struct SocketKind {
  unsigned bit;
  int type;
  int protocol;
};
constexpr SocketKind kKinds[] = {
    {kOfTcp, SOCK_STREAM, IPPROTO_TCP}, {kOfUdp, SOCK_DGRAM, IPPROTO_UDP}, {kOfNone, SOCK_RAW, 0}};
constexpr int kMostEntries = kMostAddresses * 3;

// What getaddrinfo() gave out.
struct Found {
  bool is_taken;
  int count;
  addrinfo entries[kMostEntries];
  sockaddr_in6 names[kMostEntries];  // or as much of one of IPv4
  char name[kMostName];
};
Found found_hosts[64];

Found* take_found() {
  for (Found& each : found_hosts) {
    if (!each.is_taken) return &each;
  }
  return nullptr;
}

void add_entry(Found& place, const SocketKind& kind, bool is_v6, const IpAddress& address,
               std::uint32_t scope, std::uint16_t port) {
  sockaddr_in6& name = place.names[place.count];
  addrinfo& entry = place.entries[place.count];
  if (is_v6) {
    name.sin6_family = AF_INET6;
    name.sin6_port = htons(port);
    memcpy(&name.sin6_addr, &address, sizeof name.sin6_addr);
    name.sin6_scope_id = scope;
  } else {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_port = htons(port);
    in.sin_addr.s_addr = htonl(number_in(address));
    memcpy(&name, &in, sizeof in);
  }
  entry.ai_family = is_v6 ? AF_INET6 : AF_INET;
  entry.ai_socktype = kind.type;
  entry.ai_protocol = kind.protocol;
  entry.ai_addrlen = is_v6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
  entry.ai_addr = reinterpret_cast<sockaddr*>(&name);
  if (place.count > 0) place.entries[place.count - 1].ai_next = &entry;
  ++place.count;
}

bool is_wanted(const SocketKind& kind, const addrinfo& wanted, unsigned kinds) {
  if ((kinds & kind.bit) == 0) return false;
  if (wanted.ai_socktype != 0 && wanted.ai_socktype != kind.type) return false;
  return wanted.ai_protocol == 0 || kind.protocol == 0 || wanted.ai_protocol == kind.protocol;
}

// An address as one of the family that is asked for; false if it is none.
bool as_family(const addrinfo& wanted, const FoundHost& host, const IpAddress& address,
               bool& is_v6) {
  const bool is_dotted = is_ipv4(address);
  is_v6 = !is_dotted || host.is_written_as_ipv6;
  if (wanted.ai_family == AF_UNSPEC) return true;
  if (wanted.ai_family == AF_INET) return is_dotted;
  is_v6 = true;
  if (!is_dotted) return true;
  if ((wanted.ai_flags & AI_V4MAPPED) == 0) return false;
  return host.count == 1 || (wanted.ai_flags & AI_ALL) != 0;
}

FoundHost unnamed(bool is_passive) {
  FoundHost found{.count = 2};
  found.addresses[0] = is_passive ? mapped(INADDR_ANY) : kLoopback6;
  found.addresses[1] = is_passive ? IpAddress{} : mapped(INADDR_LOOPBACK);
  return found;
}

// 0 or an error of getaddrinfo().
int resolve(const char* node, const addrinfo& wanted, FoundHost& host) {
  if (node == nullptr) {
    host = unnamed((wanted.ai_flags & AI_PASSIVE) != 0);
    return 0;
  }
  if (!find_host(node, host)) return EAI_NONAME;
  if (!host.is_number && (wanted.ai_flags & AI_NUMERICHOST) != 0) return EAI_NONAME;
  return 0;
}

int fill_found(Found& place, const char* node, const addrinfo& wanted, const FoundHost& host,
               std::uint16_t port, unsigned kinds) {
  place = {};
  bool has_address = false;
  for (int i = 0; i < host.count; ++i) {
    bool is_v6 = false;
    if (!as_family(wanted, host, host.addresses[i], is_v6)) continue;
    has_address = true;
    for (const SocketKind& kind : kKinds) {
      if (!is_wanted(kind, wanted, kinds)) continue;
      SocketKind chosen = kind;
      if (kind.protocol == 0) chosen.protocol = wanted.ai_protocol;
      add_entry(place, chosen, is_v6, host.addresses[i], host.scope, port);
    }
  }
  if (!has_address) return host.is_number ? EAI_ADDRFAMILY : EAI_NONAME;
  if (place.count == 0) return wanted.ai_socktype == SOCK_STREAM ? EAI_SERVICE : EAI_SOCKTYPE;
  if ((wanted.ai_flags & AI_CANONNAME) != 0 && node != nullptr) {
    snprintf(place.name, sizeof place.name, "%s", node);
    place.entries[0].ai_canonname = place.name;
  }
  place.is_taken = true;
  return 0;
}

}  // namespace

SIMBENCH_CALL int getaddrinfo(const char* node, const char* service, const addrinfo* hints,
                              addrinfo** result) {
  if (!is_simulated()) return SIMBENCH_REAL(getaddrinfo)(node, service, hints, result);
  const addrinfo wanted = hints != nullptr ? *hints : addrinfo{};
  if (node == nullptr && service == nullptr) return EAI_NONAME;
  const bool is_known =
      wanted.ai_family == AF_UNSPEC || wanted.ai_family == AF_INET || wanted.ai_family == AF_INET6;
  if (!is_known) return EAI_FAMILY;
  std::uint16_t port = 0;
  unsigned kinds = kOfTcp | kOfUdp | kOfNone;
  const bool is_number = (wanted.ai_flags & AI_NUMERICSERV) != 0;
  if (service != nullptr && !find_service(service, is_number, port, kinds)) {
    return is_number ? EAI_NONAME : EAI_SERVICE;
  }
  FoundHost host{};
  const int error = resolve(node, wanted, host);
  if (error != 0) return error;
  Found* place = take_found();
  if (place == nullptr) return EAI_MEMORY;
  const int obstacle = fill_found(*place, node, wanted, host, port, kinds);
  if (obstacle != 0) return obstacle;
  *result = &place->entries[0];
  return 0;
}

SIMBENCH_CALL void freeaddrinfo(addrinfo* list) {
  if (!is_simulated()) return SIMBENCH_REAL(freeaddrinfo)(list);
  // A program may have cut the list, and frees each part.
  for (Found& each : found_hosts) {
    if (list >= each.entries && list < each.entries + kMostEntries) each.is_taken = false;
  }
}

namespace {

// As numbers, with the interface where there is one: "fe80::1%eth0".
void write_number(const Address& address, char* text, std::size_t size) {
  if (address.family == AF_INET) {
    const in_addr dotted{.s_addr = htonl(number_in(address.host))};
    inet_ntop(AF_INET, &dotted, text, static_cast<socklen_t>(size));
    return;
  }
  inet_ntop(AF_INET6, &address.host, text, static_cast<socklen_t>(size));
  if (address.scope == 0) return;
  const std::size_t length = strlen(text);
  InterfaceFacts facts{};
  if (needs_scope(address.host) && find_interface(address.scope, facts)) {
    snprintf(text + length, size - length, "%%%s", facts.name);
  } else {
    snprintf(text + length, size - length, "%%%u", address.scope);
  }
}

bool read_name(const sockaddr* name, socklen_t size, Address& address) {
  if (size < sizeof name->sa_family) return false;
  if (name->sa_family == AF_INET && size >= sizeof(sockaddr_in)) {
    sockaddr_in in{};
    memcpy(&in, name, sizeof in);
    address = ipv4_address(ntohl(in.sin_addr.s_addr), ntohs(in.sin_port));
    return true;
  }
  sockaddr_in6 in{};
  if (name->sa_family != AF_INET6 || size < sizeof in) return false;
  memcpy(&in, name, sizeof in);
  address = {.host = address_at(&in.sin6_addr),
             .scope = in.sin6_scope_id,
             .port = ntohs(in.sin6_port),
             .family = AF_INET6};
  return true;
}

}  // namespace

SIMBENCH_CALL int getnameinfo(const sockaddr* name, socklen_t size, char* host, socklen_t host_size,
                              char* service, socklen_t service_size, int flags) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(getnameinfo)(name, size, host, host_size, service, service_size, flags);
  }
  Address address{};
  if (!read_name(name, size, address)) return EAI_FAMILY;
  char text[INET6_ADDRSTRLEN + 16] = "";
  const bool is_mapped = address.family == AF_INET6 && is_ipv4(address.host);
  const bool wants_name = (flags & NI_NUMERICHOST) == 0 && !is_mapped;
  if (wants_name) write_name_of(address.host, text, sizeof text);
  if (text[0] == '\0') {
    if ((flags & NI_NAMEREQD) != 0) return EAI_NONAME;
    write_number(address, text, sizeof text);
  }
  if (host != nullptr && host_size > 0) {
    if (strlen(text) >= host_size) return EAI_OVERFLOW;
    snprintf(host, host_size, "%s", text);
  }
  if (service != nullptr && service_size > 0) {
    const int length = snprintf(service, service_size, "%u", unsigned{address.port});
    if (length >= static_cast<int>(service_size)) return EAI_OVERFLOW;
  }
  return 0;
}

SIMBENCH_CALL int gethostname(char* name, std::size_t size) {
  if (!is_simulated()) return SIMBENCH_REAL(gethostname)(name, size);
  char own[kMostName];
  write_own_name(own, sizeof own);
  if (size <= strlen(own)) return refuse(ENAMETOOLONG);
  memcpy(name, own, strlen(own) + 1);
  return 0;
}

SIMBENCH_CALL int uname(utsname* system) {
  const int result = SIMBENCH_REAL(uname)(system);
  if (result == 0 && is_simulated()) write_own_name(system->nodename, sizeof system->nodename);
  return result;
}

}  // namespace simbench::shim

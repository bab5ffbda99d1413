// Names of hosts: the world's hosts are "host0", "host1", ...; "localhost" and dotted quads are
// known too, and nothing else. Services are numbers, or one of those below.
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

#include "shim/link.h"

namespace simbench::shim {
namespace {

constexpr int kMostName = 32;

void write_own_name(char* name, std::size_t size) {
  snprintf(name, size, "host%u", identity().address - identity().first_address);
}

// Host byte order; false for a name that nobody has.
bool find_host(const char* name, std::uint32_t& address) {
  in_addr parsed{};
  if (inet_aton(name, &parsed) != 0) {
    address = ntohl(parsed.s_addr);
    return true;
  }
  if (strcmp(name, "localhost") == 0) {
    address = INADDR_LOOPBACK;
    return true;
  }
  if (strncmp(name, "host", 4) != 0 || name[4] < '0' || name[4] > '9') return false;
  char* end = nullptr;
  const unsigned long number = strtoul(name + 4, &end, 10);
  if (*end != '\0' || number >= identity().hosts) return false;
  address = identity().first_address + static_cast<std::uint32_t>(number);
  return true;
}

void write_name_of(std::uint32_t address, char* name, std::size_t size) {
  const std::uint32_t number = address - identity().first_address;
  if (address == INADDR_LOOPBACK) {
    snprintf(name, size, "localhost");
  } else if (number < identity().hosts) {
    snprintf(name, size, "host%u", number);
  } else {
    name[0] = '\0';
  }
}

struct Service {
  const char* name;
  std::uint16_t port;
};
constexpr Service kServices[] = {
    {"ntp", 123}, {"ptp-event", 319}, {"ptp-general", 320}, {"echo", 7}, {"time", 37}};

bool find_service(const char* name, bool must_be_a_number, std::uint16_t& port) {
  char* end = nullptr;
  const unsigned long number = strtoul(name, &end, 10);
  if (*name != '\0' && *end == '\0' && number <= UINT16_MAX) {
    port = static_cast<std::uint16_t>(number);
    return true;
  }
  for (const Service& each : kServices) {
    if (must_be_a_number || strcmp(name, each.name) != 0) continue;
    port = each.port;
    return true;
  }
  return false;
}

// What getaddrinfo() gave out; one for each kind of socket.
constexpr int kKinds = 2;
struct Found {
  bool is_taken;
  addrinfo entries[kKinds];
  sockaddr_in addresses[kKinds];
  char name[kMostName];
};
Found found_hosts[64];

Found* take_found() {
  for (Found& each : found_hosts) {
    if (!each.is_taken) return &each;
  }
  return nullptr;
}

addrinfo* fill_found(Found& place, const addrinfo& hints, std::uint32_t address,
                     std::uint16_t port) {
  constexpr int kTypes[kKinds] = {SOCK_STREAM, SOCK_DGRAM};
  constexpr int kProtocols[kKinds] = {IPPROTO_TCP, IPPROTO_UDP};
  place = {};
  place.is_taken = true;
  write_name_of(address, place.name, sizeof place.name);
  addrinfo* first = nullptr;
  for (int i = kKinds - 1; i >= 0; --i) {
    if (hints.ai_socktype != 0 && hints.ai_socktype != kTypes[i]) continue;
    sockaddr_in& name = place.addresses[i];
    name.sin_family = AF_INET;
    name.sin_port = htons(port);
    name.sin_addr.s_addr = htonl(address);
    addrinfo& entry = place.entries[i];
    entry.ai_family = AF_INET;
    entry.ai_socktype = kTypes[i];
    entry.ai_protocol = kProtocols[i];
    entry.ai_addrlen = sizeof name;
    entry.ai_addr = reinterpret_cast<sockaddr*>(&name);
    entry.ai_next = first;
    first = &entry;
  }
  if (first != nullptr && (hints.ai_flags & AI_CANONNAME) != 0) first->ai_canonname = place.name;
  return first;
}

}  // namespace

SIMBENCH_CALL int getaddrinfo(const char* node, const char* service, const addrinfo* hints,
                              addrinfo** result) {
  if (!is_simulated()) return SIMBENCH_REAL(getaddrinfo)(node, service, hints, result);
  const addrinfo wanted = hints != nullptr ? *hints : addrinfo{};
  if (node == nullptr && service == nullptr) return EAI_NONAME;
  if (wanted.ai_family != AF_UNSPEC && wanted.ai_family != AF_INET) {
    return wanted.ai_family == AF_INET6 ? EAI_NONAME : EAI_FAMILY;
  }
  std::uint32_t address = (wanted.ai_flags & AI_PASSIVE) != 0 ? INADDR_ANY : INADDR_LOOPBACK;
  in_addr parsed{};
  const bool needs_number = (wanted.ai_flags & AI_NUMERICHOST) != 0;
  if (node != nullptr && needs_number && inet_aton(node, &parsed) == 0) return EAI_NONAME;
  if (node != nullptr && !find_host(node, address)) return EAI_NONAME;
  std::uint16_t port = 0;
  const bool is_number = (wanted.ai_flags & AI_NUMERICSERV) != 0;
  if (service != nullptr && !find_service(service, is_number, port)) {
    return is_number ? EAI_NONAME : EAI_SERVICE;
  }
  Found* place = take_found();
  if (place == nullptr) return EAI_MEMORY;
  *result = fill_found(*place, wanted, address, port);
  if (*result != nullptr) return 0;
  place->is_taken = false;
  return EAI_SOCKTYPE;
}

SIMBENCH_CALL void freeaddrinfo(addrinfo* list) {
  if (!is_simulated()) return SIMBENCH_REAL(freeaddrinfo)(list);
  for (Found& each : found_hosts) {
    if (list == &each.entries[0] || list == &each.entries[1]) each.is_taken = false;
  }
}

SIMBENCH_CALL int getnameinfo(const sockaddr* name, socklen_t size, char* host, socklen_t host_size,
                              char* service, socklen_t service_size, int flags) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(getnameinfo)(name, size, host, host_size, service, service_size, flags);
  }
  if (size < sizeof(sockaddr_in) || name->sa_family != AF_INET) return EAI_FAMILY;
  sockaddr_in in{};
  memcpy(&in, name, sizeof in);
  char text[INET_ADDRSTRLEN] = "";
  if ((flags & NI_NUMERICHOST) == 0) write_name_of(ntohl(in.sin_addr.s_addr), text, sizeof text);
  if (text[0] == '\0') {
    if ((flags & NI_NAMEREQD) != 0) return EAI_NONAME;
    inet_ntop(AF_INET, &in.sin_addr, text, sizeof text);
  }
  if (host != nullptr && host_size > 0) {
    if (strlen(text) >= host_size) return EAI_OVERFLOW;
    snprintf(host, host_size, "%s", text);
  }
  if (service != nullptr && service_size > 0) {
    const int length = snprintf(service, service_size, "%u", unsigned{ntohs(in.sin_port)});
    if (length >= static_cast<int>(service_size)) return EAI_OVERFLOW;
  }
  return 0;
}

SIMBENCH_CALL hostent* gethostbyname(const char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(gethostbyname)(name);
  static hostent entry;
  static char known_name[kMostName];
  static char* no_aliases[] = {nullptr};
  static in_addr found;
  static char* addresses[] = {reinterpret_cast<char*>(&found), nullptr};
  std::uint32_t address = 0;
  if (!find_host(name, address)) {
    h_errno = HOST_NOT_FOUND;
    return nullptr;
  }
  found.s_addr = htonl(address);
  snprintf(known_name, sizeof known_name, "%s", name);
  entry = {.h_name = known_name,
           .h_aliases = no_aliases,
           .h_addrtype = AF_INET,
           .h_length = sizeof found,
           .h_addr_list = addresses};
  return &entry;
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

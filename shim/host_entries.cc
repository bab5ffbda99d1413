// gethostbyname(), gethostbyaddr() and their kin: the older way to shim/names.h.
#include <arpa/inet.h>
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>

#include "shim/addresses.h"
#include "shim/link.h"
#include "shim/names.h"

namespace simbench::shim {
namespace {

// What an entry points to.
struct EntryRoom {
  char* no_aliases[1];
  char* addresses[2];
  unsigned char address[sizeof(IpAddress)];
  char name[kMostName];
};

void fill_host(hostent& entry, EntryRoom& room, const char* name, const IpAddress& address,
               int family) {
  room = {};
  snprintf(room.name, sizeof room.name, "%s", name);
  const std::uint32_t dotted = htonl(number_in(address));
  if (family == AF_INET) {
    memcpy(room.address, &dotted, sizeof dotted);
  } else {
    memcpy(room.address, &address, sizeof address);
  }
  room.addresses[0] = reinterpret_cast<char*>(room.address);
  entry = {.h_name = room.name,
           .h_aliases = room.no_aliases,
           .h_addrtype = family,
           .h_length = family == AF_INET ? int{sizeof dotted} : int{sizeof address},
           .h_addr_list = room.addresses};
}

// 0 or an error of h_errno.
int look_up(const char* name, int family, IpAddress& address) {
  FoundHost found{};
  if (!find_host(name, found)) return HOST_NOT_FOUND;
  for (int i = 0; i < found.count; ++i) {
    if (is_ipv4(found.addresses[i]) != (family == AF_INET)) continue;
    address = found.addresses[i];
    return 0;
  }
  return NO_DATA;
}

// False if it is no address of this family.
bool read_address_of(const void* bytes, socklen_t size, int family, IpAddress& address) {
  std::uint32_t dotted = 0;
  if (family == AF_INET && size == sizeof dotted) {
    memcpy(&dotted, bytes, sizeof dotted);
    address = mapped(ntohl(dotted));
    return true;
  }
  if (family != AF_INET6 || size != sizeof address) return false;
  memcpy(&address, bytes, sizeof address);
  return true;
}

// The room that a program gives, as far as it is enough and aligned; null if it is not.
EntryRoom* room_in(char* room, std::size_t size) {
  const std::size_t odd = reinterpret_cast<std::uintptr_t>(room) % alignof(EntryRoom);
  const std::size_t skipped = odd == 0 ? 0 : alignof(EntryRoom) - odd;
  if (size < skipped + sizeof(EntryRoom)) return nullptr;
  return reinterpret_cast<EntryRoom*>(room + skipped);
}

hostent own_entry;
EntryRoom own_room;

}  // namespace

SIMBENCH_CALL hostent* gethostbyname2(const char* name, int family) {
  if (!is_simulated()) return SIMBENCH_REAL(gethostbyname2)(name, family);
  IpAddress address{};
  h_errno = look_up(name, family, address);
  if (h_errno != 0) return nullptr;
  fill_host(own_entry, own_room, name, address, family);
  return &own_entry;
}

SIMBENCH_CALL hostent* gethostbyname(const char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(gethostbyname)(name);
  return gethostbyname2(name, AF_INET);
}

SIMBENCH_CALL hostent* gethostbyaddr(const void* bytes, socklen_t size, int family) {
  if (!is_simulated()) return SIMBENCH_REAL(gethostbyaddr)(bytes, size, family);
  IpAddress address{};
  char name[kMostName] = "";
  if (read_address_of(bytes, size, family, address)) write_name_of(address, name, sizeof name);
  h_errno = name[0] == '\0' ? HOST_NOT_FOUND : 0;
  if (h_errno != 0) return nullptr;
  fill_host(own_entry, own_room, name, address, family);
  return &own_entry;
}

SIMBENCH_CALL int gethostbyname2_r(const char* name, int family, hostent* entry, char* bytes,
                                   std::size_t size, hostent** result, int* error) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(gethostbyname2_r)(name, family, entry, bytes, size, result, error);
  }
  *result = nullptr;
  EntryRoom* room = room_in(bytes, size);
  if (room == nullptr) return ERANGE;
  IpAddress address{};
  *error = look_up(name, family, address);
  if (*error != 0) return 0;
  fill_host(*entry, *room, name, address, family);
  *result = entry;
  return 0;
}

SIMBENCH_CALL int gethostbyname_r(const char* name, hostent* entry, char* bytes, std::size_t size,
                                  hostent** result, int* error) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(gethostbyname_r)(name, entry, bytes, size, result, error);
  }
  return gethostbyname2_r(name, AF_INET, entry, bytes, size, result, error);
}

SIMBENCH_CALL int gethostbyaddr_r(const void* address_bytes, socklen_t address_size, int family,
                                  hostent* entry, char* bytes, std::size_t size, hostent** result,
                                  int* error) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(gethostbyaddr_r)(address_bytes, address_size, family, entry, bytes, size,
                                          result, error);
  }
  *result = nullptr;
  EntryRoom* room = room_in(bytes, size);
  if (room == nullptr) return ERANGE;
  IpAddress address{};
  char name[kMostName] = "";
  if (read_address_of(address_bytes, address_size, family, address)) {
    write_name_of(address, name, sizeof name);
  }
  *error = name[0] == '\0' ? HOST_NOT_FOUND : 0;
  if (*error != 0) return 0;
  fill_host(*entry, *room, name, address, family);
  *result = entry;
  return 0;
}

}  // namespace simbench::shim

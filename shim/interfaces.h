// The host's network interfaces: the loopback, and one Ethernet card.
//
//  - lo: index 1, 127.0.0.1/8
//  - eth0: index 2, the host's address in its /16, MTU 1500, a locally administered MAC address
//    that has it too
//
//   char name[IFNAMSIZ];
//   const InterfaceFacts card = interface_at(1);
//   snprintf(name, sizeof name, "%s", card.name);
#pragma once

#include <cstdint>

namespace simbench::shim {

inline constexpr int kInterfaces = 2;
inline constexpr int kMacBytes = 6;

// Addresses in host byte order.
struct InterfaceFacts {
  unsigned index;
  const char* name;
  std::uint32_t address;
  std::uint32_t netmask;
  std::uint32_t broadcast;
  unsigned flags;
  unsigned short hardware;  // ARPHRD_...
  int mtu;
  unsigned char mac[kMacBytes];
};

// `place` is 0 or 1.
InterfaceFacts interface_at(int place);
// False with errno ENODEV.
bool find_interface(const char* name, InterfaceFacts& found);
bool find_interface(unsigned index, InterfaceFacts& found);

// Requests of ioctl() about interfaces, which any socket takes.
bool is_about_interfaces(unsigned long what);
int interface_ioctl(unsigned long what, void* argument);

}  // namespace simbench::shim

// The host's network interfaces: the loopback, and its Ethernet cards.
//
//  - lo: index 1, 127.0.0.1/8, ::1
//  - eth0: index 2, the host's addresses (shim/addresses.h), MTU 1500
//  - eth1 and on, where the world has further cables (sim/programs/cables.h): no addresses; without
//    a carrier where the cable leads nowhere
//
//   const InterfaceFacts card = interface_at(1);
//   const bool is_up = card.has_carrier;
#pragma once

#include <cstdint>

#include "shim/protocol.h"

namespace simbench::shim {

inline constexpr int kMostInterfaces = 17;
inline constexpr int kMacBytes = 6;
inline constexpr int kMostAddresses6 = 2;  // of an interface

// IPv4 in host byte order; 0: none.
struct InterfaceFacts {
  unsigned index = 0;
  char name[16] = {};
  std::uint32_t address = 0;
  std::uint32_t netmask = 0;
  std::uint32_t broadcast = 0;
  unsigned flags = 0;
  unsigned short hardware = 0;  // ARPHRD_...
  int mtu = 0;
  unsigned char mac[kMacBytes] = {};
  bool has_carrier = false;
  int addresses6 = 0;  // how many
  IpAddress address6[kMostAddresses6]{};
  int prefix6 = 0;
};

int interfaces();
// `place` from 0 to interfaces() - 1.
InterfaceFacts interface_at(int place);
// False with errno ENODEV.
bool find_interface(const char* name, InterfaceFacts& found);
bool find_interface(unsigned index, InterfaceFacts& found);
// Whether the host has it, beside the loopback's.
bool is_own_address(const IpAddress& address);

// Requests of ioctl() about interfaces, which any socket takes.
bool is_about_interfaces(unsigned long what);
int interface_ioctl(unsigned long what, void* argument);

}  // namespace simbench::shim

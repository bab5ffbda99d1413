// The addresses of the simulated network. Host i, from 0 on, has
//
//  - 10.0.0.1 + i in 10.0.0.0/16,
//  - fd00::1 + i in fd00::/64,
//  - a link-local address, fe80:: and what EUI-64 makes of its first card's address,
//  - 02:00 and its IPv4 address as the Ethernet address of its first card; of further ones the
//    second byte is the card's number.
//
// Source: RFC 4291, sections 2.5.1, 2.5.5.2 and appendix A; RFC 4193; RFC 6890.
//
//   const Address server = ipv4_address(0x0A000001, 123);
//   const bool is_dotted = is_ipv4(server.host);
#pragma once

#include <sys/socket.h>

#include <cstdint>

#include "shim/protocol.h"

namespace simbench::shim {

// Numbers of interfaces: the loopback, and the first card.
inline constexpr std::uint32_t kLoopbackInterface = 1;
inline constexpr std::uint32_t kFirstCard = 2;
// A link carries 1500 bytes of an IP packet, heads included; the loopback more than any.
inline constexpr std::uint32_t kLinkMtu = 1'500;
inline constexpr std::uint32_t kLoopbackMtu = 65'536;

// Host byte order, as all numbers here.
constexpr IpAddress mapped(std::uint32_t ipv4) {
  return {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, static_cast<std::uint8_t>(ipv4 >> 24),
           static_cast<std::uint8_t>(ipv4 >> 16), static_cast<std::uint8_t>(ipv4 >> 8),
           static_cast<std::uint8_t>(ipv4)}};
}

// From where its sixteen bytes are.
inline IpAddress address_at(const void* bytes) {
  IpAddress address{};
  __builtin_memcpy(address.bytes, bytes, sizeof address.bytes);
  return address;
}

// As the host of a packet socket's address.
constexpr IpAddress packed(const PacketAddress& address) {
  return __builtin_bit_cast(IpAddress, address);
}
constexpr PacketAddress unpacked(const IpAddress& host) {
  return __builtin_bit_cast(PacketAddress, host);
}

constexpr Address ipv4_address(std::uint32_t host, std::uint16_t port) {
  return {.host = mapped(host), .scope = 0, .port = port, .family = AF_INET};
}

// Its last four bytes as a number; of IPv4 the address.
constexpr std::uint32_t number_in(const IpAddress& address) {
  return std::uint32_t{address.bytes[12]} << 24 | std::uint32_t{address.bytes[13]} << 16 |
         std::uint32_t{address.bytes[14]} << 8 | std::uint32_t{address.bytes[15]};
}

constexpr bool is_ipv4(const IpAddress& address) {
  for (int i = 0; i < 10; ++i) {
    if (address.bytes[i] != 0) return false;
  }
  return address.bytes[10] == 0xFF && address.bytes[11] == 0xFF;
}

// The addresses ::N.
constexpr bool is_small(const IpAddress& address, std::uint32_t number) {
  for (int i = 0; i < 12; ++i) {
    if (address.bytes[i] != 0) return false;
  }
  return number_in(address) == number;
}

constexpr bool is_any(const IpAddress& address) {
  return is_small(address, 0) || (is_ipv4(address) && number_in(address) == 0);
}

constexpr bool is_loopback(const IpAddress& address) {
  return is_small(address, 1) || (is_ipv4(address) && address.bytes[12] == 127);
}

constexpr bool is_group(const IpAddress& address) {
  return address.bytes[0] == 0xFF || (is_ipv4(address) && address.bytes[12] >> 4 == 0xE);
}

constexpr bool is_link_local(const IpAddress& address) {
  return address.bytes[0] == 0xFE && (address.bytes[1] & 0xC0) == 0x80;
}

// Addresses that each interface has of its own: link-local ones, and groups of a link or a host.
constexpr bool needs_scope(const IpAddress& address) {
  const int scope = address.bytes[0] == 0xFF ? address.bytes[1] & 0x0F : 0;
  return is_link_local(address) || scope == 1 || scope == 2;
}

constexpr IpAddress small_address(std::uint32_t number) {
  IpAddress address = mapped(number);
  address.bytes[10] = address.bytes[11] = 0;
  return address;
}
inline constexpr IpAddress kLoopback6 = small_address(1);

// fd00::N; host i has N = i + 1.
constexpr IpAddress unique_local(std::uint32_t number) {
  IpAddress address = small_address(number);
  address.bytes[0] = 0xFD;
  return address;
}

// The link-local address of the host that has this one by IPv4.
constexpr IpAddress link_local(std::uint32_t ipv4) {
  return {{0xFE, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, static_cast<std::uint8_t>(ipv4 >> 24), 0xFF, 0xFE,
           static_cast<std::uint8_t>(ipv4 >> 16), static_cast<std::uint8_t>(ipv4 >> 8),
           static_cast<std::uint8_t>(ipv4)}};
}

// The Ethernet address of the host's card `number`, from 0 on.
constexpr void write_card_address(std::uint32_t ipv4, std::uint32_t number,
                                  std::uint8_t (&card)[6]) {
  const std::uint8_t bytes[6] = {0x02,
                                 static_cast<std::uint8_t>(number),
                                 static_cast<std::uint8_t>(ipv4 >> 24),
                                 static_cast<std::uint8_t>(ipv4 >> 16),
                                 static_cast<std::uint8_t>(ipv4 >> 8),
                                 static_cast<std::uint8_t>(ipv4)};
  for (int i = 0; i < 6; ++i) card[i] = bytes[i];
}

// The Ethernet address to which packets for this one go: of its host's first card, or of a group
// (RFC 1112, section 6.4; RFC 2464, section 7). `first` is host 0's by IPv4.
constexpr void write_card_of(const IpAddress& address, std::uint32_t first,
                             std::uint8_t (&card)[6]) {
  const std::uint32_t number = number_in(address);
  if (is_ipv4(address) && is_group(address)) {
    write_card_address(number & 0x7FFFFF, 0, card);
    card[0] = 0x01;
    card[2] = 0x5E;
  } else if (is_group(address)) {
    write_card_address(number, 0x33, card);
    card[0] = 0x33;
  } else if (is_ipv4(address)) {
    write_card_address(number, 0, card);
  } else if (is_link_local(address)) {
    write_card_address((first & 0xFF000000) | (number & 0xFFFFFF), 0, card);
  } else {
    write_card_address(first + number - 1, 0, card);
  }
}

}  // namespace simbench::shim

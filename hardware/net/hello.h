// What both sides of a stream say first, in the clear: 46 bytes.
//
//   bytes  what
//   0-7    "simbench"
//   8-9    kProtocolVersion, least significant byte first
//   10-13  who speaks: PeerName::host
//   14-45  32 random bytes, fresh for each connection
//
// The first ten bytes are the same in every version of the protocol, so that another version can be
// named in a message. Any bytes are safe to parse.
#ifndef SIMBENCH_HARDWARE_NET_HELLO_H_
#define SIMBENCH_HARDWARE_NET_HELLO_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

inline constexpr std::size_t kHelloStartBytes = 10;
inline constexpr std::size_t kHelloBytes = 46;

struct Hello {
  std::uint16_t version = kProtocolVersion;
  PeerName from;
  std::array<std::byte, 32> random{};
  friend bool operator==(const Hello&, const Hello&) = default;
};

Hello fresh_hello(PeerName me);
std::array<std::byte, kHelloBytes> write_hello(const Hello& hello);

// The version in the start of a hello; nothing if these are no simbench node's bytes.
std::optional<std::uint16_t> hello_version(std::span<const std::byte, kHelloStartBytes> start);
// All of a hello whose start was found right.
Hello read_hello(std::span<const std::byte, kHelloBytes> bytes);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_HELLO_H_

// What goes over a stream's wire: whole numbers, the hello of each side, and messages in frames.
//
// A hello is what both sides say first, in the clear: 46 bytes.
//
//   bytes  what
//   0-7    "simbench"
//   8-9    kProtocolVersion, least significant byte first
//   10-13  who speaks: PeerName::host
//   14-45  32 random bytes, fresh for each connection
//
// The first ten bytes are the same in every version of the protocol, so that another version can be
// named in a message.
//
// A frame is a message: the length of its sealed box in four bytes, then the box. The length is in
// the clear and protected by the seal.
//
// Any bytes are safe to parse.
#ifndef SIMBENCH_HARDWARE_NET_WIRE_H_
#define SIMBENCH_HARDWARE_NET_WIRE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hardware/net/sealing.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

// Least significant byte first. Fills all of `to`; what of the number does not fit is left out.
inline void put_number(std::span<std::byte> to, std::uint64_t number) {
  for (std::byte& byte : to) {
    byte = static_cast<std::byte>(number & 0xff);
    number >>= 8;
  }
}

// From at most 8 bytes.
inline std::uint64_t number_in(std::span<const std::byte> from) {
  std::uint64_t number = 0;
  for (std::size_t i = from.size(); i-- > 0;) {
    number = number << 8 | std::to_integer<std::uint64_t>(from[i]);
  }
  return number;
}

inline constexpr std::size_t kFrameHeaderBytes = 4;
using FrameHeader = std::array<std::byte, kFrameHeaderBytes>;

inline FrameHeader frame_header(std::size_t message_bytes) {
  FrameHeader header{};
  put_number(header, message_bytes + kSealBytes);
  return header;
}

// The length of the box that follows; nothing if no message has such a box.
inline std::optional<std::size_t> box_bytes(const FrameHeader& header) {
  const std::uint64_t bytes = number_in(header);
  if (bytes < kSealBytes || bytes > SecureStream::kMaxMessageBytes + kSealBytes) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(bytes);
}

// Header and box of a message.
inline Bytes sealed_frame(const KeyBytes& key, std::uint64_t counter,
                          std::span<const std::byte> message) {
  return header_and_sealed(key, counter, frame_header(message.size()), message);
}

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

#endif  // SIMBENCH_HARDWARE_NET_WIRE_H_

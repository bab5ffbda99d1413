// What goes over the wire: whole numbers, sealed bytes, the hello of each side, messages in frames.
//
// Sealed bytes are encrypted with ChaCha20-Poly1305 (RFC 8439). open_sealed() refuses them if a bit
// of them, of the header, of the counter or of the key differs. The counter is the nonce: a key
// must never seal two messages under one counter, so keys are derived anew for every connection and
// direction, with BLAKE2b (RFC 7693), keyed with the key they come from. Only wire.cc calls
// libsodium's ciphers.
//
//   const KeyBytes key = derive_key(secret, "datagrams", transcript);
//   const Bytes sent = header_and_sealed(key, counter++, header, message);
//   const auto sealed = std::span(sent).subspan(kFrameHeaderBytes);
//   const std::optional<Bytes> opened = open_sealed(key, 0, header, sealed);
//
// A hello is the first message of each side, in the clear: 46 bytes.
//
//   bytes  what
//   0-7    "simbench"
//   8-9    kProtocolVersion, least significant byte first
//   10-13  the sender: PeerName::host
//   14-45  32 random bytes, fresh for each connection
//
// The first ten bytes are the same in every version of the protocol, so that an error message can
// name another version.
//
// A frame is a message: the length of its sealed box in four bytes, then the box. The length is in
// the clear and protected by the seal.
//
// Any bytes are safe to parse.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "algorithms/ports/host.h"
#include "hardware/net/secret_key.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

// Least significant byte first. Fills all of `to`; leaves out bytes of the number that do not fit.
inline void put_number(std::span<std::byte> to, std::uint64_t number) {
  for (std::byte& byte : to) {
    byte = static_cast<std::byte>(number & 0xff);
    number >>= 8;
  }
}

// Reads a number of at most 8 bytes.
inline std::uint64_t number_in(std::span<const std::byte> from) {
  std::uint64_t number = 0;
  for (std::size_t i = from.size(); i-- > 0;) {
    number = number << 8 | std::to_integer<std::uint64_t>(from[i]);
  }
  return number;
}

using KeyBytes = std::array<unsigned char, SecretKey::kBytes>;

// The bytes that a seal adds to a message.
inline constexpr std::size_t kSealBytes = 16;

// Prepares libsodium, once; the functions below and SecretKey call it themselves.
void start_sodium();

void fill_random(std::span<std::byte> bytes);
KeyBytes derive_key(const KeyBytes& key, std::string_view purpose,
                    std::span<const std::byte> context);

// Returns the header and, behind it, the sealed message. `header` stays in the clear and is
// protected by the seal.
Bytes header_and_sealed(const KeyBytes& key, std::uint64_t counter,
                        std::span<const std::byte> header, std::span<const std::byte> message);
// Nothing if `sealed` was not sealed with these arguments.
std::optional<Bytes> open_sealed(const KeyBytes& key, std::uint64_t counter,
                                 std::span<const std::byte> header,
                                 std::span<const std::byte> sealed);

inline constexpr std::size_t kFrameHeaderBytes = 4;
using FrameHeader = std::array<std::byte, kFrameHeaderBytes>;

inline FrameHeader frame_header(std::size_t message_bytes) {
  FrameHeader header{};
  put_number(header, message_bytes + kSealBytes);
  return header;
}

// The length of the box that follows; nothing if it is impossible.
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

// The version in the start of a hello; nothing if it is not a simbench node's.
std::optional<std::uint16_t> hello_version(std::span<const std::byte, kHelloStartBytes> start);
// Parses a hello whose start is valid.
Hello read_hello(std::span<const std::byte, kHelloBytes> bytes);

}  // namespace simbench::hardware

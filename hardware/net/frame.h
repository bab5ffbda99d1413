// How a message lies in a stream: the length of its sealed box in four bytes, then the box. The
// length is in the clear and protected by the seal. Any bytes are safe to parse.
#ifndef SIMBENCH_HARDWARE_NET_FRAME_H_
#define SIMBENCH_HARDWARE_NET_FRAME_H_

#include <array>
#include <optional>
#include <span>

#include "hardware/net/sealing.h"
#include "hardware/net/secure_stream.h"
#include "hardware/net/wire_numbers.h"

namespace simbench::hardware {

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

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_FRAME_H_

// What an unknown peer can send over a stream: hello, the headers of frames, their boxes. Any bytes
// are parsed without undefined behaviour, and nothing opens that was not sealed with the key.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

// Returns what follows the hello.
std::span<const std::byte> try_hello(std::span<const std::byte> bytes) {
  if (bytes.size() < kHelloBytes) return {};
  const auto hello = bytes.first<kHelloBytes>();
  const auto version = hello_version(hello.first<kHelloStartBytes>());
  if (version) {
    const Hello parsed = read_hello(hello);
    expect(parsed.version == *version);
    expect(std::ranges::equal(write_hello(parsed), hello));
  }
  return bytes.subspan(kHelloBytes);
}

void try_frames(std::span<const std::byte> bytes) {
  const KeyBytes key{1, 2, 3};
  for (std::uint64_t counter = 0; bytes.size() >= kFrameHeaderBytes; ++counter) {
    FrameHeader header{};
    std::ranges::copy(bytes.first(kFrameHeaderBytes), header.begin());
    bytes = bytes.subspan(kFrameHeaderBytes);
    const auto size = box_bytes(header);
    if (!size) return;
    expect(*size >= kSealBytes && frame_header(*size - kSealBytes) == header);
    if (*size > bytes.size()) return;
    expect(!open_sealed(key, counter, header, bytes.first(*size)));
    bytes = bytes.subspan(*size);
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  try_frames(try_hello(bytes));
  try_frames(bytes);
  return 0;
}

}  // namespace simbench::hardware

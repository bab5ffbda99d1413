#include "hardware/net/wire.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "hardware/net/sealing.h"

namespace simbench::hardware {
namespace {

constexpr std::string_view kMagic = "simbench";

}  // namespace

Hello fresh_hello(PeerName me) {
  Hello hello{.from = me};
  fill_random(hello.random);
  return hello;
}

std::array<std::byte, kHelloBytes> write_hello(const Hello& hello) {
  std::array<std::byte, kHelloBytes> bytes{};
  const std::span<std::byte> all(bytes);
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  put_number(all.subspan(8, 2), hello.version);
  put_number(all.subspan(10, 4), hello.from.host);
  std::copy(hello.random.begin(), hello.random.end(), bytes.begin() + 14);
  return bytes;
}

std::optional<std::uint16_t> hello_version(std::span<const std::byte, kHelloStartBytes> start) {
  if (std::memcmp(start.data(), kMagic.data(), kMagic.size()) != 0) return std::nullopt;
  return static_cast<std::uint16_t>(number_in(start.subspan(8, 2)));
}

Hello read_hello(std::span<const std::byte, kHelloBytes> bytes) {
  Hello hello;
  hello.version = static_cast<std::uint16_t>(number_in(bytes.subspan(8, 2)));
  hello.from.host = static_cast<std::uint32_t>(number_in(bytes.subspan(10, 4)));
  std::copy(bytes.begin() + 14, bytes.end(), hello.random.begin());
  return hello;
}

}  // namespace simbench::hardware

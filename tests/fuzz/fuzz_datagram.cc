// What anybody can send as a datagram: any bytes are parsed without undefined behaviour, and none
// are accepted that were not sealed with the key. Those that were are accepted once, also when
// the same bytes come in another order.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "hardware/net/datagram.h"

namespace {

using simbench::Bytes;
using simbench::hardware::DatagramSession;
using simbench::hardware::DatagramVerdict;
using simbench::hardware::KeyBytes;
using simbench::hardware::parse_datagram;
using simbench::hardware::take_channel;

void expect(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  const KeyBytes there{1};
  const KeyBytes back{2};
  DatagramSession receiver(0, back, there);
  Bytes opened;
  if (const auto header = parse_datagram(bytes)) {
    expect(receiver.open(*header, bytes, opened) == DatagramVerdict::kForged);
  }

  DatagramSession sender(1, there, back);
  const Bytes message(bytes.begin(), bytes.begin() + std::min<std::ptrdiff_t>(1024, bytes.size()));
  const Bytes sealed = sender.seal_next(message);
  const auto header = parse_datagram(sealed);
  expect(header && header->from == 1);
  if (size > 0) {
    Bytes damaged = sealed;
    damaged[data[0] % damaged.size()] ^= std::byte{static_cast<unsigned char>(1u << (size % 8))};
    if (const auto other = parse_datagram(damaged)) {
      expect(receiver.open(*other, damaged, opened) == DatagramVerdict::kForged);
    }
  }
  expect(receiver.open(*header, sealed, opened) == DatagramVerdict::kAccepted);
  expect(opened == message);
  expect(take_channel(opened).has_value() == (!message.empty() && message[0] < std::byte{2}));
  expect(receiver.open(*header, sealed, opened) == DatagramVerdict::kReplayed);
  return 0;
}

#include "hardware/net/datagram.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace simbench::hardware {
namespace {

constexpr std::byte kKind{0xd7};
constexpr std::byte kVersion{kProtocolVersion & 0xff};

using HeaderBytes = std::array<std::byte, kDatagramHeaderBytes>;

HeaderBytes write_header(std::uint16_t from, std::uint64_t counter) {
  HeaderBytes bytes{kKind, kVersion};
  const std::span<std::byte> all(bytes);
  put_number(all.subspan(2, 2), from);
  put_number(all.subspan(4, 8), counter);
  return bytes;
}

}  // namespace

std::optional<DatagramHeader> parse_datagram(std::span<const std::byte> datagram) {
  if (datagram.size() < kDatagramHeaderBytes + kSealBytes || datagram.size() > kMaxDatagramBytes ||
      datagram[0] != kKind || datagram[1] != kVersion) {
    return std::nullopt;
  }
  return DatagramHeader{.from = static_cast<std::uint16_t>(number_in(datagram.subspan(2, 2))),
                        .counter = number_in(datagram.subspan(4, 8))};
}

Bytes with_channel(Transport channel, std::span<const std::byte> message) {
  const auto* const number = std::find(kDatagramChannels.begin(), kDatagramChannels.end(), channel);
  Bytes bytes;
  bytes.reserve(kChannelBytes + message.size());
  bytes.push_back(static_cast<std::byte>(number - kDatagramChannels.begin()));
  bytes.insert(bytes.end(), message.begin(), message.end());
  return bytes;
}

std::optional<Transport> take_channel(Bytes& message) {
  if (message.empty()) return std::nullopt;
  const auto number = std::to_integer<std::size_t>(message.front());
  if (number >= kDatagramChannels.size()) return std::nullopt;
  message.erase(message.begin());
  return kDatagramChannels[number];
}

DatagramSession::DatagramSession(const SecureStream& stream, std::uint16_t me, std::uint16_t peer)
    : DatagramSession(me, stream.derived_key(me), stream.derived_key(peer)) {}

DatagramSession::DatagramSession(std::uint16_t me, const KeyBytes& send_key,
                                 const KeyBytes& receive_key)
    : me_(me), send_key_(send_key), receive_key_(receive_key) {}

Bytes DatagramSession::seal_next(std::span<const std::byte> message) {
  const std::uint64_t counter = next_++;
  return header_and_sealed(send_key_, counter, write_header(me_, counter), message);
}

DatagramVerdict DatagramSession::open(const DatagramHeader& header,
                                      std::span<const std::byte> datagram, Bytes& message) {
  // First, since it costs nothing; the window moves only for datagrams sealed with the key.
  if (!window_.is_fresh(header.counter)) return DatagramVerdict::kReplayed;
  auto opened = open_sealed(receive_key_, header.counter, datagram.first(kDatagramHeaderBytes),
                            datagram.subspan(kDatagramHeaderBytes));
  if (!opened) return DatagramVerdict::kForged;
  window_.accept(header.counter);
  message = std::move(*opened);
  return DatagramVerdict::kAccepted;
}

}  // namespace simbench::hardware

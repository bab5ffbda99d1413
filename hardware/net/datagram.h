// A datagram between two hosts: sender and counter in the clear, channel and message sealed.
//
//   bytes  what
//   0      0xd7
//   1      kProtocolVersion, its low byte
//   2-3    the sender's number, least significant byte first
//   4-11   counter: the nonce, by which replays are detected
//   12     sealed from here on: the channel, a kDatagramChannels
//   13-    the message; kSealBytes of the seal follow
//
// The first twelve bytes are protected by the seal. Keys come from the session of the two hosts'
// stream, one for each direction. Pure; any bytes are safe to parse.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hardware/net/secure_stream.h"
#include "hardware/net/wire.h"

namespace simbench::hardware {

inline constexpr std::size_t kDatagramHeaderBytes = 12;
inline constexpr std::size_t kMaxDatagramBytes = 65507;  // what UDP over IPv4 carries
inline constexpr std::size_t kChannelBytes = 1;
inline constexpr std::size_t kMaxDatagramMessage =
    kMaxDatagramBytes - kDatagramHeaderBytes - kChannelBytes - kSealBytes;

// Which of a pair's channels a message is for, by its number on the wire.
inline constexpr std::array kDatagramChannels = {Transport::kDatagram, Transport::kAlignment};

// A message behind its channel, as it is sealed.
Bytes with_channel(Transport channel, std::span<const std::byte> message);
// Takes the channel off a message; nothing if there is none of that number.
std::optional<Transport> take_channel(Bytes& message);

struct DatagramHeader {
  std::uint16_t from = 0;
  std::uint64_t counter = 0;
};

// Nothing if it does not belong to this protocol.
std::optional<DatagramHeader> parse_datagram(std::span<const std::byte> datagram);

// The accepted counters of a session's datagrams: each at most once, and none that is kSize or more
// behind the highest.
//
// Source: RFC 6479, with blocks of 64 bits.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  // Neither accepted before nor too old.
  bool is_fresh(std::uint64_t counter) const {
    if (empty_ || counter > highest_) return true;
    return highest_ - counter < kSize && (block(counter) & bit(counter)) == 0;
  }

  // Call it for a fresh counter, once its datagram has proved to be authentic.
  void accept(std::uint64_t counter) {
    if (empty_ || counter > highest_) {
      move_to(counter);
    }
    block(counter) |= bit(counter);
  }

 private:
  // One block more than the window, which clears a whole block when it moves into it.
  static constexpr std::uint64_t kBlocks = kSize / 64 + 1;

  static std::uint64_t bit(std::uint64_t counter) { return std::uint64_t{1} << (counter % 64); }
  std::uint64_t& block(std::uint64_t counter) { return blocks_[counter / 64 % kBlocks]; }
  const std::uint64_t& block(std::uint64_t counter) const {
    return blocks_[counter / 64 % kBlocks];
  }

  void move_to(std::uint64_t counter) {
    const std::uint64_t steps = empty_ ? kBlocks : counter / 64 - highest_ / 64;
    if (steps >= kBlocks) {
      blocks_.fill(0);
    } else {
      for (std::uint64_t i = 1; i <= steps; ++i) blocks_[(highest_ / 64 + i) % kBlocks] = 0;
    }
    highest_ = counter;
    empty_ = false;
  }

  std::array<std::uint64_t, kBlocks> blocks_{};
  std::uint64_t highest_ = 0;
  bool empty_ = true;
};

enum class DatagramVerdict : std::uint8_t { kAccepted, kForged, kReplayed };

// The keys and counters of one pair of hosts in one session of their stream.
class DatagramSession {
 public:
  DatagramSession(const SecureStream& stream, std::uint16_t me, std::uint16_t peer);
  // With given keys.
  DatagramSession(std::uint16_t me, const KeyBytes& send_key, const KeyBytes& receive_key);

  Bytes seal_next(std::span<const std::byte> message);
  // Sets `message` if the datagram is accepted, which it is at most once.
  DatagramVerdict open(const DatagramHeader& header, std::span<const std::byte> datagram,
                       Bytes& message);

 private:
  std::uint16_t me_;
  KeyBytes send_key_;
  KeyBytes receive_key_;
  std::uint64_t next_ = 0;
  ReplayWindow window_;
};

}  // namespace simbench::hardware

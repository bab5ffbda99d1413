// A datagram between two hosts: who sent it and a counter in the clear, the message sealed.
//
//   bytes  what
//   0      0xd7
//   1      kProtocolVersion, its low byte
//   2-3    the sender's number, least significant byte first
//   4-11   counter: the nonce, and what a replay is known by
//   12-    sealed message, kSealBytes longer than the message
//
// The first twelve bytes are protected by the seal. Keys come from the session of the two hosts'
// stream, one for each direction. Pure; any bytes are safe to parse.
#ifndef SIMBENCH_HARDWARE_NET_DATAGRAM_H_
#define SIMBENCH_HARDWARE_NET_DATAGRAM_H_

#include <cstdint>
#include <optional>
#include <span>

#include "hardware/net/replay_window.h"
#include "hardware/net/sealing.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

inline constexpr std::size_t kDatagramHeaderBytes = 12;
inline constexpr std::size_t kMaxDatagramBytes = 65507;  // what UDP over IPv4 carries
inline constexpr std::size_t kMaxDatagramMessage =
    kMaxDatagramBytes - kDatagramHeaderBytes - kSealBytes;

struct DatagramHeader {
  std::uint16_t from = 0;
  std::uint64_t counter = 0;
};

// Nothing if it is none of this protocol.
std::optional<DatagramHeader> parse_datagram(std::span<const std::byte> datagram);

enum class DatagramVerdict : std::uint8_t { kAccepted, kForged, kReplayed };

// The keys and counters of one pair of hosts in one session of their stream.
class DatagramSession {
 public:
  DatagramSession(const SecureStream& stream, std::uint16_t me, std::uint16_t peer);
  // For who has the keys already.
  DatagramSession(std::uint16_t me, const KeyBytes& send_key, const KeyBytes& receive_key);

  Bytes seal_next(std::span<const std::byte> message);
  // `message` is what it carries, if it is accepted. A datagram is accepted once.
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

#endif  // SIMBENCH_HARDWARE_NET_DATAGRAM_H_

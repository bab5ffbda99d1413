// What the shim itself keeps of a socket of the simulated network, and addresses.
//
//   Address to{};
//   const sockaddr_in name{};
//   read_address(reinterpret_cast<const sockaddr*>(&name), sizeof name, to);
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

#include "shim/link.h"

namespace simbench::shim {

// The host's network interface; the loopback has number 1.
inline constexpr int kInterface = 2;

// The software stamps of arrivals by the older options; beside those of SO_TIMESTAMPING.
enum class Stamps : std::uint8_t { kNone, kTimeval, kTimespec };

struct SocketState {
  int type = SOCK_DGRAM;
  Stamps stamps = Stamps::kNone;
  bool wants_destination = false;  // IP_PKTINFO
  bool shares_port = false;        // SO_REUSEADDR
  bool may_broadcast = false;      // SO_BROADCAST
  unsigned timestamping = 0;       // SO_TIMESTAMPING
  std::uint32_t first_number = 0;  // from which SOF_TIMESTAMPING_OPT_ID counts
  std::int64_t timeout_ns = -1;    // SO_RCVTIMEO
};

bool is_socket(int fd);
// What departures are stamped by, of the flags of SO_TIMESTAMPING: StampKind as bits.
std::int64_t departure_stamps(unsigned flags);
SocketState& state_of(int fd);

// False with errno.
bool read_address(const sockaddr* name, socklen_t size, Address& address);
// Cut to *size, which becomes the whole size.
void write_address(const Address& address, sockaddr* name, socklen_t* size);

// Copies the pieces of a message that is sent, one after the other. Returns their size, or -1 with
// EMSGSIZE if there is no room for them.
ssize_t gather(const msghdr& message, unsigned char* to, std::size_t room);
// Fills the pieces of a message that is received. Returns how many bytes they took.
std::size_t scatter(const unsigned char* from, std::size_t size, const msghdr& message);

}  // namespace simbench::shim

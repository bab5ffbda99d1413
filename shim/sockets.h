// What the shim itself keeps of a socket of the simulated network, and addresses.
//
//   Address to{};
//   const sockaddr_in name{};
//   const int fd = socket(AF_INET, SOCK_DGRAM, 0);
//   read_address(fd, NameUse::kSend, reinterpret_cast<const sockaddr*>(&name), sizeof name, to);
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

#include "shim/addresses.h"
#include "shim/link.h"

namespace simbench::shim {

// The software stamps of arrivals by the older options; beside those of SO_TIMESTAMPING.
enum class Stamps : std::uint8_t { kNone, kTimeval, kTimespec };

struct SocketState {
  int family = 0;  // 0: not known yet
  int type = SOCK_DGRAM;
  int protocol = 0;
  Stamps stamps = Stamps::kNone;
  unsigned timestamping = 0;       // SO_TIMESTAMPING
  std::uint32_t first_number = 0;  // from which SOF_TIMESTAMPING_OPT_ID counts
  std::int64_t timeout_ns = -1;    // SO_RCVTIMEO
  std::int64_t send_timeout_ns = -1;
  ::linger linger{};
  std::uint32_t interface = 0;         // SO_BINDTODEVICE
  std::uint32_t group_interface = 0;   // IP_MULTICAST_IF
  std::uint32_t group_interface6 = 0;  // IPV6_MULTICAST_IF
  bool listens = false;
};

// A socket of datagrams; packet sockets are among them.
bool is_socket(int fd);
// Either that, or a connection's.
bool is_of_network(int fd);
SocketState& state_of(int fd);
int family_of(int fd);
// The number that an option has (shim/option_table.h); 0 for one that there is not.
int option_of(int fd, int level, int option);
// A new socket has what all begin with.
void forget_options(int fd);
// What departures are stamped by, of the flags of SO_TIMESTAMPING: StampKind as bits.
std::int64_t departure_stamps(unsigned flags);

enum class NameUse : std::uint8_t { kBind, kConnect, kSend };

// What a program says to a socket of this family. False with errno.
bool read_address(int fd, NameUse use, const sockaddr* name, socklen_t size, Address& address);
// Cut to *size, which becomes the whole size; 0 for an address of no family.
void write_address(const Address& address, sockaddr* name, socklen_t* size);

// Copies the pieces of a message that is sent, one after the other. Returns their size, or -1 with
// EMSGSIZE if there is no room for them.
ssize_t gather(const msghdr& message, unsigned char* to, std::size_t room);
// Fills the pieces of a message that is received. Returns how many bytes they took.
std::size_t scatter(const unsigned char* from, std::size_t size, const msghdr& message);

// sendmsg() and recvmsg() of a socket of datagrams.
ssize_t send_datagram(int fd, const msghdr& message, int flags);
ssize_t receive_datagram(int fd, msghdr& message, int flags);

}  // namespace simbench::shim

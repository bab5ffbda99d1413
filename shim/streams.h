// Connections of the simulated network (SOCK_STREAM).
//
//   const int fd = 5;
//   const Address server = ipv4_address(0x0A000001, 80);
//   if (is_stream(fd)) stream_connect(fd, server);
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include "shim/addresses.h"
#include "shim/link.h"

namespace simbench::shim {

inline bool is_stream(int fd) { return kind_of(fd) == Kind::kStream; }

// As the calls without "stream_".
int stream_connect(int fd, const Address& address);
int stream_accept(int fd, sockaddr* name, socklen_t* size, int flags);
ssize_t stream_send(int fd, const msghdr& message, int flags);
ssize_t stream_receive(int fd, msghdr& message, int flags);

}  // namespace simbench::shim

// A routing socket (NETLINK_ROUTE): it states the host's links and addresses when asked for them,
// knows nothing else, and is silent ever after, as nothing happens to them.
//
// Its descriptor is an event counter, readable while an answer waits: a wait looks at it as at any
// real descriptor.
//
// Source: netlink(7), rtnetlink(7).
//
//   const int fd = open_netlink(SOCK_RAW | SOCK_CLOEXEC, 0);  // NETLINK_ROUTE
//   const msghdr nothing{};
//   if (is_netlink(fd)) netlink_send(fd, nothing);
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include "shim/link.h"

namespace simbench::shim {

inline bool is_netlink(int fd) { return kind_of(fd) == Kind::kNetlink; }

// As socket(), sendmsg(), recvmsg() and getsockname().
int open_netlink(int type, int protocol);
ssize_t netlink_send(int fd, const msghdr& message);
ssize_t netlink_receive(int fd, msghdr& message, int flags);
int netlink_name(sockaddr* name, socklen_t* size);
int netlink_peer_name(sockaddr* name, socklen_t* size);

}  // namespace simbench::shim

// What the threads and processes of a host have between them, and the kernel keeps: Unix-domain
// sockets, pipes, eventfd(), signalfd(), inotify.
//
// Paths are those of the host's folder (shim/paths.h), so that hosts do not meet. A thread that
// waits for such a descriptor waits in simulated time: whoever reads, writes, connects or closes
// one tells the world, which lets the others of its host look again.
//
//   const int fd = local_socket(AF_UNIX, SOCK_DGRAM, 0);
//   const sockaddr_un name{.sun_family = AF_UNIX, .sun_path = "./ptp4l"};
//   local_bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include "shim/link.h"

namespace simbench::shim {

inline bool is_local(int fd) { return kind_of(fd) == Kind::kLocal; }

// As the calls without "local_".
int local_socket(int domain, int type, int protocol);
int local_bind(int fd, const sockaddr* name, socklen_t size);
int local_connect(int fd, const sockaddr* name, socklen_t size);
ssize_t local_sendmsg(int fd, const msghdr* message, int flags);
ssize_t local_recvmsg(int fd, msghdr* message, int flags);
int local_accept(int fd, sockaddr* name, socklen_t* size, int flags);
int local_getsockopt(int fd, int level, int option, void* value, socklen_t* size);
ssize_t local_read(int fd, void* data, std::size_t size);
ssize_t local_write(int fd, const void* data, std::size_t size);

// The descriptor has been closed.
void local_closed();
// For a blocking read by another call; false with errno.
bool local_waits_to_read(int fd);
// It is local if it is a pipe.
void note_pipe(int fd);

}  // namespace simbench::shim

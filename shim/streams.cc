#include "shim/streams.h"

#include <errno.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include "shim/local.h"
#include "shim/netlink.h"
#include "shim/sockets.h"

namespace simbench::shim {
namespace {

// After EAGAIN: whether the call may go on, as it waited for the descriptor.
bool waits(int fd, short events, int flags) {
  if (errno != EAGAIN || (flags & MSG_DONTWAIT) != 0 || !is_blocking(fd)) return false;
  pollfd interest{.fd = fd, .events = events, .revents = 0};
  const std::int64_t ns = (events & POLLIN) != 0 ? state_of(fd).timeout_ns : -1;
  const timespec timeout = to_timespec(ns);
  if (ppoll(&interest, 1, ns < 0 ? nullptr : &timeout, nullptr) > 0) return true;
  errno = EAGAIN;
  return false;
}

// One piece, as far as it was taken; -1 with errno if nothing was.
ssize_t send_piece(int fd, const unsigned char* data, std::size_t size, int flags) {
  constexpr std::size_t kMost = kMostData - sizeof(Departure);
  const Departure nobody{};
  std::size_t sent = 0;
  while (sent < size) {
    const std::size_t part = size - sent < kMost ? size - sent : kMost;
    const std::int64_t taken =
        ask({.call = Call::kSend, .fd = fd}, {&nobody, sizeof nobody}, {data + sent, part});
    if (taken >= 0) {
      sent += static_cast<std::size_t>(taken);
    } else if (!waits(fd, POLLOUT, flags)) {
      return sent > 0 ? static_cast<ssize_t>(sent) : -1;
    }
  }
  return static_cast<ssize_t>(sent);
}

// As read(); nothing at the end of the stream.
ssize_t receive_piece(int fd, unsigned char* data, std::size_t size, int flags) {
  for (;;) {
    const std::size_t part = size < kMostData ? size : kMostData;
    Received reply{.data = data, .capacity = part};
    const std::int64_t got = ask({.call = Call::kReceive,
                                  .fd = fd,
                                  .a = (flags & MSG_PEEK) != 0 ? 2 : 0,
                                  .b = static_cast<std::int64_t>(part)},
                                 {}, {}, &reply);
    if (got >= 0) return static_cast<ssize_t>(got);
    if (!waits(fd, POLLIN, flags)) return -1;
  }
}

}  // namespace

int stream_connect(int fd, const Address& address) {
  if (ask({.call = Call::kConnect, .fd = fd}, {&address, sizeof address}) >= 0) return 0;
  if (errno != EINPROGRESS || !is_blocking(fd)) return -1;
  pollfd interest{.fd = fd, .events = POLLOUT, .revents = 0};
  if (poll(&interest, 1, -1) < 0) return -1;
  const std::int64_t error = ask({.call = Call::kSocketError, .fd = fd});
  if (error == 0) return 0;
  return refuse(static_cast<int>(error));
}

int stream_accept(int fd, sockaddr* name, socklen_t* size, int flags) {
  Address peer{};
  for (;;) {
    const int accepted =
        open_descriptor(Kind::kStream, (flags & SOCK_NONBLOCK) != 0, (flags & SOCK_CLOEXEC) != 0);
    if (accepted < 0) return -1;
    if (ask_for({.call = Call::kAccept, .fd = fd, .a = number_of(accepted)}, peer) >= 0) {
      state_of(accepted) = {.family = peer.family, .type = SOCK_STREAM, .protocol = IPPROTO_TCP};
      forget_options(accepted);
      write_address(peer, name, size);
      return accepted;
    }
    discard_descriptor(accepted);
    if (!waits(fd, POLLIN, 0)) return -1;
  }
}

ssize_t stream_send(int fd, const msghdr& message, int flags) {
  ssize_t sent = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const iovec& piece = message.msg_iov[i];
    const ssize_t part =
        send_piece(fd, static_cast<const unsigned char*>(piece.iov_base), piece.iov_len, flags);
    if (part < 0 && sent == 0) {
      if (errno == EPIPE && (flags & MSG_NOSIGNAL) == 0) raise(SIGPIPE);
      return -1;
    }
    if (part < 0) break;
    sent += part;
    if (static_cast<std::size_t>(part) < piece.iov_len) break;
  }
  return sent;
}

ssize_t stream_receive(int fd, msghdr& message, int flags) {
  const bool wants_all = (flags & MSG_WAITALL) != 0;
  message.msg_namelen = 0;  // the peer is known
  ssize_t received = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const iovec& piece = message.msg_iov[i];
    std::size_t filled = 0;
    while (filled < piece.iov_len) {
      const int how = received > 0 && !wants_all ? flags | MSG_DONTWAIT : flags;
      const ssize_t part = receive_piece(fd, static_cast<unsigned char*>(piece.iov_base) + filled,
                                         piece.iov_len - filled, how);
      if (part < 0 && received == 0) return -1;
      if (part <= 0) return received;
      filled += static_cast<std::size_t>(part);
      received += part;
      // What is left there would only be seen again.
      if ((flags & MSG_PEEK) != 0 || (filled < piece.iov_len && !wants_all)) return received;
    }
  }
  return received;
}

SIMBENCH_CALL int listen(int fd, int backlog) {
  if (is_netlink(fd)) return refuse(EOPNOTSUPP);
  if (is_of_network(fd)) {
    const int result = static_cast<int>(ask({.call = Call::kListen, .fd = fd, .a = backlog}));
    if (result == 0) state_of(fd).listens = true;
    return result;
  }
  return SIMBENCH_REAL(listen)(fd, backlog);
}

SIMBENCH_CALL int accept4(int fd, sockaddr* name, socklen_t* size, int flags) {
  if (is_stream(fd)) return stream_accept(fd, name, size, flags);
  if (is_local(fd)) return local_accept(fd, name, size, flags);
  if (is_socket(fd) || is_netlink(fd)) return refuse(EOPNOTSUPP);
  return SIMBENCH_REAL(accept4)(fd, name, size, flags);
}

SIMBENCH_CALL int accept(int fd, sockaddr* name, socklen_t* size) {
  return accept4(fd, name, size, 0);
}

SIMBENCH_CALL int shutdown(int fd, int how) {
  if (is_netlink(fd)) return refuse(EOPNOTSUPP);
  if (is_of_network(fd)) {
    return static_cast<int>(ask({.call = Call::kShutDown, .fd = fd, .a = how}));
  }
  const int result = SIMBENCH_REAL(shutdown)(fd, how);
  if (is_local(fd)) local_closed();
  return result;
}

}  // namespace simbench::shim

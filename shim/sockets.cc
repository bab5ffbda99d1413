// Sockets of the simulated network, datagrams above all; others are refused but for those of
// shim/local.h and shim/netlink.h.
#include "shim/sockets.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>

#include "shim/local.h"
#include "shim/netlink.h"
#include "shim/own_clock.h"
#include "shim/streams.h"

namespace simbench::shim {

ssize_t gather(const msghdr& message, unsigned char* to, std::size_t room) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) {
    const iovec& piece = message.msg_iov[i];
    if (piece.iov_len > room - size) return refuse(EMSGSIZE);
    memcpy(to + size, piece.iov_base, piece.iov_len);
    size += piece.iov_len;
  }
  return static_cast<ssize_t>(size);
}

std::size_t scatter(const unsigned char* from, std::size_t size, const msghdr& message) {
  std::size_t copied = 0;
  for (std::size_t i = 0; i < message.msg_iovlen && copied < size; ++i) {
    const iovec& piece = message.msg_iov[i];
    const std::size_t left = size - copied;
    const std::size_t part = piece.iov_len < left ? piece.iov_len : left;
    memcpy(piece.iov_base, from + copied, part);
    copied += part;
  }
  return copied;
}

namespace {

int name_of(int fd, Call call, sockaddr* name, socklen_t* size) {
  Address address{};
  if (ask_for({.call = call, .fd = fd}, address) < 0) return -1;
  write_address(address, name, size);
  return 0;
}

// What goes through sendmsg() and recvmsg() is not: the world's, routing and local sockets.
bool is_real(int fd) { return !is_of_network(fd) && !is_netlink(fd) && !is_local(fd); }

// Whether a kernel with IP and packet sockets alone has such a socket; 0 or an errno, as
// __sock_create(), inet_create() and packet_create() choose it.
int obstacle_to(int domain, int type, int protocol) {
  if (domain == AF_PACKET) {
    const bool is_known = type == SOCK_RAW || type == SOCK_DGRAM;
    return is_known ? 0 : ESOCKTNOSUPPORT;
  }
  if (protocol < 0 || protocol >= IPPROTO_MAX) return EINVAL;
  if (type != SOCK_DGRAM && type != SOCK_STREAM) return ESOCKTNOSUPPORT;
  const int only = type == SOCK_STREAM ? IPPROTO_TCP : IPPROTO_UDP;
  return protocol == 0 || protocol == only ? 0 : EPROTONOSUPPORT;
}

int open_socket(int domain, int type, int protocol, int flags) {
  const bool is_stream = domain != AF_PACKET && type == SOCK_STREAM;
  const int fd = open_descriptor(is_stream ? Kind::kStream : Kind::kSocket,
                                 (flags & SOCK_NONBLOCK) != 0, (flags & SOCK_CLOEXEC) != 0);
  if (fd < 0) return -1;
  const int known = is_stream ? IPPROTO_TCP : IPPROTO_UDP;
  state_of(fd) = {.family = domain, .type = type, .protocol = domain == AF_PACKET ? 0 : known};
  forget_options(fd);
  std::int64_t kind = domain;
  if (domain == AF_PACKET) kind |= std::int64_t{ntohs(static_cast<std::uint16_t>(protocol))} << 16;
  if (ask({.call = Call::kOpenSocket, .fd = fd, .a = type, .b = kind}) < 0) {
    discard_descriptor(fd);
    return -1;
  }
  return fd;
}

}  // namespace

bool is_of_network(int fd) { return is_socket(fd) || is_stream(fd); }

SIMBENCH_CALL int socket(int domain, int type, int protocol) {
  if (!is_simulated()) return SIMBENCH_REAL(socket)(domain, type, protocol);
  if (domain == AF_UNIX) return local_socket(domain, type, protocol);
  constexpr int kFlags = SOCK_NONBLOCK | SOCK_CLOEXEC;
  constexpr int kTypes = 0xF;
  const int kind = type & kTypes;
  const int flags = type & ~kTypes;
  if ((flags & ~kFlags) != 0) return refuse(EINVAL);
  if (domain != AF_NETLINK && domain != AF_INET && domain != AF_INET6 && domain != AF_PACKET) {
    return refuse(EAFNOSUPPORT);
  }
  constexpr int kAfterLastType = SOCK_PACKET + 1;
  if (kind >= kAfterLastType) return refuse(EINVAL);
  if (domain == AF_NETLINK) return open_netlink(type, protocol);
  const int obstacle = obstacle_to(domain, kind, protocol);
  return obstacle != 0 ? refuse(obstacle) : open_socket(domain, kind, protocol, flags);
}

SIMBENCH_CALL int bind(int fd, const sockaddr* name, socklen_t size) {
  if (is_local(fd)) return local_bind(fd, name, size);
  if (is_netlink(fd)) return 0;
  if (!is_of_network(fd)) return SIMBENCH_REAL(bind)(fd, name, size);
  Address address{};
  if (!read_address(fd, NameUse::kBind, name, size, address)) return -1;
  return static_cast<int>(ask({.call = Call::kBind, .fd = fd}, {&address, sizeof address}));
}

SIMBENCH_CALL int connect(int fd, const sockaddr* name, socklen_t size) {
  if (is_local(fd)) return local_connect(fd, name, size);
  if (is_netlink(fd)) return 0;
  if (!is_of_network(fd)) return SIMBENCH_REAL(connect)(fd, name, size);
  if (family_of(fd) == AF_PACKET) return refuse(EOPNOTSUPP);
  Address address{};
  if (!read_address(fd, NameUse::kConnect, name, size, address)) return -1;
  if (is_stream(fd)) return stream_connect(fd, address);
  return static_cast<int>(ask({.call = Call::kConnect, .fd = fd}, {&address, sizeof address}));
}

SIMBENCH_CALL int getsockname(int fd, sockaddr* name, socklen_t* size) {
  if (is_netlink(fd)) return netlink_name(name, size);
  if (!is_of_network(fd)) return SIMBENCH_REAL(getsockname)(fd, name, size);
  return name_of(fd, Call::kName, name, size);
}

SIMBENCH_CALL int getpeername(int fd, sockaddr* name, socklen_t* size) {
  if (is_netlink(fd)) return netlink_peer_name(name, size);
  if (!is_of_network(fd)) return SIMBENCH_REAL(getpeername)(fd, name, size);
  return name_of(fd, Call::kPeerName, name, size);
}

SIMBENCH_CALL ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  if (is_local(fd)) return local_sendmsg(fd, message, flags);
  if (is_stream(fd)) return stream_send(fd, *message, flags);
  if (is_netlink(fd)) return netlink_send(fd, *message);
  if (!is_socket(fd)) return SIMBENCH_REAL(sendmsg)(fd, message, flags);
  return send_datagram(fd, *message, flags);
}

SIMBENCH_CALL int sendmmsg(int fd, mmsghdr* messages, unsigned int count, int flags) {
  if (is_real(fd)) return SIMBENCH_REAL(sendmmsg)(fd, messages, count, flags);
  for (unsigned int i = 0; i < count; ++i) {
    const ssize_t sent = sendmsg(fd, &messages[i].msg_hdr, flags);
    if (sent < 0) return i > 0 ? static_cast<int>(i) : -1;
    messages[i].msg_len = static_cast<unsigned int>(sent);
  }
  return static_cast<int>(count);
}

SIMBENCH_CALL ssize_t sendto(int fd, const void* data, std::size_t size, int flags,
                             const sockaddr* to, socklen_t to_size) {
  if (is_real(fd)) {
    return SIMBENCH_REAL(sendto)(fd, data, size, flags, to, to_size);
  }
  iovec piece{.iov_base = const_cast<void*>(data), .iov_len = size};
  msghdr message{};
  message.msg_name = const_cast<sockaddr*>(to);
  message.msg_namelen = to_size;
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  return sendmsg(fd, &message, flags);
}

SIMBENCH_CALL ssize_t send(int fd, const void* data, std::size_t size, int flags) {
  if (is_real(fd)) return SIMBENCH_REAL(send)(fd, data, size, flags);
  return sendto(fd, data, size, flags, nullptr, 0);
}

SIMBENCH_CALL ssize_t recvmsg(int fd, msghdr* message, int flags) {
  if (is_local(fd)) return local_recvmsg(fd, message, flags);
  if (is_stream(fd)) return stream_receive(fd, *message, flags);
  if (is_netlink(fd)) return netlink_receive(fd, *message, flags);
  if (!is_socket(fd)) {
    const ssize_t size = SIMBENCH_REAL(recvmsg)(fd, message, flags);
    if (size >= 0) convert_stamps(*message);
    return size;
  }
  return receive_datagram(fd, *message, flags);
}

SIMBENCH_CALL int recvmmsg(int fd, mmsghdr* messages, unsigned int count, int flags,
                           timespec* timeout) {
  if (is_real(fd)) {
    const int received = SIMBENCH_REAL(recvmmsg)(fd, messages, count, flags, timeout);
    for (int i = 0; i < received; ++i) convert_stamps(messages[i].msg_hdr);
    return received;
  }
  for (unsigned int i = 0; i < count; ++i) {
    const bool may_wait = i == 0 || (flags & MSG_WAITFORONE) == 0;
    const int each = (flags & ~MSG_WAITFORONE) | (may_wait ? 0 : MSG_DONTWAIT);
    const ssize_t received = recvmsg(fd, &messages[i].msg_hdr, each);
    if (received < 0) return i > 0 ? static_cast<int>(i) : -1;
    messages[i].msg_len = static_cast<unsigned int>(received);
  }
  return static_cast<int>(count);
}

SIMBENCH_CALL ssize_t recvfrom(int fd, void* data, std::size_t size, int flags, sockaddr* from,
                               socklen_t* from_size) {
  if (is_real(fd)) {
    return SIMBENCH_REAL(recvfrom)(fd, data, size, flags, from, from_size);
  }
  iovec piece{.iov_base = data, .iov_len = size};
  msghdr message{};
  message.msg_name = from;
  message.msg_namelen = from_size != nullptr ? *from_size : 0;
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  const ssize_t received = recvmsg(fd, &message, flags);
  if (received >= 0 && from_size != nullptr) *from_size = message.msg_namelen;
  return received;
}

SIMBENCH_CALL ssize_t recv(int fd, void* data, std::size_t size, int flags) {
  if (is_real(fd)) return SIMBENCH_REAL(recv)(fd, data, size, flags);
  return recvfrom(fd, data, size, flags, nullptr, nullptr);
}

}  // namespace simbench::shim

// Sockets of the simulated network, datagrams above all; others are refused but for those of
// shim/local.h and shim/netlink.h.
#include "shim/sockets.h"

#include <arpa/inet.h>
#include <errno.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include "shim/local.h"
#include "shim/netlink.h"
#include "shim/own_clock.h"
#include "shim/streams.h"

namespace simbench::shim {

bool read_address(const sockaddr* name, socklen_t size, Address& address) {
  if (name == nullptr || size < sizeof(sockaddr_in) || name->sa_family != AF_INET) {
    errno = name != nullptr && size >= sizeof name->sa_family ? EAFNOSUPPORT : EINVAL;
    return false;
  }
  sockaddr_in in{};
  memcpy(&in, name, sizeof in);
  address = {.host = ntohl(in.sin_addr.s_addr), .port = ntohs(in.sin_port), .reserved = 0};
  return true;
}

void write_address(const Address& address, sockaddr* name, socklen_t* size) {
  if (name == nullptr || size == nullptr) return;
  sockaddr_in in{};
  in.sin_family = AF_INET;
  in.sin_port = htons(address.port);
  in.sin_addr.s_addr = htonl(address.host);
  memcpy(name, &in, *size < sizeof in ? *size : sizeof in);
  *size = sizeof in;
}

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

// The message of a transmit stamp is the packet as it left: Ethernet, IPv4, UDP, payload.
constexpr std::size_t kPacketHeads = 14 + 20 + 8;

void write_heads(const Arrival& arrival, unsigned char* heads) {
  memset(heads, 0, kPacketHeads);
  heads[12] = 0x08;  // IPv4
  unsigned char* ip = heads + 14;
  ip[0] = 0x45;
  ip[9] = IPPROTO_UDP;
  const std::uint32_t from = htonl(arrival.from.host);
  const std::uint32_t to = htonl(arrival.to.host);
  memcpy(ip + 12, &from, sizeof from);
  memcpy(ip + 16, &to, sizeof to);
  const std::uint16_t ports[] = {htons(arrival.from.port), htons(arrival.to.port),
                                 htons(static_cast<std::uint16_t>(8 + arrival.length))};
  memcpy(heads + 34, ports, sizeof ports);
}

struct Datagram {
  Arrival arrival{};
  unsigned char bytes[kPacketHeads + kMostData] = {};
  std::size_t begin = kPacketHeads;  // of the payload, or of the heads before it
  std::size_t size = 0;
};
Datagram datagram;  // the one at hand; a program has one thread

// Waits until there is one, if the call may wait.
bool wait_for_datagram(int fd, int flags) {
  if ((flags & (MSG_DONTWAIT | MSG_ERRQUEUE)) != 0 || !is_blocking(fd)) return false;  // EAGAIN
  return wait_for_input(fd, state_of(fd).timeout_ns);
}

bool take_datagram(int fd, int flags) {
  unsigned char reply_data[sizeof(Arrival) + kMostData];
  for (;;) {
    Received reply{.data = reply_data, .capacity = sizeof reply_data};
    const std::int64_t how =
        ((flags & MSG_ERRQUEUE) != 0 ? 1 : 0) | ((flags & MSG_PEEK) != 0 ? 2 : 0);
    if (ask({.call = Call::kReceive, .fd = fd, .a = how}, {}, {}, &reply) >= 0) {
      memcpy(&datagram.arrival, reply_data, sizeof(Arrival));
      datagram.size = reply.size - sizeof(Arrival);
      memcpy(datagram.bytes + kPacketHeads, reply_data + sizeof(Arrival), datagram.size);
      datagram.begin = kPacketHeads;
      if ((flags & MSG_ERRQUEUE) == 0) return true;
      if ((state_of(fd).timestamping & SOF_TIMESTAMPING_OPT_TSONLY) != 0) {
        datagram.size = 0;
        return true;
      }
      write_heads(datagram.arrival, datagram.bytes);
      datagram.begin = 0;
      datagram.size += kPacketHeads;
      return true;
    }
    if (errno != EAGAIN || !wait_for_datagram(fd, flags)) return false;
  }
}

// Control data of a message being received; what does not fit is cut, with MSG_CTRUNC.
class Control {
 public:
  explicit Control(msghdr& message) : message_(message), room_(message.msg_controllen) {
    message_.msg_controllen = 0;
  }
  void add(int level, int type, const void* data, std::size_t size) {
    const std::size_t space = CMSG_SPACE(size);
    if (message_.msg_control == nullptr || message_.msg_controllen + space > room_) {
      message_.msg_flags |= MSG_CTRUNC;
      return;
    }
    auto* head = reinterpret_cast<cmsghdr*>(static_cast<unsigned char*>(message_.msg_control) +
                                            message_.msg_controllen);
    memset(head, 0, space);
    head->cmsg_level = level;
    head->cmsg_type = type;
    head->cmsg_len = CMSG_LEN(size);
    memcpy(CMSG_DATA(head), data, size);
    message_.msg_controllen += space;
  }

 private:
  msghdr& message_;
  std::size_t room_;
};

timespec stamp_of(std::int64_t ns) { return ns == kNoStamp ? timespec{} : to_timespec(ns); }

// The stamps as SO_TIMESTAMPING has them: those that it was asked to report.
void add_stamps(const SocketState& state, bool is_error, Control& control) {
  const Arrival& arrival = datagram.arrival;
  const bool by_software = (state.timestamping & SOF_TIMESTAMPING_SOFTWARE) != 0;
  const bool by_card = (state.timestamping & SOF_TIMESTAMPING_RAW_HARDWARE) != 0;
  const timespec stamps[3] = {stamp_of(by_software ? arrival.system : kNoStamp),
                              {},
                              stamp_of(by_card ? arrival.hardware : kNoStamp)};
  if (stamps[0].tv_sec == 0 && stamps[2].tv_sec == 0) return;
  control.add(SOL_SOCKET, SCM_TIMESTAMPING, stamps, sizeof stamps);
  const bool wants_packet = (state.timestamping & SOF_TIMESTAMPING_OPT_PKTINFO) != 0;
  if (is_error || stamps[2].tv_sec == 0 || !wants_packet) return;
  scm_ts_pktinfo packet{};
  packet.if_index = kInterface;
  packet.pkt_length = static_cast<std::uint32_t>(kPacketHeads + arrival.length);
  control.add(SOL_SOCKET, SCM_TIMESTAMPING_PKTINFO, &packet, sizeof packet);
}

void add_older_stamp(const SocketState& state, Control& control) {
  if (datagram.arrival.system == kNoStamp) return;
  const timespec stamp = stamp_of(datagram.arrival.system);
  if (state.stamps == Stamps::kTimeval) {
    const timeval rounded{.tv_sec = stamp.tv_sec, .tv_usec = stamp.tv_nsec / 1000};
    control.add(SOL_SOCKET, SCM_TIMESTAMP, &rounded, sizeof rounded);
  } else if (state.stamps == Stamps::kTimespec) {
    control.add(SOL_SOCKET, SCM_TIMESTAMPNS, &stamp, sizeof stamp);
  }
}

void add_error(const SocketState& state, Control& control) {
  sock_extended_err error{};
  error.ee_errno = ENOMSG;
  error.ee_origin = SO_EE_ORIGIN_TIMESTAMPING;
  error.ee_info = SCM_TSTAMP_SND;
  if ((state.timestamping & SOF_TIMESTAMPING_OPT_ID) != 0) {
    error.ee_data = datagram.arrival.number - state.first_number;
  }
  control.add(IPPROTO_IP, IP_RECVERR, &error, sizeof error);
}

void add_destination(bool is_error, Control& control) {
  in_pktinfo to{};
  to.ipi_ifindex = kInterface;
  to.ipi_spec_dst.s_addr = htonl(identity().address);
  to.ipi_addr.s_addr = htonl(is_error ? identity().address : datagram.arrival.to.host);
  control.add(IPPROTO_IP, IP_PKTINFO, &to, sizeof to);
}

ssize_t receive_message(int fd, msghdr& message, int flags) {
  if (!take_datagram(fd, flags)) return -1;
  const unsigned char* bytes = datagram.bytes + datagram.begin;
  const std::size_t copied = scatter(bytes, datagram.size, message);
  const bool is_error = (flags & MSG_ERRQUEUE) != 0;
  message.msg_flags = (copied < datagram.size ? MSG_TRUNC : 0) | (is_error ? MSG_ERRQUEUE : 0);
  write_address(is_error ? datagram.arrival.to : datagram.arrival.from,
                static_cast<sockaddr*>(message.msg_name), &message.msg_namelen);
  Control control(message);
  const SocketState& state = state_of(fd);
  if (!is_error) add_older_stamp(state, control);
  add_stamps(state, is_error, control);
  if (is_error) add_error(state, control);
  if (state.wants_destination) add_destination(is_error, control);
  return static_cast<ssize_t>((flags & MSG_TRUNC) != 0 ? datagram.size : copied);
}

// What this departure alone is stamped by; -1 if the message does not say.
std::int64_t stamps_asked_for(int fd, const msghdr& message) {
  constexpr unsigned kTransmit = SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_TX_HARDWARE;
  auto& readable = const_cast<msghdr&>(message);
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&readable, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SO_TIMESTAMPING) continue;
    unsigned flags = 0;
    memcpy(&flags, CMSG_DATA(each), sizeof flags);
    return departure_stamps((state_of(fd).timestamping & ~kTransmit) | (flags & kTransmit));
  }
  return -1;
}

ssize_t send_message(int fd, const msghdr& message) {
  static unsigned char payload[kMostData - sizeof(Address)];
  Address to{};
  if (message.msg_name != nullptr &&
      !read_address(static_cast<const sockaddr*>(message.msg_name), message.msg_namelen, to)) {
    return -1;
  }
  const ssize_t size = gather(message, payload, sizeof payload);
  if (size < 0) return -1;
  const Sent content{payload, static_cast<std::size_t>(size)};
  const Request request{.call = Call::kSend, .fd = fd, .a = stamps_asked_for(fd, message)};
  return ask(request, {&to, sizeof to}, content) < 0 ? -1 : size;
}

int name_of(int fd, Call call, sockaddr* name, socklen_t* size) {
  Address address{};
  if (ask_for({.call = call, .fd = fd}, address) < 0) return -1;
  write_address(address, name, size);
  return 0;
}

// What goes through sendmsg() and recvmsg() is not: the world's, routing and local sockets.
bool is_real(int fd) {
  return !is_socket(fd) && !is_stream(fd) && !is_netlink(fd) && !is_local(fd);
}

}  // namespace

SIMBENCH_CALL int socket(int domain, int type, int protocol) {
  if (!is_simulated()) return SIMBENCH_REAL(socket)(domain, type, protocol);
  if (domain == AF_UNIX) return local_socket(domain, type, protocol);
  if (domain == AF_NETLINK) return open_netlink(type, protocol);
  const int kind = type & ~(SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (domain != AF_INET || (kind != SOCK_DGRAM && kind != SOCK_STREAM)) {
    return refuse(domain == AF_INET ? EPROTONOSUPPORT : EAFNOSUPPORT);
  }
  const int fd = open_descriptor(kind == SOCK_STREAM ? Kind::kStream : Kind::kSocket,
                                 (type & SOCK_NONBLOCK) != 0, (type & SOCK_CLOEXEC) != 0);
  if (fd < 0) return -1;
  state_of(fd) = {.type = kind};
  if (ask({.call = Call::kOpenSocket, .fd = fd, .a = kind}) < 0) {
    discard_descriptor(fd);
    return -1;
  }
  return fd;
}

SIMBENCH_CALL int bind(int fd, const sockaddr* name, socklen_t size) {
  if (is_local(fd)) return local_bind(fd, name, size);
  if (is_netlink(fd)) return 0;
  if (!is_socket(fd) && !is_stream(fd)) return SIMBENCH_REAL(bind)(fd, name, size);
  Address address{};
  if (!read_address(name, size, address)) return -1;
  return static_cast<int>(ask({.call = Call::kBind, .fd = fd}, {&address, sizeof address}));
}

SIMBENCH_CALL int connect(int fd, const sockaddr* name, socklen_t size) {
  if (is_local(fd)) return local_connect(fd, name, size);
  if (!is_socket(fd) && !is_stream(fd)) return SIMBENCH_REAL(connect)(fd, name, size);
  Address address{};
  if (!read_address(name, size, address)) return -1;
  if (is_stream(fd)) return stream_connect(fd, address);
  return static_cast<int>(ask({.call = Call::kConnect, .fd = fd}, {&address, sizeof address}));
}

SIMBENCH_CALL int getsockname(int fd, sockaddr* name, socklen_t* size) {
  if (is_netlink(fd)) return netlink_name(name, size);
  if (!is_socket(fd) && !is_stream(fd)) return SIMBENCH_REAL(getsockname)(fd, name, size);
  return name_of(fd, Call::kName, name, size);
}

SIMBENCH_CALL int getpeername(int fd, sockaddr* name, socklen_t* size) {
  if (!is_socket(fd) && !is_stream(fd)) return SIMBENCH_REAL(getpeername)(fd, name, size);
  return name_of(fd, Call::kPeerName, name, size);
}

SIMBENCH_CALL ssize_t sendmsg(int fd, const msghdr* message, int flags) {
  if (is_local(fd)) return local_sendmsg(fd, message, flags);
  if (is_stream(fd)) return stream_send(fd, *message, flags);
  if (is_netlink(fd)) return netlink_send(fd, *message);
  if (!is_socket(fd)) return SIMBENCH_REAL(sendmsg)(fd, message, flags);
  return send_message(fd, *message);
}

SIMBENCH_CALL int sendmmsg(int fd, mmsghdr* messages, unsigned int count, int flags) {
  if (!is_socket(fd)) return SIMBENCH_REAL(sendmmsg)(fd, messages, count, flags);
  for (unsigned int i = 0; i < count; ++i) {
    const ssize_t sent = send_message(fd, messages[i].msg_hdr);
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
  return receive_message(fd, *message, flags);
}

SIMBENCH_CALL int recvmmsg(int fd, mmsghdr* messages, unsigned int count, int flags,
                           timespec* timeout) {
  if (!is_socket(fd) && !is_local(fd)) {
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

// Options of the simulated network's sockets: stamps, sharing of ports, groups.
#include <arpa/inet.h>
#include <errno.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "shim/local.h"
#include "shim/netlink.h"
#include "shim/sockets.h"
#include "shim/streams.h"

namespace simbench::shim {
namespace {

SocketState states[kMostDescriptors];  // by number

int set_world_option(int fd, SocketOption option, std::int64_t value) {
  return static_cast<int>(ask(
      {.call = Call::kSetOption, .fd = fd, .a = static_cast<std::int64_t>(option), .b = value}));
}

std::int64_t kinds_of(unsigned flags, unsigned software, unsigned hardware) {
  const bool by_software = (flags & SOF_TIMESTAMPING_SOFTWARE) != 0 && (flags & software) != 0;
  const bool by_card = (flags & SOF_TIMESTAMPING_RAW_HARDWARE) != 0 && (flags & hardware) != 0;
  return (by_software ? std::int64_t{kSoftwareStamps} : 0) |
         (by_card ? std::int64_t{kHardwareStamps} : 0);
}

int set_arrival_stamps(int fd) {
  std::int64_t kinds = kinds_of(state_of(fd).timestamping, SOF_TIMESTAMPING_RX_SOFTWARE,
                                SOF_TIMESTAMPING_RX_HARDWARE);
  if (state_of(fd).stamps != Stamps::kNone) kinds |= kSoftwareStamps;
  return set_world_option(fd, SocketOption::kReceiveStamps, kinds);
}

int set_stamps(int fd, Stamps stamps, int value) {
  state_of(fd).stamps = value != 0 ? stamps : Stamps::kNone;
  return set_arrival_stamps(fd);
}

int set_timestamping(int fd, int value) {
  const auto flags = static_cast<unsigned>(value);
  const bool counts_anew = (flags & ~state_of(fd).timestamping & SOF_TIMESTAMPING_OPT_ID) != 0;
  state_of(fd).timestamping = flags;
  const std::int64_t sent =
      set_world_option(fd, SocketOption::kTransmitStamps, departure_stamps(flags));
  if (sent < 0) return -1;
  if (counts_anew) state_of(fd).first_number = static_cast<std::uint32_t>(sent);
  return set_arrival_stamps(fd);
}

int set_receive_timeout(int fd, const void* value, socklen_t size) {
  timeval timeout{};
  if (size < sizeof timeout) return refuse(EINVAL);
  memcpy(&timeout, value, sizeof timeout);
  const std::int64_t ns = timeout.tv_sec * kSecond + timeout.tv_usec * 1000;
  state_of(fd).timeout_ns = ns == 0 ? -1 : ns;
  return 0;
}

int set_socket_option(int fd, int option, const void* value, socklen_t size) {
  if (option == SO_RCVTIMEO_OLD) return set_receive_timeout(fd, value, size);
  if (option == SO_BINDTODEVICE) return 0;  // there is one, beside the loopback
  int number = 0;
  if (size < sizeof number) return refuse(EINVAL);
  memcpy(&number, value, sizeof number);
  switch (option) {
    case SO_TIMESTAMP_OLD:
      return set_stamps(fd, Stamps::kTimeval, number);
    case SO_TIMESTAMPNS_OLD:
      return set_stamps(fd, Stamps::kTimespec, number);
    case SO_TIMESTAMPING_OLD:
      return set_timestamping(fd, number);
    case SO_REUSEADDR:
    case SO_REUSEPORT:
      state_of(fd).shares_port = number != 0;
      return set_world_option(fd, SocketOption::kReuseAddress, number);
    case SO_BROADCAST:
      state_of(fd).may_broadcast = number != 0;
      return set_world_option(fd, SocketOption::kBroadcast, number);
    case SO_SELECT_ERR_QUEUE:
      return set_world_option(fd, SocketOption::kUrgentErrors, number);
    case SO_PRIORITY:
    case SO_RCVBUF:
    case SO_SNDBUF:
    case SO_SNDTIMEO_OLD:
    case SO_KEEPALIVE:
    case SO_LINGER:
    case SO_BUSY_POLL:
      return 0;  // nothing that a message of the simulated network would notice
    default:
      return refuse(ENOPROTOOPT);
  }
}

// The interface that a request about a group names, by number or by address; -1 if there is none.
int interface_of(int number, std::uint32_t host) {
  const bool is_known = number == 0 || number == kInterface;
  const bool is_own = host == INADDR_ANY || host == identity().address;
  return is_known && (number != 0 || is_own) ? kInterface : -1;
}

// struct ip_mreq has the first two members.
bool read_membership(const void* value, socklen_t size, ip_mreqn& membership) {
  membership = {};
  if (size < sizeof(ip_mreq)) return false;
  memcpy(&membership, value, size < sizeof membership ? sizeof(ip_mreq) : sizeof membership);
  return true;
}

int set_membership(int fd, bool joins, const void* value, socklen_t size) {
  ip_mreqn membership{};
  if (!read_membership(value, size, membership)) return refuse(EINVAL);
  if (interface_of(membership.imr_ifindex, ntohl(membership.imr_address.s_addr)) < 0) {
    return refuse(ENODEV);
  }
  return static_cast<int>(ask({.call = Call::kJoin,
                               .fd = fd,
                               .a = joins ? 1 : 0,
                               .b = ntohl(membership.imr_multiaddr.s_addr)}));
}

// Where multicasts leave: the one interface.
int set_group_interface(const void* value, socklen_t size) {
  ip_mreqn wanted{};
  if (size >= sizeof(ip_mreq)) {
    read_membership(value, size, wanted);
  } else if (size >= sizeof(in_addr)) {
    memcpy(&wanted.imr_address, value, sizeof(in_addr));
  } else {
    return refuse(EINVAL);
  }
  const int found = interface_of(wanted.imr_ifindex, ntohl(wanted.imr_address.s_addr));
  return found < 0 ? refuse(EADDRNOTAVAIL) : 0;
}

int set_ip_option(int fd, int option, const void* value, socklen_t size) {
  switch (option) {
    case IP_ADD_MEMBERSHIP:
      return set_membership(fd, true, value, size);
    case IP_DROP_MEMBERSHIP:
      return set_membership(fd, false, value, size);
    case IP_MULTICAST_IF:
      return set_group_interface(value, size);
    default:
      break;
  }
  int number = 0;
  if (size >= sizeof number) {
    memcpy(&number, value, sizeof number);
  } else if (size >= 1) {
    number = *static_cast<const unsigned char*>(value);
  }
  switch (option) {
    case IP_PKTINFO:
      state_of(fd).wants_destination = number != 0;
      return 0;
    case IP_MULTICAST_LOOP:
      return set_world_option(fd, SocketOption::kLoopGroups, number);
    case IP_MULTICAST_ALL:
      return set_world_option(fd, SocketOption::kAllGroups, number);
    case IP_TOS:
    case IP_TTL:
    case IP_MULTICAST_TTL:
    case IP_RECVERR:
    case IP_RECVTTL:
    case IP_MTU_DISCOVER:
    case IP_FREEBIND:
      return 0;  // nothing that a message of the simulated network would notice
    default:
      return refuse(ENOPROTOOPT);
  }
}

// A connection's Nagle is the scenario's; its port is free as soon as it is closed.
int set_stream_option(int fd, int level, int option, const void* value, socklen_t size) {
  if (level == SOL_SOCKET && option == SO_RCVTIMEO_OLD) {
    return set_receive_timeout(fd, value, size);
  }
  if (level != SOL_SOCKET && level != IPPROTO_TCP && level != IPPROTO_IP) {
    return refuse(ENOPROTOOPT);
  }
  if (level == SOL_SOCKET && option == SO_REUSEADDR && size >= sizeof(int)) {
    int number = 0;
    memcpy(&number, value, sizeof number);
    state_of(fd).shares_port = number != 0;
  }
  return 0;
}

int get_socket_option(int fd, int option) {
  const SocketState& state = state_of(fd);
  switch (option) {
    case SO_TYPE:
      return state.type;
    case SO_DOMAIN:
      return AF_INET;
    case SO_PROTOCOL:
      return state.type == SOCK_STREAM ? IPPROTO_TCP : IPPROTO_UDP;
    case SO_REUSEADDR:
      return state.shares_port ? 1 : 0;
    case SO_BROADCAST:
      return state.may_broadcast ? 1 : 0;
    case SO_TIMESTAMPING_OLD:
      return static_cast<int>(state.timestamping);
    case SO_ERROR:
      return static_cast<int>(ask({.call = Call::kSocketError, .fd = fd}));
    case SO_RCVBUF:
    case SO_SNDBUF:
      return 212'992;
    default:
      return 0;
  }
}

}  // namespace

bool is_socket(int fd) { return kind_of(fd) == Kind::kSocket; }

std::int64_t departure_stamps(unsigned flags) {
  const std::int64_t kinds =
      kinds_of(flags, SOF_TIMESTAMPING_TX_SOFTWARE, SOF_TIMESTAMPING_TX_HARDWARE);
  const bool wants_both = kinds != 0 && (flags & SOF_TIMESTAMPING_OPT_TX_SWHW) != 0;
  return wants_both ? kinds | kBothStamps : kinds;
}

SocketState& state_of(int fd) { return states[number_of(fd)]; }

SIMBENCH_CALL int setsockopt(int fd, int level, int option, const void* value, socklen_t size) {
  if (is_netlink(fd)) return 0;
  if (is_stream(fd)) return set_stream_option(fd, level, option, value, size);
  if (!is_socket(fd)) return SIMBENCH_REAL(setsockopt)(fd, level, option, value, size);
  if (level == SOL_SOCKET) return set_socket_option(fd, option, value, size);
  if (level == IPPROTO_IP) return set_ip_option(fd, option, value, size);
  return refuse(ENOPROTOOPT);
}

SIMBENCH_CALL int getsockopt(int fd, int level, int option, void* value, socklen_t* size) {
  if (!is_socket(fd) && !is_stream(fd)) {
    return local_getsockopt(fd, level, option, value, size);
  }
  const int number = level == SOL_SOCKET ? get_socket_option(fd, option) : 0;
  memcpy(value, &number, *size < sizeof number ? *size : sizeof number);
  *size = sizeof number;
  return 0;
}

}  // namespace simbench::shim

// Options of the simulated network's sockets. Those that are numbers are in shim/option_table.h;
// here are the rest: stamps, times, groups, interfaces and filters.
#include <arpa/inet.h>
#include <errno.h>
#include <linux/filter.h>
#include <linux/if_packet.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "shim/interfaces.h"
#include "shim/local.h"
#include "shim/netlink.h"
#include "shim/option_table.h"
#include "shim/socket_groups.h"
#include "shim/sockets.h"
#include "shim/streams.h"

namespace simbench::shim {
namespace {

// Options that are numbers, by socket and rule. What is not set has what it began with.
struct Numbers {
  bool is_set[kMostOptionRules];
  int values[kMostOptionRules];
};
SocketState states[kMostDescriptors];  // by number
Numbers numbers[kMostDescriptors];

std::uint8_t owner_of(int fd) {
  if (is_netlink(fd)) return kOfNetlink;
  const int family = family_of(fd);
  if (family == AF_PACKET) return kOfPackets;
  if (is_stream(fd)) return family == AF_INET6 ? kOfTcp6 : kOfTcp4;
  return family == AF_INET6 ? kOfUdp6 : kOfUdp4;
}

int tell_world(int fd, SocketOption option, std::int64_t value, bool is_of_ipv6 = false) {
  const std::int64_t named = static_cast<std::int64_t>(option) | (is_of_ipv6 ? kOfIpv6 : 0);
  return ask({.call = Call::kSetOption, .fd = fd, .a = named, .b = value}) < 0 ? -1 : 0;
}

// Stamps.

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
  return tell_world(fd, SocketOption::kReceiveStamps, kinds);
}

int set_stamps(int fd, Stamps stamps, int value) {
  state_of(fd).stamps = value != 0 ? stamps : Stamps::kNone;
  return is_socket(fd) ? set_arrival_stamps(fd) : 0;
}

int set_timestamping(int fd, int value) {
  const auto flags = static_cast<unsigned>(value);
  if ((flags & ~unsigned{SOF_TIMESTAMPING_MASK}) != 0) return refuse(EINVAL);
  const bool counts_anew = (flags & ~state_of(fd).timestamping & SOF_TIMESTAMPING_OPT_ID) != 0;
  state_of(fd).timestamping = flags;
  if (!is_socket(fd)) return 0;
  const std::int64_t sent = ask({.call = Call::kSetOption,
                                 .fd = fd,
                                 .a = static_cast<std::int64_t>(SocketOption::kTransmitStamps),
                                 .b = departure_stamps(flags)});
  if (sent < 0) return -1;
  if (counts_anew) state_of(fd).first_number = static_cast<std::uint32_t>(sent);
  return set_arrival_stamps(fd);
}

// Times.

int set_timeout(std::int64_t& timeout_ns, const void* value, socklen_t size) {
  timeval timeout{};
  if (size < sizeof timeout) return refuse(EINVAL);
  memcpy(&timeout, value, sizeof timeout);
  if (timeout.tv_usec < 0 || timeout.tv_usec >= 1'000'000) return refuse(EDOM);
  const timespec time{.tv_sec = timeout.tv_sec, .tv_nsec = timeout.tv_usec * 1000};
  const std::int64_t ns = timeout.tv_sec < 0 ? 0 : nanoseconds(time);
  timeout_ns = ns == 0 ? -1 : ns;
  return 0;
}

timeval as_timeval(std::int64_t timeout_ns) {
  if (timeout_ns < 0) return {};
  return {.tv_sec = timeout_ns / kSecond, .tv_usec = timeout_ns % kSecond / 1000};
}

// Interfaces.

int bind_to_interface(int fd, std::uint32_t number) {
  state_of(fd).interface = number;
  if (is_netlink(fd) || family_of(fd) == AF_PACKET) return 0;  // which bind() does for them
  return tell_world(fd, SocketOption::kInterface, number);
}

int bind_to_device(int fd, const void* value, socklen_t size) {
  char name[IFNAMSIZ] = "";
  memcpy(name, value, size < sizeof name - 1 ? size : sizeof name - 1);
  if (name[0] == '\0') return bind_to_interface(fd, 0);
  InterfaceFacts found{};
  return find_interface(name, found) ? bind_to_interface(fd, found.index) : -1;
}

// Filters.

int attach_filter(int fd, const void* value, socklen_t size) {
  sock_fprog program{};
  if (!is_socket(fd)) return 0;  // what a connection's filter would see is not simulated
  if (size != sizeof program) return refuse(EINVAL);
  memcpy(&program, value, sizeof program);
  if (program.filter == nullptr || program.len == 0) return refuse(EINVAL);
  return static_cast<int>(ask({.call = Call::kFilterArrivals, .fd = fd},
                              {program.filter, program.len * sizeof(sock_filter)}));
}

int detach_filter(int fd) {
  if (!is_socket(fd)) return 0;
  return static_cast<int>(ask({.call = Call::kFilterArrivals, .fd = fd}));
}

int set_linger(const void* value, socklen_t size, linger& kept) {
  if (size < sizeof kept) return refuse(EINVAL);
  memcpy(&kept, value, sizeof kept);
  kept.l_onoff = kept.l_onoff != 0 ? 1 : 0;
  return 0;
}

// Options of the level SOL_SOCKET that are not of the table; kIsNone for others.
int set_socket_option(int fd, int option, const void* value, socklen_t size) {
  SocketState& state = state_of(fd);
  switch (option) {
    case SO_RCVTIMEO_OLD:
      return set_timeout(state.timeout_ns, value, size);
    case SO_SNDTIMEO_OLD:
      return set_timeout(state.send_timeout_ns, value, size);
    case SO_BINDTODEVICE:
      return bind_to_device(fd, value, size);
    case SO_LINGER:
      return set_linger(value, size, state.linger);
    case SO_ATTACH_FILTER:
      return attach_filter(fd, value, size);
    case SO_DETACH_FILTER:
      return detach_filter(fd);
    default:
      break;
  }
  int number = 0;
  const bool is_stamping =
      option == SO_TIMESTAMP_OLD || option == SO_TIMESTAMPNS_OLD || option == SO_TIMESTAMPING_OLD;
  if (!is_stamping) return kIsNone;
  if (size < sizeof number) return refuse(EINVAL);
  memcpy(&number, value, sizeof number);
  if (option == SO_TIMESTAMPING_OLD) return set_timestamping(fd, number);
  return set_stamps(fd, option == SO_TIMESTAMP_OLD ? Stamps::kTimeval : Stamps::kTimespec, number);
}

// Options of the table.

// The number that an option of this rule has after it was set to `value`; false with EINVAL.
bool admit(const OptionRule& rule, int value, int& kept) {
  kept = value;
  switch (rule.form) {
    case OptionForm::kSwitch:
      kept = value != 0 ? 1 : 0;
      return true;
    case OptionForm::kRoom: {
      const int most = rule.most / 2;
      const int twice = 2 * (value < 0 || value > most ? most : value);
      kept = twice < rule.least ? rule.least : twice;
      return true;
    }
    case OptionForm::kByte:
      kept = value & 0xFF;
      return true;
    case OptionForm::kDefault:
      if (value == -1) kept = rule.initial;
      break;
    case OptionForm::kNumber:
      break;
  }
  const bool is_good = kept >= rule.least && kept <= rule.most;
  if (!is_good) errno = EINVAL;
  return is_good;
}

int wanted_number(int level, const void* value, socklen_t size) {
  int number = 0;
  if (size >= sizeof number) {
    memcpy(&number, value, sizeof number);
  } else if (size >= 1 && level == IPPROTO_IP) {
    number = *static_cast<const unsigned char*>(value);
  }
  return number;
}

// A connection's port is free as soon as it is closed, and it has no stamps of its departures.
bool is_for_world(int fd, const OptionRule& rule) {
  if (!rule.is_told || is_netlink(fd)) return false;
  return is_socket(fd) || rule.as == SocketOption::kOnlyIpv6;
}

int set_number(int fd, const OptionRule& rule, int value) {
  int kept = 0;
  if (!admit(rule, value, kept)) return -1;
  const bool is_of_ipv6 = rule.level == IPPROTO_IPV6;
  if (is_for_world(fd, rule) && tell_world(fd, rule.as, kept, is_of_ipv6) < 0) return -1;
  Numbers& known = numbers[number_of(fd)];
  known.is_set[place_of(rule)] = true;
  known.values[place_of(rule)] = kept;
  return 0;
}

// What a socket is, and how it fares; kIsNone for other options.
std::int64_t fact_of(int fd, int option) {
  switch (option) {
    case SO_TYPE:
      return is_stream(fd) ? SOCK_STREAM : state_of(fd).type;
    case SO_DOMAIN:
      return is_netlink(fd) ? AF_NETLINK : family_of(fd);
    case SO_PROTOCOL:
      return is_stream(fd) ? IPPROTO_TCP : state_of(fd).protocol;
    case SO_ERROR:
      return is_netlink(fd) ? 0 : ask({.call = Call::kSocketError, .fd = fd});
    case SO_ACCEPTCONN:
      return state_of(fd).listens ? 1 : 0;
    case SO_TIMESTAMP_OLD:
      return state_of(fd).stamps == Stamps::kTimeval ? 1 : 0;
    case SO_TIMESTAMPNS_OLD:
      return state_of(fd).stamps == Stamps::kTimespec ? 1 : 0;
    case SO_BINDTOIFINDEX:
      return state_of(fd).interface;
    default:
      return -1;
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

int family_of(int fd) {
  SocketState& state = state_of(fd);
  if (state.family != 0) return state.family;
  Address own{};
  if (ask_for({.call = Call::kName, .fd = fd}, own) < 0) return AF_INET;
  return state.family = own.family;
}

void forget_options(int fd) { memset(&numbers[number_of(fd)], 0, sizeof(Numbers)); }

int option_of(int fd, int level, int option) {
  const OptionRule* rule = find_rule(owner_of(fd), level, option);
  if (rule == nullptr) return 0;
  const Numbers& known = numbers[number_of(fd)];
  const int place = place_of(*rule);
  return known.is_set[place] ? known.values[place] : rule->initial;
}

SIMBENCH_CALL int setsockopt(int fd, int level, int option, const void* value, socklen_t size) {
  if (!is_of_network(fd) && !is_netlink(fd)) {
    return SIMBENCH_REAL(setsockopt)(fd, level, option, value, size);
  }
  if (is_netlink(fd) && level == SOL_NETLINK) return 0;
  const int result = level == SOL_SOCKET ? set_socket_option(fd, option, value, size)
                     : is_netlink(fd)    ? kIsNone
                                         : set_group_option(fd, level, option, value, size);
  if (result != kIsNone) return result;
  // With the right to pass a limit that there is not.
  if (level == SOL_SOCKET && option == SO_RCVBUFFORCE) option = SO_RCVBUF;
  if (level == SOL_SOCKET && option == SO_SNDBUFFORCE) option = SO_SNDBUF;
  const OptionRule* rule = find_rule(owner_of(fd), level, option);
  if (rule == nullptr) return refuse(ENOPROTOOPT);
  if (level != IPPROTO_IP && size < sizeof(int)) return refuse(EINVAL);
  return set_number(fd, *rule, wanted_number(level, value, size));
}

namespace {

int give(const void* found, std::size_t found_size, void* value, socklen_t* size) {
  if (*size > found_size) *size = static_cast<socklen_t>(found_size);
  memcpy(value, found, *size);
  return 0;
}

// Options that are no numbers; kIsNone for others.
int get_special(int fd, int level, int option, void* value, socklen_t* size) {
  const SocketState& state = state_of(fd);
  if (level == SOL_SOCKET) {
    const timeval timeouts[] = {as_timeval(state.timeout_ns), as_timeval(state.send_timeout_ns)};
    InterfaceFacts facts{};
    const int stamping[] = {static_cast<int>(state.timestamping), 0};
    switch (option) {
      case SO_RCVTIMEO_OLD:
        return give(&timeouts[0], sizeof timeouts[0], value, size);
      case SO_SNDTIMEO_OLD:
        return give(&timeouts[1], sizeof timeouts[1], value, size);
      case SO_LINGER:
        return give(&state.linger, sizeof state.linger, value, size);
      case SO_TIMESTAMPING_OLD:
        return give(stamping, sizeof stamping, value, size);
      case SO_BINDTODEVICE:
        if (state.interface == 0) return give("", 0, value, size);
        find_interface(state.interface, facts);
        return give(facts.name, strlen(facts.name) + 1, value, size);
      default:
        return kIsNone;
    }
  }
  if (level == SOL_PACKET && option == PACKET_STATISTICS && family_of(fd) == AF_PACKET) {
    ArrivalCount count{};
    if (ask_for({.call = Call::kCountArrivals, .fd = fd}, count) < 0) return -1;
    const tpacket_stats statistics{.tp_packets = count.arrived, .tp_drops = count.dropped};
    return give(&statistics, sizeof statistics, value, size);
  }
  if (level == IPPROTO_TCP && option == TCP_CONGESTION && is_stream(fd)) {
    constexpr char kName[16] = "cubic";
    return give(kName, sizeof kName, value, size);
  }
  if (level == IPPROTO_TCP && option == TCP_INFO && is_stream(fd)) {
    const tcp_info nothing{};
    return give(&nothing, sizeof nothing, value, size);
  }
  return is_netlink(fd) ? kIsNone : get_group_option(fd, level, option, value, size);
}

// The path's to the peer.
int get_mtu(int fd, int level, int& mtu) {
  Address peer{};
  if (ask_for({.call = Call::kPeerName, .fd = fd}, peer) < 0) return -1;
  const bool is_own = is_loopback(peer.host) || is_own_address(peer.host);
  const std::uint32_t most = level == IPPROTO_IP ? UINT16_MAX : kLoopbackMtu;
  mtu = static_cast<int>(is_own ? most : kLinkMtu);
  return 0;
}

int get_number(int fd, int level, int option, int& number) {
  const bool is_mtu = (level == IPPROTO_IP && option == IP_MTU && family_of(fd) != AF_PACKET) ||
                      (level == IPPROTO_IPV6 && option == IPV6_MTU && family_of(fd) == AF_INET6);
  if (is_mtu) return get_mtu(fd, level, number);
  if (level == SOL_SOCKET) {
    const std::int64_t fact = fact_of(fd, option);
    number = static_cast<int>(fact);
    if (fact >= 0) return 0;
  }
  if (find_rule(owner_of(fd), level, option) == nullptr) return refuse(ENOPROTOOPT);
  number = option_of(fd, level, option);
  return 0;
}

}  // namespace

SIMBENCH_CALL int getsockopt(int fd, int level, int option, void* value, socklen_t* size) {
  if (!is_of_network(fd) && !is_netlink(fd)) {
    return local_getsockopt(fd, level, option, value, size);
  }
  const int special = get_special(fd, level, option, value, size);
  if (special != kIsNone) return special;
  int number = 0;
  if (get_number(fd, level, option, number) < 0) return -1;
  return give(&number, sizeof number, value, size);
}

}  // namespace simbench::shim

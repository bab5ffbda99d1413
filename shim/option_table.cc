#include "shim/option_table.h"

#include <limits.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace simbench::shim {
namespace {

// What the kernel's headers have and libc's may not.
constexpr int kMulticastAll6 = 29;
constexpr int kPacketIgnoreOutgoing = 23;
constexpr int kMostBuffer = 425'984;

constexpr OptionRule number(int level, int option, std::uint8_t owners, int initial, int least,
                            int most) {
  return {level, option, owners, OptionForm::kNumber, initial, least, most, false, {}};
}
constexpr OptionRule any_number(int level, int option, std::uint8_t owners, int initial = 0) {
  return number(level, option, owners, initial, INT_MIN, INT_MAX);
}
constexpr OptionRule toggle(int level, int option, std::uint8_t owners, int initial = 0) {
  return {level, option, owners, OptionForm::kSwitch, initial, 0, 1, false, {}};
}
constexpr OptionRule or_default(int level, int option, std::uint8_t owners, int initial, int least,
                                int most) {
  return {level, option, owners, OptionForm::kDefault, initial, least, most, false, {}};
}
constexpr OptionRule room(int option, std::uint8_t owners, int initial, int least) {
  return {SOL_SOCKET, option, owners, OptionForm::kRoom, initial, least, kMostBuffer, false, {}};
}
constexpr OptionRule known_as(OptionRule rule, SocketOption as) {
  rule.is_told = true;
  rule.as = as;
  return rule;
}

constexpr OptionRule kRules[] = {
    any_number(SOL_SOCKET, SO_DEBUG, kOfAll),
    known_as(toggle(SOL_SOCKET, SO_REUSEADDR, kOfAll), SocketOption::kReuseAddress),
    known_as(toggle(SOL_SOCKET, SO_REUSEPORT, kOfAll), SocketOption::kReuseAddress),
    toggle(SOL_SOCKET, SO_DONTROUTE, kOfAll),
    known_as(toggle(SOL_SOCKET, SO_BROADCAST, kOfAll), SocketOption::kBroadcast),
    room(SO_SNDBUF, kOfDatagrams | kOfNetlink, 212'992, 4'608),
    room(SO_RCVBUF, kOfDatagrams | kOfNetlink, 212'992, 2'304),
    room(SO_SNDBUF, kOfStreams, 16'384, 4'608),
    room(SO_RCVBUF, kOfStreams, 131'072, 2'304),
    toggle(SOL_SOCKET, SO_KEEPALIVE, kOfAll),
    toggle(SOL_SOCKET, SO_OOBINLINE, kOfAll),
    toggle(SOL_SOCKET, SO_NO_CHECK, kOfAll),
    any_number(SOL_SOCKET, SO_PRIORITY, kOfAll),
    any_number(SOL_SOCKET, SO_RCVLOWAT, kOfAll, 1),
    any_number(SOL_SOCKET, SO_MARK, kOfAll),
    toggle(SOL_SOCKET, SO_RXQ_OVFL, kOfAll),
    any_number(SOL_SOCKET, SO_PEEK_OFF, kOfAll, -1),
    toggle(SOL_SOCKET, SO_LOCK_FILTER, kOfAll),
    known_as(toggle(SOL_SOCKET, SO_SELECT_ERR_QUEUE, kOfAll), SocketOption::kUrgentErrors),
    number(SOL_SOCKET, SO_BUSY_POLL, kOfAll, 0, 0, INT_MAX),
    any_number(SOL_SOCKET, SO_INCOMING_CPU, kOfAll, -1),
    number(SOL_SOCKET, SO_ZEROCOPY, kOfIp, 0, 0, 1),

    known_as({IPPROTO_IP, IP_TOS, kOfIp, OptionForm::kByte, 0, 0, 255, false, {}},
             SocketOption::kTrafficClass),
    known_as(or_default(IPPROTO_IP, IP_TTL, kOfIp, 64, 1, 255), SocketOption::kHops),
    toggle(IPPROTO_IP, IP_RECVOPTS, kOfIp),
    toggle(IPPROTO_IP, IP_RETOPTS, kOfIp),
    toggle(IPPROTO_IP, IP_PKTINFO, kOfIp),
    known_as(number(IPPROTO_IP, IP_MTU_DISCOVER, kOfIp, IP_PMTUDISC_WANT, 0, IP_PMTUDISC_OMIT),
             SocketOption::kMtuDiscovery),
    known_as(toggle(IPPROTO_IP, IP_RECVERR, kOfIp), SocketOption::kReceiveErrors),
    toggle(IPPROTO_IP, IP_RECVTTL, kOfIp),
    toggle(IPPROTO_IP, IP_RECVTOS, kOfIp),
    toggle(IPPROTO_IP, IP_FREEBIND, kOfIp),
    toggle(IPPROTO_IP, IP_TRANSPARENT, kOfIp),
    toggle(IPPROTO_IP, IP_RECVORIGDSTADDR, kOfIp),
    number(IPPROTO_IP, IP_MINTTL, kOfIp, 0, 0, 255),
    toggle(IPPROTO_IP, IP_BIND_ADDRESS_NO_PORT, kOfIp),
    known_as(or_default(IPPROTO_IP, IP_MULTICAST_TTL, kOfIp, 1, 0, 255), SocketOption::kGroupHops),
    known_as(toggle(IPPROTO_IP, IP_MULTICAST_LOOP, kOfIp, 1), SocketOption::kLoopGroups),
    known_as(number(IPPROTO_IP, IP_MULTICAST_ALL, kOfUdp4 | kOfTcp4, 1, 0, 1),
             SocketOption::kAllGroups),
    known_as(number(IPPROTO_IP, IP_MULTICAST_ALL, kOfIpv6Sockets, 0, 0, 1),
             SocketOption::kAllGroups),

    known_as(toggle(IPPROTO_IPV6, IPV6_V6ONLY, kOfIpv6Sockets), SocketOption::kOnlyIpv6),
    known_as(or_default(IPPROTO_IPV6, IPV6_UNICAST_HOPS, kOfIpv6Sockets, 64, 0, 255),
             SocketOption::kHops),
    known_as(or_default(IPPROTO_IPV6, IPV6_MULTICAST_HOPS, kOfIpv6Sockets, 1, 0, 255),
             SocketOption::kGroupHops),
    known_as(number(IPPROTO_IPV6, IPV6_MULTICAST_LOOP, kOfIpv6Sockets, 1, 0, 1),
             SocketOption::kLoopGroups),
    known_as(toggle(IPPROTO_IPV6, kMulticastAll6, kOfIpv6Sockets, 1), SocketOption::kAllGroups),
    known_as(number(IPPROTO_IPV6, IPV6_MTU_DISCOVER, kOfIpv6Sockets, IPV6_PMTUDISC_WANT, 0,
                    IPV6_PMTUDISC_OMIT),
             SocketOption::kMtuDiscovery),
    known_as(toggle(IPPROTO_IPV6, IPV6_DONTFRAG, kOfIpv6Sockets), SocketOption::kDontFragment),
    known_as(toggle(IPPROTO_IPV6, IPV6_RECVERR, kOfIpv6Sockets), SocketOption::kReceiveErrors),
    toggle(IPPROTO_IPV6, IPV6_RECVPKTINFO, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_RECVHOPLIMIT, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_RECVTCLASS, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_RECVRTHDR, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_RECVHOPOPTS, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_RECVDSTOPTS, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_RECVPATHMTU, kOfIpv6Sockets),
    known_as(or_default(IPPROTO_IPV6, IPV6_TCLASS, kOfIpv6Sockets, 0, 0, 255),
             SocketOption::kTrafficClass),
    toggle(IPPROTO_IPV6, IPV6_AUTOFLOWLABEL, kOfIpv6Sockets, 1),
    toggle(IPPROTO_IPV6, IPV6_FREEBIND, kOfIpv6Sockets),
    toggle(IPPROTO_IPV6, IPV6_TRANSPARENT, kOfIpv6Sockets),
    number(IPPROTO_IPV6, IPV6_MINHOPCOUNT, kOfIpv6Sockets, 0, 0, 255),

    toggle(IPPROTO_TCP, TCP_NODELAY, kOfStreams),
    number(IPPROTO_TCP, TCP_MAXSEG, kOfStreams, 536, 0, 32'767),
    toggle(IPPROTO_TCP, TCP_CORK, kOfStreams),
    number(IPPROTO_TCP, TCP_KEEPIDLE, kOfStreams, 7200, 1, 32'767),
    number(IPPROTO_TCP, TCP_KEEPINTVL, kOfStreams, 75, 1, 32'767),
    number(IPPROTO_TCP, TCP_KEEPCNT, kOfStreams, 9, 1, 127),
    number(IPPROTO_TCP, TCP_SYNCNT, kOfStreams, 6, 1, 127),
    any_number(IPPROTO_TCP, TCP_LINGER2, kOfStreams, 60),
    any_number(IPPROTO_TCP, TCP_DEFER_ACCEPT, kOfStreams),
    any_number(IPPROTO_TCP, TCP_WINDOW_CLAMP, kOfStreams),
    toggle(IPPROTO_TCP, TCP_QUICKACK, kOfStreams, 1),
    number(IPPROTO_TCP, TCP_USER_TIMEOUT, kOfStreams, 0, 0, INT_MAX),
    any_number(IPPROTO_TCP, TCP_NOTSENT_LOWAT, kOfStreams),

    toggle(SOL_PACKET, PACKET_AUXDATA, kOfPackets),
    toggle(SOL_PACKET, PACKET_ORIGDEV, kOfPackets),
    any_number(SOL_PACKET, PACKET_TIMESTAMP, kOfPackets),
    known_as(number(SOL_PACKET, kPacketIgnoreOutgoing, kOfPackets, 0, 0, 1),
             SocketOption::kIgnoreOutgoing),
};
static_assert(sizeof kRules / sizeof kRules[0] <= kMostOptionRules);

}  // namespace

const OptionRule* find_rule(std::uint8_t owner, int level, int option) {
  for (const OptionRule& each : kRules) {
    if (each.level == level && each.option == option && (each.owners & owner) != 0) return &each;
  }
  return nullptr;
}

int place_of(const OptionRule& rule) { return static_cast<int>(&rule - kRules); }

}  // namespace simbench::shim

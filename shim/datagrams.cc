// Messages of datagram sockets: what programs say and hear beside the payload.
#include <arpa/inet.h>
#include <errno.h>
#include <linux/errqueue.h>
#include <linux/if_packet.h>
#include <linux/net_tstamp.h>
#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>

#include "shim/sockets.h"

namespace simbench::shim {
namespace {

constexpr std::size_t kLinkHead = 14;
constexpr std::size_t kIpv4Head = 20;
constexpr std::size_t kIpv6Head = 40;
constexpr std::size_t kUdpHead = 8;
constexpr std::size_t kMostHeads = kLinkHead + kIpv6Head + kUdpHead;

bool is_frame(const Arrival& arrival) { return arrival.to.family == AF_PACKET; }

std::size_t size_of_heads(const Arrival& arrival) {
  return kLinkHead + (is_ipv4(arrival.to.host) ? kIpv4Head : kIpv6Head) + kUdpHead;
}

void write_ipv4_head(const Arrival& arrival, unsigned char* ip) {
  const std::uint16_t size =
      htons(static_cast<std::uint16_t>(kIpv4Head + kUdpHead + arrival.length));
  const std::uint32_t hosts[] = {htonl(number_in(arrival.from.host)),
                                 htonl(number_in(arrival.to.host))};
  ip[0] = 0x45;
  ip[1] = arrival.traffic_class;
  memcpy(ip + 2, &size, sizeof size);
  ip[8] = arrival.hops;
  ip[9] = IPPROTO_UDP;
  memcpy(ip + 12, hosts, sizeof hosts);
}

void write_ipv6_head(const Arrival& arrival, unsigned char* ip) {
  const std::uint16_t size = htons(static_cast<std::uint16_t>(kUdpHead + arrival.length));
  ip[0] = static_cast<unsigned char>(0x60 | arrival.traffic_class >> 4);
  ip[1] = static_cast<unsigned char>(arrival.traffic_class << 4);
  memcpy(ip + 4, &size, sizeof size);
  ip[6] = IPPROTO_UDP;
  ip[7] = arrival.hops;
  memcpy(ip + 8, &arrival.from.host, sizeof arrival.from.host);
  memcpy(ip + 24, &arrival.to.host, sizeof arrival.to.host);
}

// The Ethernet addresses between which a packet leaves; none on the loopback.
void write_link_head(const Arrival& arrival, unsigned char* link) {
  if (arrival.interface < kFirstCard) return;
  std::uint8_t card[6] = {};
  write_card_of(arrival.to.host, identity().first_address, card);
  memcpy(link, card, sizeof card);
  write_card_address(identity().address, 0, card);
  memcpy(link + sizeof card, card, sizeof card);
}

// The message of a transmit stamp is the packet as it left: Ethernet, IP, UDP, payload.
void write_heads(const Arrival& arrival, unsigned char* heads) {
  const bool is_by_ipv4 = is_ipv4(arrival.to.host);
  const std::size_t size = size_of_heads(arrival);
  memset(heads, 0, size);
  write_link_head(arrival, heads);
  heads[12] = is_by_ipv4 ? 0x08 : 0x86;
  heads[13] = is_by_ipv4 ? 0x00 : 0xDD;
  (is_by_ipv4 ? write_ipv4_head : write_ipv6_head)(arrival, heads + kLinkHead);
  const std::uint16_t udp[] = {htons(arrival.from.port), htons(arrival.to.port),
                               htons(static_cast<std::uint16_t>(kUdpHead + arrival.length))};
  memcpy(heads + size - kUdpHead, udp, sizeof udp);
}

struct Datagram {
  Arrival arrival{};
  unsigned char bytes[kMostHeads + kMostData] = {};
  std::size_t begin = kMostHeads;  // of the payload, or of the heads before it
  std::size_t size = 0;
};
Datagram datagram;  // the one at hand, from the world's answer to the end of the call

// Waits until there is one, if the call may wait.
bool wait_for_datagram(int fd, bool may_wait) {
  return may_wait && wait_for_input(fd, state_of(fd).timeout_ns);
}

// The next of the socket. 1, 0 if nothing more comes, or -1 with errno.
int take(int fd, int flags) {
  static unsigned char reply_data[sizeof(Arrival) + kMostData];
  const bool is_error = (flags & MSG_ERRQUEUE) != 0;
  const bool may_wait = !is_error && (flags & MSG_DONTWAIT) == 0 && is_blocking(fd);
  const std::int64_t how = (is_error ? std::int64_t{kFromErrorQueue} : 0) |
                           ((flags & MSG_PEEK) != 0 ? std::int64_t{kLeaveIt} : 0) |
                           (may_wait ? std::int64_t{kMayWait} : 0);
  for (;;) {
    Received reply{.data = reply_data, .capacity = sizeof reply_data};
    if (ask({.call = Call::kReceive, .fd = fd, .a = how}, {}, {}, &reply) >= 0) {
      memcpy(&datagram.arrival, reply_data, sizeof(Arrival));
      datagram.size = reply.size - sizeof(Arrival);
      memcpy(datagram.bytes + kMostHeads, reply_data + sizeof(Arrival), datagram.size);
      datagram.begin = kMostHeads;
      return 1;
    }
    if (errno == ESHUTDOWN) return 0;
    if (errno != EAGAIN || !wait_for_datagram(fd, may_wait)) return -1;
  }
}

// What has left comes back as a packet, or as its stamps alone.
void complete_departure(const SocketState& state) {
  if (datagram.arrival.origin != SO_EE_ORIGIN_TIMESTAMPING) return;
  if ((state.timestamping & SOF_TIMESTAMPING_OPT_TSONLY) != 0) {
    datagram.size = 0;
  } else if (!is_frame(datagram.arrival)) {
    const std::size_t heads = size_of_heads(datagram.arrival);
    datagram.begin = kMostHeads - heads;
    datagram.size += heads;
    write_heads(datagram.arrival, datagram.bytes + datagram.begin);
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
  template <class Value>
  void add(int level, int type, const Value& value) {
    add(level, type, &value, sizeof value);
  }

 private:
  msghdr& message_;
  std::size_t room_;
};

timespec stamp_of(std::int64_t ns) { return ns == kNoStamp ? timespec{} : to_timespec(ns); }

// The stamps as SO_TIMESTAMPING has them: those that it was asked to report.
void add_stamps(const SocketState& state, Control& control) {
  const Arrival& arrival = datagram.arrival;
  const bool by_software = (state.timestamping & SOF_TIMESTAMPING_SOFTWARE) != 0;
  const bool by_card = (state.timestamping & SOF_TIMESTAMPING_RAW_HARDWARE) != 0;
  const timespec stamps[3] = {stamp_of(by_software ? arrival.system : kNoStamp),
                              {},
                              stamp_of(by_card ? arrival.hardware : kNoStamp)};
  if (stamps[0].tv_sec == 0 && stamps[2].tv_sec == 0) return;
  control.add(SOL_SOCKET, SCM_TIMESTAMPING, stamps);
  const bool wants_packet = (state.timestamping & SOF_TIMESTAMPING_OPT_PKTINFO) != 0;
  if (arrival.origin != 0 || stamps[2].tv_sec == 0 || !wants_packet) return;
  scm_ts_pktinfo packet{};
  packet.if_index = arrival.interface;
  packet.pkt_length = arrival.length;
  if (!is_frame(arrival)) packet.pkt_length += static_cast<std::uint32_t>(size_of_heads(arrival));
  control.add(SOL_SOCKET, SCM_TIMESTAMPING_PKTINFO, packet);
}

void add_older_stamp(const SocketState& state, Control& control) {
  if (datagram.arrival.system == kNoStamp) return;
  const timespec stamp = stamp_of(datagram.arrival.system);
  if (state.stamps == Stamps::kTimeval) {
    const timeval rounded{.tv_sec = stamp.tv_sec, .tv_usec = stamp.tv_nsec / 1000};
    control.add(SOL_SOCKET, SCM_TIMESTAMP, rounded);
  } else if (state.stamps == Stamps::kTimespec) {
    control.add(SOL_SOCKET, SCM_TIMESTAMPNS, stamp);
  }
}

bool is_refusal() {
  return datagram.arrival.origin == SO_EE_ORIGIN_ICMP ||
         datagram.arrival.origin == SO_EE_ORIGIN_ICMP6;
}

bool has_left() { return datagram.arrival.origin == SO_EE_ORIGIN_TIMESTAMPING; }

// The addresses of the packet that has come, or has left; a refusal came to where its datagram is
// from.
in_pktinfo ipv4_facts() {
  const Arrival& arrival = datagram.arrival;
  const std::uint32_t from = htonl(number_in(arrival.from.host));
  const std::uint32_t to = htonl(number_in(arrival.to.host));
  in_pktinfo facts{};
  facts.ipi_ifindex = static_cast<int>(arrival.interface);
  facts.ipi_addr.s_addr = is_refusal() ? from : to;
  if (has_left()) {
    facts.ipi_spec_dst.s_addr = from;
  } else if (!is_refusal()) {
    facts.ipi_spec_dst.s_addr = is_group(arrival.to.host) ? htonl(identity().address) : to;
  }
  return facts;
}

void add_ipv4_facts(int fd, Control& control) {
  const Arrival& arrival = datagram.arrival;
  if (option_of(fd, IPPROTO_IP, IP_PKTINFO) != 0) {
    control.add(IPPROTO_IP, IP_PKTINFO, ipv4_facts());
  }
  if (option_of(fd, IPPROTO_IP, IP_RECVTTL) != 0) {
    control.add(IPPROTO_IP, IP_TTL, int{arrival.hops});
  }
  if (option_of(fd, IPPROTO_IP, IP_RECVTOS) != 0) {
    control.add(IPPROTO_IP, IP_TOS, arrival.traffic_class);
  }
}

void add_ipv6_facts(int fd, Control& control) {
  const Arrival& arrival = datagram.arrival;
  if (option_of(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO) != 0) {
    in6_pktinfo to{};
    const IpAddress& host = is_refusal() ? arrival.from.host : arrival.to.host;
    memcpy(&to.ipi6_addr, &host, sizeof to.ipi6_addr);
    to.ipi6_ifindex = arrival.interface;
    control.add(IPPROTO_IPV6, IPV6_PKTINFO, to);
  }
  if (is_ipv4(arrival.to.host)) return add_ipv4_facts(fd, control);
  if (option_of(fd, IPPROTO_IPV6, IPV6_RECVHOPLIMIT) != 0) {
    control.add(IPPROTO_IPV6, IPV6_HOPLIMIT, int{arrival.hops});
  }
  if (option_of(fd, IPPROTO_IPV6, IPV6_RECVTCLASS) != 0) {
    control.add(IPPROTO_IPV6, IPV6_TCLASS, int{arrival.traffic_class});
  }
}

void add_frame_facts(int fd, Control& control) {
  if (option_of(fd, SOL_PACKET, PACKET_AUXDATA) == 0) return;
  tpacket_auxdata facts{};
  facts.tp_status = TP_STATUS_USER;
  facts.tp_len = datagram.arrival.info;
  facts.tp_snaplen = datagram.arrival.length;
  facts.tp_net = state_of(fd).type == SOCK_RAW ? std::uint16_t{kLinkHead} : std::uint16_t{0};
  control.add(SOL_PACKET, PACKET_AUXDATA, facts);
}

void add_facts(int fd, Control& control) {
  switch (family_of(fd)) {
    case AF_PACKET:
      return add_frame_facts(fd, control);
    case AF_INET6:
      return add_ipv6_facts(fd, control);
    default:
      return add_ipv4_facts(fd, control);
  }
}

sock_extended_err error_of(const SocketState& state) {
  const Arrival& arrival = datagram.arrival;
  sock_extended_err error{};
  error.ee_errno = arrival.error;
  error.ee_origin = arrival.origin;
  error.ee_info = arrival.info;
  if (arrival.origin == SO_EE_ORIGIN_TIMESTAMPING) {
    error.ee_info = SCM_TSTAMP_SND;
    const bool is_numbered = (state.timestamping & SOF_TIMESTAMPING_OPT_ID) != 0;
    if (is_numbered) error.ee_data = arrival.number - state.first_number;
  } else if (arrival.origin == SO_EE_ORIGIN_ICMP) {
    error.ee_type = 3;  // ICMP_DEST_UNREACH
    error.ee_code = 3;  // ICMP_PORT_UNREACH
  } else if (arrival.origin == SO_EE_ORIGIN_ICMP6) {
    error.ee_type = 1;  // ICMPV6_DEST_UNREACH
    error.ee_code = 4;  // ICMPV6_PORT_UNREACH
  }
  return error;
}

// Whether the kernel says of an error what else it knows: of refusals, and of packets that have
// left and come back whole; IPv4 only where that is asked for.
bool says_more(int fd, const SocketState& state) {
  if (is_refusal()) return true;
  const bool is_asked =
      family_of(fd) == AF_INET6 || (state.timestamping & SOF_TIMESTAMPING_OPT_CMSG) != 0;
  return has_left() && (state.timestamping & SOF_TIMESTAMPING_OPT_TSONLY) == 0 && is_asked;
}

// The error, and behind it who reported it: who refused it, or who sent it.
template <class Name>
void add_error_with_name(int level, int type, bool is_known, const SocketState& state,
                         Control& control) {
  struct {
    sock_extended_err error;
    Name offender;
  } both{};
  both.error = error_of(state);
  if (is_known) {
    Address who = is_refusal() ? datagram.arrival.to : datagram.arrival.from;
    who.port = 0;
    socklen_t size = sizeof both.offender;
    write_address(who, reinterpret_cast<sockaddr*>(&both.offender), &size);
  }
  control.add(level, type, both);
}

void add_error(int fd, const SocketState& state, Control& control) {
  const bool is_known = says_more(fd, state);
  switch (family_of(fd)) {
    case AF_PACKET:
      return control.add(SOL_PACKET, PACKET_TX_TIMESTAMP, error_of(state));
    case AF_INET6:
      return add_error_with_name<sockaddr_in6>(IPPROTO_IPV6, IPV6_RECVERR, is_known, state,
                                               control);
    default:
      return add_error_with_name<sockaddr_in>(IPPROTO_IP, IP_RECVERR, is_known, state, control);
  }
}

void fill_message(int fd, bool is_error, msghdr& message) {
  const SocketState& state = state_of(fd);
  const Arrival& arrival = datagram.arrival;
  // What has left has no name: it is in its heads.
  const Address name = !is_error ? arrival.from : has_left() ? Address{} : arrival.to;
  if (message.msg_name == nullptr || name.family == AF_UNSPEC) message.msg_namelen = 0;
  write_address(name, static_cast<sockaddr*>(message.msg_name), &message.msg_namelen);
  Control control(message);
  if (!is_error) add_older_stamp(state, control);
  add_stamps(state, control);
  if (!is_error || says_more(fd, state)) add_facts(fd, control);
  if (is_error) add_error(fd, state, control);
}

}  // namespace

ssize_t receive_datagram(int fd, msghdr& message, int flags) {
  const int taken = take(fd, flags);
  if (taken <= 0) {
    if (taken == 0) message.msg_namelen = 0;
    return taken;
  }
  complete_departure(state_of(fd));
  const std::size_t copied = scatter(datagram.bytes + datagram.begin, datagram.size, message);
  const bool is_error = (flags & MSG_ERRQUEUE) != 0;
  message.msg_flags = (copied < datagram.size ? MSG_TRUNC : 0) | (is_error ? MSG_ERRQUEUE : 0);
  fill_message(fd, is_error, message);
  return static_cast<ssize_t>((flags & MSG_TRUNC) != 0 ? datagram.size : copied);
}

namespace {

// What this departure alone asks for.
struct Wishes {
  std::int64_t stamps = -1;  // the socket's
  Address source{};
};

template <class Value>
Value value_of(const cmsghdr& head) {
  Value value{};
  const std::size_t size = head.cmsg_len - CMSG_LEN(0);
  memcpy(&value, CMSG_DATA(&head), size < sizeof value ? size : sizeof value);
  return value;
}

void read_wish(int fd, const cmsghdr& head, Wishes& wishes) {
  constexpr unsigned kTransmit = SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_TX_HARDWARE;
  if (head.cmsg_level == SOL_SOCKET && head.cmsg_type == SO_TIMESTAMPING) {
    const auto flags = value_of<unsigned>(head);
    wishes.stamps =
        departure_stamps((state_of(fd).timestamping & ~kTransmit) | (flags & kTransmit));
  } else if (head.cmsg_level == IPPROTO_IP && head.cmsg_type == IP_PKTINFO) {
    const auto from = value_of<in_pktinfo>(head);
    wishes.source = ipv4_address(ntohl(from.ipi_spec_dst.s_addr), 0);
    wishes.source.scope = static_cast<std::uint32_t>(from.ipi_ifindex);
  } else if (head.cmsg_level == IPPROTO_IPV6 && head.cmsg_type == IPV6_PKTINFO) {
    const auto from = value_of<in6_pktinfo>(head);
    wishes.source = {
        .host = address_at(&from.ipi6_addr), .scope = from.ipi6_ifindex, .family = AF_INET6};
  }
}

Wishes wishes_of(int fd, const msghdr& message) {
  Wishes wishes;
  auto& readable = const_cast<msghdr&>(message);
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&readable, each)) {
    read_wish(fd, *each, wishes);
  }
  return wishes;
}

}  // namespace

ssize_t send_datagram(int fd, const msghdr& message, int flags) {
  static unsigned char payload[kMostData - sizeof(Departure)];
  if ((flags & MSG_OOB) != 0 && family_of(fd) == AF_INET) return refuse(EOPNOTSUPP);
  Departure departure{};
  if (message.msg_name != nullptr &&
      !read_address(fd, NameUse::kSend, static_cast<const sockaddr*>(message.msg_name),
                    message.msg_namelen, departure.to)) {
    return -1;
  }
  const Wishes wishes = wishes_of(fd, message);
  departure.source = wishes.source;
  const ssize_t size = gather(message, payload, sizeof payload);
  if (size < 0) return -1;
  const Sent content{payload, static_cast<std::size_t>(size)};
  const Request request{.call = Call::kSend, .fd = fd, .a = wishes.stamps};
  return ask(request, {&departure, sizeof departure}, content) < 0 ? -1 : size;
}

}  // namespace simbench::shim

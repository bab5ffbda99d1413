#include "shim/netlink.h"

#include <arpa/inet.h>
#include <errno.h>
#include <linux/if.h>
#include <linux/if_addr.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <poll.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "shim/interfaces.h"
#include "shim/sockets.h"

namespace simbench::shim {
namespace {

// Messages that wait for their reader; each is one datagram.
class NetlinkAnswer {
 public:
  bool is_empty() const { return size_ == 0; }
  const unsigned char* bytes() const { return bytes_; }
  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }

  void begin(std::uint16_t type, std::uint16_t flags, const nlmsghdr& question) {
    begin_ = size_;
    nlmsghdr head{};
    head.nlmsg_type = type;
    head.nlmsg_flags = flags;
    head.nlmsg_seq = question.nlmsg_seq;
    head.nlmsg_pid = static_cast<std::uint32_t>(identity().process);
    add(&head, sizeof head);
  }
  void add(const void* data, std::size_t size) {
    if (size_ + NLMSG_ALIGN(size) > sizeof bytes_) return;
    memset(bytes_ + size_, 0, NLMSG_ALIGN(size));
    memcpy(bytes_ + size_, data, size);
    size_ += NLMSG_ALIGN(size);
  }
  void attribute(std::uint16_t type, const void* data, std::size_t size) {
    const rtattr head{.rta_len = static_cast<std::uint16_t>(RTA_LENGTH(size)), .rta_type = type};
    add(&head, sizeof head);
    add(data, size);
  }
  void end() {
    const auto length = static_cast<std::uint32_t>(size_ - begin_);
    memcpy(bytes_ + begin_, &length, sizeof length);
  }

 private:
  alignas(NLMSG_ALIGNTO) unsigned char bytes_[4096];
  std::size_t size_;
  std::size_t begin_;
};

// Programs have one or two of these sockets.
struct NetlinkSocket {
  bool is_taken;
  int number;
  NetlinkAnswer answer;
};
constexpr int kMostSockets = 8;
NetlinkSocket places[kMostSockets];

NetlinkAnswer* answer_of(int fd) {
  for (NetlinkSocket& each : places) {
    if (each.is_taken && each.number == number_of(fd)) return &each.answer;
  }
  return nullptr;
}

// A place whose socket was closed is free.
NetlinkSocket* take_place() {
  for (NetlinkSocket& each : places) {
    if (!each.is_taken || !is_open(each.number)) return &each;
  }
  return nullptr;
}

void state_link(const InterfaceFacts& facts, const nlmsghdr& question, std::uint16_t flags,
                NetlinkAnswer& answer) {
  const unsigned char state = facts.has_carrier ? 6 : 2;  // IF_OPER_UP, IF_OPER_DOWN
  answer.begin(RTM_NEWLINK, flags, question);
  ifinfomsg link{};
  link.ifi_type = facts.hardware;
  link.ifi_index = static_cast<int>(facts.index);
  link.ifi_flags = facts.flags;
  if (facts.has_carrier) link.ifi_flags |= IFF_LOWER_UP;
  answer.add(&link, sizeof link);
  answer.attribute(IFLA_IFNAME, facts.name, strlen(facts.name) + 1);
  answer.attribute(IFLA_ADDRESS, facts.mac, kMacBytes);
  answer.attribute(IFLA_MTU, &facts.mtu, sizeof facts.mtu);
  answer.attribute(IFLA_OPERSTATE, &state, sizeof state);
  answer.end();
}

void state_address(const InterfaceFacts& facts, const nlmsghdr& question, NetlinkAnswer& answer) {
  if (facts.address == 0) return;
  answer.begin(RTM_NEWADDR, NLM_F_MULTI, question);
  ifaddrmsg head{};
  head.ifa_family = AF_INET;
  head.ifa_prefixlen = static_cast<unsigned char>(__builtin_popcount(facts.netmask));
  head.ifa_flags = IFA_F_PERMANENT;
  head.ifa_scope = facts.index == kLoopbackInterface ? RT_SCOPE_HOST : RT_SCOPE_UNIVERSE;
  head.ifa_index = facts.index;
  answer.add(&head, sizeof head);
  const std::uint32_t address = htonl(facts.address);
  const std::uint32_t broadcast = htonl(facts.broadcast);
  answer.attribute(IFA_ADDRESS, &address, sizeof address);
  answer.attribute(IFA_LOCAL, &address, sizeof address);
  if (facts.broadcast != 0) answer.attribute(IFA_BROADCAST, &broadcast, sizeof broadcast);
  answer.attribute(IFA_LABEL, facts.name, strlen(facts.name) + 1);
  answer.end();
}

void state_addresses6(const InterfaceFacts& facts, const nlmsghdr& question,
                      NetlinkAnswer& answer) {
  for (int i = 0; i < facts.addresses6; ++i) {
    const IpAddress& address = facts.address6[i];
    answer.begin(RTM_NEWADDR, NLM_F_MULTI, question);
    ifaddrmsg head{};
    head.ifa_family = AF_INET6;
    head.ifa_prefixlen = static_cast<unsigned char>(facts.prefix6);
    head.ifa_flags = IFA_F_PERMANENT;
    head.ifa_scope = is_loopback(address)     ? RT_SCOPE_HOST
                     : is_link_local(address) ? RT_SCOPE_LINK
                                              : RT_SCOPE_UNIVERSE;
    head.ifa_index = facts.index;
    answer.add(&head, sizeof head);
    answer.attribute(IFA_ADDRESS, &address, sizeof address);
    answer.end();
  }
}

void state_error(int error, const nlmsghdr& question, NetlinkAnswer& answer) {
  answer.begin(NLMSG_ERROR, 0, question);
  const nlmsgerr cause{.error = -error, .msg = question};
  answer.add(&cause, sizeof cause);
  answer.end();
}

void state_end(const nlmsghdr& question, NetlinkAnswer& answer) {
  const int nothing = 0;
  answer.begin(NLMSG_DONE, NLM_F_MULTI, question);
  answer.add(&nothing, sizeof nothing);
  answer.end();
}

void state_links(const nlmsghdr& question, const ifinfomsg& which, const char* name,
                 NetlinkAnswer& answer) {
  if ((question.nlmsg_flags & NLM_F_DUMP) == NLM_F_DUMP) {
    for (int i = 0; i < interfaces(); ++i) {
      state_link(interface_at(i), question, NLM_F_MULTI, answer);
    }
    return state_end(question, answer);
  }
  InterfaceFacts facts{};
  const bool is_known = name != nullptr
                            ? find_interface(name, facts)
                            : find_interface(static_cast<unsigned>(which.ifi_index), facts);
  if (!is_known) return state_error(ENODEV, question, answer);
  state_link(facts, question, 0, answer);
}

// The addresses of one family, or of both.
void state_addresses(const nlmsghdr& question, unsigned char family, NetlinkAnswer& answer) {
  for (int i = 0; i < interfaces() && family != AF_INET6; ++i) {
    state_address(interface_at(i), question, answer);
  }
  for (int i = 0; i < interfaces() && family != AF_INET; ++i) {
    state_addresses6(interface_at(i), question, answer);
  }
  state_end(question, answer);
}

// The attribute IFLA_IFNAME of a question, if it has one.
const char* name_in(const unsigned char* bytes, std::size_t size) {
  std::size_t at = NLMSG_LENGTH(sizeof(ifinfomsg));
  while (at + sizeof(rtattr) <= size) {
    rtattr head{};
    memcpy(&head, bytes + at, sizeof head);
    if (head.rta_len < sizeof head || at + head.rta_len > size) return nullptr;
    if (head.rta_type == IFLA_IFNAME) {
      return reinterpret_cast<const char*>(bytes + at + sizeof head);
    }
    at += RTA_ALIGN(head.rta_len);
  }
  return nullptr;
}

void reply(const unsigned char* bytes, std::size_t size, NetlinkAnswer& answer) {
  nlmsghdr question{};
  if (size < sizeof question) return;
  memcpy(&question, bytes, sizeof question);
  if (question.nlmsg_type == RTM_GETLINK && size >= NLMSG_LENGTH(sizeof(ifinfomsg))) {
    ifinfomsg which{};
    memcpy(&which, bytes + NLMSG_HDRLEN, sizeof which);
    return state_links(question, which, name_in(bytes, size), answer);
  }
  const bool wants_all = (question.nlmsg_flags & NLM_F_DUMP) != 0;
  if (question.nlmsg_type == RTM_GETADDR && wants_all) {
    const unsigned char family = size > NLMSG_HDRLEN ? bytes[NLMSG_HDRLEN] : 0;
    return state_addresses(question, family, answer);
  }
  if (wants_all) return state_end(question, answer);
  state_error(EOPNOTSUPP, question, answer);
}

}  // namespace

int open_netlink(int type, int protocol) {
  const int kind = type & ~(SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (kind != SOCK_RAW && kind != SOCK_DGRAM) return refuse(ESOCKTNOSUPPORT);
  NetlinkSocket* place = take_place();
  if (protocol != NETLINK_ROUTE || place == nullptr) return refuse(EPROTONOSUPPORT);
  const int fd =
      open_descriptor(Kind::kNetlink, (type & SOCK_NONBLOCK) != 0, (type & SOCK_CLOEXEC) != 0);
  if (fd < 0) return -1;
  for (NetlinkSocket& each : places) each.is_taken &= each.number != number_of(fd);
  state_of(fd) = {.family = AF_NETLINK, .type = kind, .protocol = protocol};
  forget_options(fd);
  place->is_taken = true;
  place->number = number_of(fd);
  place->answer.clear();
  return fd;
}

ssize_t netlink_send(int fd, const msghdr& message) {
  alignas(NLMSG_ALIGNTO) unsigned char bytes[512] = {};
  const ssize_t size = gather(message, bytes, sizeof bytes - 1);  // names end with a zero
  if (size < 0) return -1;
  NetlinkAnswer& answer = *answer_of(fd);
  const bool was_empty = answer.is_empty();
  reply(bytes, static_cast<std::size_t>(size), answer);
  const std::uint64_t one = 1;
  if (was_empty && !answer.is_empty()) syscall(SYS_write, fd, &one, sizeof one);
  return size;
}

ssize_t netlink_receive(int fd, msghdr& message, int flags) {
  NetlinkAnswer& answer = *answer_of(fd);
  if (answer.is_empty()) {
    // Nothing will ever come.
    pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
    if ((flags & MSG_DONTWAIT) == 0 && is_blocking(fd)) poll(&interest, 1, -1);
    return refuse(EAGAIN);
  }
  const std::size_t copied = scatter(answer.bytes(), answer.size(), message);
  message.msg_flags = copied < answer.size() ? MSG_TRUNC : 0;
  message.msg_controllen = 0;
  sockaddr_nl kernel{};
  kernel.nl_family = AF_NETLINK;
  if (message.msg_name != nullptr) {
    const socklen_t room = message.msg_namelen;
    memcpy(message.msg_name, &kernel, room < sizeof kernel ? room : sizeof kernel);
  }
  message.msg_namelen = sizeof kernel;
  const std::size_t whole = answer.size();
  if ((flags & MSG_PEEK) == 0) {
    std::uint64_t count = 0;
    syscall(SYS_read, fd, &count, sizeof count);
    answer.clear();
  }
  return static_cast<ssize_t>((flags & MSG_TRUNC) != 0 ? whole : copied);
}

int netlink_name(sockaddr* name, socklen_t* size) {
  sockaddr_nl own{};
  own.nl_family = AF_NETLINK;
  own.nl_pid = static_cast<std::uint32_t>(identity().process);
  memcpy(name, &own, *size < sizeof own ? *size : sizeof own);
  *size = sizeof own;
  return 0;
}

// The kernel.
int netlink_peer_name(sockaddr* name, socklen_t* size) {
  sockaddr_nl kernel{};
  kernel.nl_family = AF_NETLINK;
  memcpy(name, &kernel, *size < sizeof kernel ? *size : sizeof kernel);
  *size = sizeof kernel;
  return 0;
}

}  // namespace simbench::shim

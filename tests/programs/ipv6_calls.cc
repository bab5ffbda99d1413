// What ipv6(7), udp(7) and ip(7) promise between hosts: addresses, groups, closed ports, large
// datagrams. Host N has fd00::N+1 and fe80::aff:fe00:N+1 beside 10.0.0.N+1.
//
//   ipv6_calls answer   says to which address and by which interface a datagram came
//   ipv6_calls check
#include <arpa/inet.h>
#include <linux/errqueue.h>
#include <net/if.h>
#include <time.h>

#include <string>

#include "tests/programs/promises.h"
#include "tests/programs/twin.h"

namespace {

using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::has_input;
using promises::kMillisecond;
using promises::kSecond;
using promises::steady;
using twin::bind_to;
using twin::connect_to;
using twin::events_of;
using twin::Name;
using twin::number_of;
using twin::own_name;
using twin::peer_name;
using twin::received;
using twin::send_to;
using twin::set_number;

constexpr std::uint16_t kPort = 3200;
constexpr std::uint16_t kClosed = 3201;
constexpr const char* kGroup = "ff0e::7777";
constexpr const char* kLinkGroup = "ff02::7777";

int udp6() { return socket(AF_INET6, SOCK_DGRAM, 0); }

ipv6_mreq membership(const char* group, unsigned interface) {
  ipv6_mreq result{};
  inet_pton(AF_INET6, group, &result.ipv6mr_multiaddr);
  result.ipv6mr_interface = interface;
  return result;
}

int change(int fd, int option, const ipv6_mreq& wanted) {
  return setsockopt(fd, IPPROTO_IPV6, option, &wanted, sizeof wanted);
}

// What comes within the time, or "nothing".
std::string heard(int fd, int patience_ms = 100) {
  return has_input(fd, patience_ms) ? received(fd) : "nothing";
}

struct Told {
  std::string text = "nothing";
  std::string to;
  int hops = -1;
  int traffic_class = -1;
  sock_extended_err error{};
  std::string offender;
};

void read_head(cmsghdr& head, Told& told) {
  char host[INET6_ADDRSTRLEN] = "";
  if (head.cmsg_level == IPPROTO_IPV6 && head.cmsg_type == IPV6_PKTINFO) {
    in6_pktinfo to{};
    std::memcpy(&to, CMSG_DATA(&head), sizeof to);
    inet_ntop(AF_INET6, &to.ipi6_addr, host, sizeof host);
    told.to = std::string(host) + "%" + std::to_string(to.ipi6_ifindex);
  } else if (head.cmsg_level == IPPROTO_IPV6 && head.cmsg_type == IPV6_HOPLIMIT) {
    std::memcpy(&told.hops, CMSG_DATA(&head), sizeof told.hops);
  } else if (head.cmsg_level == IPPROTO_IPV6 && head.cmsg_type == IPV6_TCLASS) {
    std::memcpy(&told.traffic_class, CMSG_DATA(&head), sizeof told.traffic_class);
  } else if (head.cmsg_level == IPPROTO_IPV6 && head.cmsg_type == IPV6_RECVERR) {
    struct {
      sock_extended_err error;
      sockaddr_in6 from;
    } both{};
    std::memcpy(&both, CMSG_DATA(&head), sizeof both);
    told.error = both.error;
    inet_ntop(AF_INET6, &both.from.sin6_addr, host, sizeof host);
    told.offender = host;
  }
}

Told receive(int fd, int flags, Name& from) {
  static char bytes[70'000];
  alignas(cmsghdr) char control[512];
  iovec piece{.iov_base = bytes, .iov_len = sizeof bytes};
  msghdr message{};
  message.msg_name = from.name();
  message.msg_namelen = *from.room();
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  Told told;
  const ssize_t size = recvmsg(fd, &message, flags);
  if (size < 0) return told;
  told.text = std::string(bytes, static_cast<std::size_t>(size));
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    read_head(*each, told);
  }
  return told;
}

void check_addresses() {
  const int fd = udp6();
  expect(send_to(fd, "x", Name("fd00::2", kPort)) == 1 &&
             heard(fd) == "\"to fd00::2%2\" from fd00::2 3200",
         "by the network's address");
  expect(send_to(fd, "x", Name("fe80::aff:fe00:2%eth0", kPort)) == 1 &&
             heard(fd) == "\"to fe80::aff:fe00:2%2\" from fe80::aff:fe00:2%2 3200",
         "by the link's");
  expect(send_to(fd, "x", Name("::ffff:10.0.0.2", kPort)) == 1 &&
             heard(fd) == "\"to ::ffff:10.0.0.2%2\" from ::ffff:10.0.0.2 3200",
         "by IPv4");
  expect(connect_to(fd, Name("fe80::aff:fe00:2%eth0", kPort)) == 0 &&
             peer_name(fd) == "fe80::aff:fe00:2%2 3200" &&
             own_name(fd).starts_with("fe80::aff:fe00:1%2 "),
         "names of the link have it");
  const int fresh = udp6();
  expect_error(connect_to(fresh, Name("fe80::aff:fe00:2", kPort)), EINVAL, "and need it");
  expect(send_to(fresh, "x", Name("fe80::aff:fe00:2", kPort)) == 1 && heard(fresh) != "nothing",
         "but for a send");
  close(fresh);
  expect(connect_to(fd, Name("fe80::aff:fe00:3", kPort)) == 0, "once said it is known");
  expect_error(connect_to(fd, Name("2001:db8::1", kPort)), ENETUNREACH, "no other network");
  close(fd);
  const int bound = udp6();
  expect_error(bind_to(bound, Name("fe80::aff:fe00:1", 0)), EINVAL, "bind needs it too");
  expect_error(bind_to(bound, Name("fe80::aff:fe00:2%eth0", 0)), EADDRNOTAVAIL, "another host's");
  expect(bind_to(bound, Name("fd00::1", 0)) == 0 && own_name(bound).starts_with("fd00::1 "),
         "its own");
  close(bound);
}

void check_device() {
  const int fd = udp6();
  expect(setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, "eth0", 5) == 0, "SO_BINDTODEVICE");
  expect(connect_to(fd, Name("fe80::aff:fe00:2", kPort)) == 0, "an interface is enough");
  expect(send(fd, "x", 1, 0) == 1 && heard(fd) != "nothing", "and is used");
  close(fd);
  const int alone = udp6();
  expect(setsockopt(alone, SOL_SOCKET, SO_BINDTODEVICE, "lo", 3) == 0, "the loopback");
  expect_error(send_to(alone, "x", Name("fd00::2", kPort)), ENETUNREACH, "leads nowhere");
  close(alone);
}

void check_heads() {
  const int fd = udp6();
  set_number(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1);
  set_number(fd, IPPROTO_IPV6, IPV6_RECVHOPLIMIT, 1);
  set_number(fd, IPPROTO_IPV6, IPV6_RECVTCLASS, 1);
  send_to(fd, "x", Name("fd00::2", kPort));
  expect(has_input(fd), "an answer");
  Name from;
  const Told told = receive(fd, 0, from);
  expect(told.to == "fd00::1%2" && told.hops == 77 && told.traffic_class == 184,
         "its destination, hops and class");
  close(fd);
}

ssize_t send_from(int fd, const char* source, const Name& to) {
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(in6_pktinfo))] = {};
  char byte = 'x';
  iovec piece{.iov_base = &byte, .iov_len = 1};
  msghdr message{};
  message.msg_name = const_cast<sockaddr*>(to.name());
  message.msg_namelen = to.size();
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* head = CMSG_FIRSTHDR(&message);
  head->cmsg_level = IPPROTO_IPV6;
  head->cmsg_type = IPV6_PKTINFO;
  head->cmsg_len = CMSG_LEN(sizeof(in6_pktinfo));
  in6_pktinfo from{};
  inet_pton(AF_INET6, source, &from.ipi6_addr);
  from.ipi6_ifindex = if_nametoindex("eth0");
  std::memcpy(CMSG_DATA(head), &from, sizeof from);
  return sendmsg(fd, &message, 0);
}

void check_source() {
  const int fd = udp6();
  set_number(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1);
  for (const std::string own : {"fd00::1", "fe80::aff:fe00:1"}) {
    expect(send_from(fd, own.c_str(), Name("fd00::2", kPort)) == 1, "IPV6_PKTINFO names a source");
    expect(has_input(fd), "an answer");
    Name from;
    expect(receive(fd, 0, from).to == own + "%2", "which comes to it");
  }
  expect_error(send_from(fd, "fd00::77", Name("fd00::2", kPort)), EINVAL, "one that is not ours");
  close(fd);
}

void check_groups() {
  const int fd = udp6();
  const unsigned card = if_nametoindex("eth0");
  expect(change(fd, IPV6_JOIN_GROUP, membership(kGroup, card)) == 0, "IPV6_JOIN_GROUP");
  expect_error(change(fd, IPV6_JOIN_GROUP, membership(kGroup, card)), EADDRINUSE, "once");
  expect_error(change(fd, IPV6_JOIN_GROUP, membership("fd00::1", card)), EINVAL, "groups only");
  expect_error(change(fd, IPV6_JOIN_GROUP, membership(kGroup, 99)), ENODEV, "no such interface");
  expect(change(fd, IPV6_LEAVE_GROUP, membership(kGroup, card)) == 0, "IPV6_LEAVE_GROUP");
  expect_error(change(fd, IPV6_LEAVE_GROUP, membership(kGroup, card)), EADDRNOTAVAIL, "it has");
  expect_error(set_number(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF, 99), ENODEV, "IPV6_MULTICAST_IF");
  expect(set_number(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF, static_cast<int>(card)) == 0 &&
             number_of(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF) == std::to_string(card),
         "is kept");
  for (const std::string group : {kGroup, kLinkGroup}) {
    expect(send_to(fd, "x", Name(group, kPort)) == 1, "a send to a group");
    std::string answers[2] = {heard(fd), heard(fd)};
    if (answers[1] < answers[0]) std::swap(answers[0], answers[1]);
    const std::string own = group == kGroup ? "fd00::" : "fe80::aff:fe00:";
    const std::string link = group == kGroup ? "" : "%2";
    expect(answers[0] == "\"to " + group + "%2\" from " + own + "2" + link + " 3200" &&
               answers[1] == "\"to " + group + "%2\" from " + own + "3" + link + " 3200",
           "both others answer, by the address of the group's reach");
  }
  set_number(fd, IPPROTO_IPV6, IPV6_MULTICAST_HOPS, 0);
  change(fd, IPV6_JOIN_GROUP, membership(kGroup, card));
  expect(send_to(fd, "x", Name(kGroup, kPort)) == 1 && heard(fd) == "nothing", "without hops");
  close(fd);
}

void check_loop() {
  const int listener = udp6();
  const unsigned card = if_nametoindex("eth0");
  bind_to(listener, Name("::", 3300));
  change(listener, IPV6_JOIN_GROUP, membership(kGroup, card));
  const int fd = udp6();
  set_number(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF, static_cast<int>(card));
  send_to(fd, "own", Name(kGroup, 3300));
  expect(heard(listener).starts_with("\"own\" from fd00::1 "), "the host hears itself");
  expect(set_number(fd, IPPROTO_IPV6, IPV6_MULTICAST_LOOP, 0) == 0, "IPV6_MULTICAST_LOOP");
  send_to(fd, "own", Name(kGroup, 3300));
  expect(heard(listener) == "nothing", "no more");
  expect_error(set_number(fd, IPPROTO_IPV6, IPV6_MULTICAST_LOOP, 2), EINVAL, "0 or 1");
  for (const int each : {listener, fd}) close(each);
}

// Nobody is at the port: the answer comes back over the network.
void check_refusals() {
  const int silent = udp6();
  for (const char* host : {"fd00::2", "fe80::aff:fe00:2%eth0", "::ffff:10.0.0.2"}) {
    const int fd = udp6();
    expect(connect_to(fd, Name(host, kClosed)) == 0 && send(fd, "x", 1, 0) == 1, "it leaves");
    char byte = 0;
    expect_error(recv(fd, &byte, 1, MSG_DONTWAIT), EAGAIN, "nothing is known yet");
    const std::int64_t begin = steady();
    expect(events_of(fd, POLLIN, 1000) == "ERR", "a wait ends");
    expect(steady() - begin > kMillisecond / 50, "after a way there and back");
    expect_error(recv(fd, &byte, 1, MSG_DONTWAIT), ECONNREFUSED, "nobody was there");
    expect_error(recv(fd, &byte, 1, MSG_DONTWAIT), EAGAIN, "once");
    close(fd);
  }
  send_to(silent, "x", Name("fd00::2", kClosed));
  expect(events_of(silent, POLLIN, 100) == "nothing", "who is not connected hears nothing");
  close(silent);
}

void check_error_queue() {
  const int fd = udp6();
  set_number(fd, IPPROTO_IPV6, IPV6_RECVERR, 1);
  send_to(fd, "hello", Name("fd00::2", kClosed));
  expect(events_of(fd, POLLIN, 1000) == "ERR", "the queue has it");
  Name to;
  const Told told = receive(fd, MSG_ERRQUEUE, to);
  expect(told.text == "hello" && to.text() == "fd00::2 3201" && told.offender == "fd00::2" &&
             told.error.ee_origin == SO_EE_ORIGIN_ICMP6 && told.error.ee_errno == ECONNREFUSED,
         "what was refused, and by whom");
  close(fd);
}

void check_large() {
  const int fd = udp6();
  for (const std::size_t size : {1452u, 1453u, 20'000u, 65'527u}) {
    expect(
        send_to(fd, std::string(size, 'x'), Name("fd00::2", kPort)) == static_cast<ssize_t>(size),
        "a large datagram leaves");
    expect(heard(fd, 1000) == "\"" + std::to_string(size) + " to fd00::2%2\" from fd00::2 3200",
           "and comes whole");
  }
  expect(send_to(fd, std::string(65'507, 'x'), Name("::ffff:10.0.0.2", kPort)) == 65'507 &&
             heard(fd, 1000) == "\"65507 to ::ffff:10.0.0.2%2\" from ::ffff:10.0.0.2 3200",
         "by IPv4");
  expect_error(send_to(fd, std::string(65'508, 'x'), Name("::ffff:10.0.0.2", kPort)), EMSGSIZE,
               "not more");
  set_number(fd, IPPROTO_IPV6, IPV6_RECVERR, 1);
  expect(set_number(fd, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_DO) == 0, "PMTUDISC_DO");
  expect(send_to(fd, std::string(1452, 'x'), Name("fd00::2", kPort)) == 1452, "a packet");
  expect(heard(fd) != "nothing", "which comes");
  expect_error(send_to(fd, std::string(1453, 'x'), Name("fd00::2", kPort)), EMSGSIZE,
               "but no fragments");
  Name to;
  const Told told = receive(fd, MSG_ERRQUEUE, to);
  expect(told.error.ee_origin == SO_EE_ORIGIN_LOCAL && told.error.ee_info == 1500 &&
             told.error.ee_errno == EMSGSIZE,
         "the queue says what would fit");
  expect(connect_to(fd, Name("fd00::2", kPort)) == 0 &&
             number_of(fd, IPPROTO_IPV6, IPV6_MTU) == "1500",
         "IPV6_MTU");
  close(fd);
}

void check_streams() {
  for (const char* host : {"fd00::2", "fe80::aff:fe00:2%eth0", "10.0.0.2"}) {
    const bool is_v6 = std::string(host).find(':') != std::string::npos;
    const int fd = socket(is_v6 ? AF_INET6 : AF_INET, SOCK_STREAM, 0);
    expect(connect_to(fd, Name(host, kPort)) == 0, "connect");
    char text[100] = "";
    expect(send(fd, "hi", 2, 0) == 2 && recv(fd, text, sizeof text, 0) > 0, "an answer");
    const std::string own = is_v6 ? own_name(fd) : "::ffff:" + own_name(fd);
    expect(std::string(text) == own.substr(0, own.find(' ')), "it knows our name");
    close(fd);
    const int closed = socket(is_v6 ? AF_INET6 : AF_INET, SOCK_STREAM, 0);
    expect_error(connect_to(closed, Name(host, kClosed)), ECONNREFUSED, "a closed port");
    close(closed);
  }
}

void answer_datagram(int fd) {
  Name from;
  const Told told = receive(fd, 0, from);
  const std::string size =
      told.text.size() > 100 ? std::to_string(told.text.size()) + " to " : "to ";
  send_to(fd, size + told.to, from);
}

// Tells a client its name, as far as it has no port.
void answer_stream(int listener) {
  Name from;
  const int fd = accept(listener, from.name(), from.room());
  char bytes[10];
  if (recv(fd, bytes, sizeof bytes, 0) > 0) {
    const std::string name = from.text().substr(0, from.text().find(' '));
    send(fd, name.data(), name.size(), MSG_NOSIGNAL);
  }
  close(fd);
}

[[noreturn]] void answer() {
  const int fd = udp6();
  const unsigned card = if_nametoindex("eth0");
  expect(bind_to(fd, Name("::", kPort)) == 0, "bind");
  set_number(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1);
  set_number(fd, IPPROTO_IPV6, IPV6_UNICAST_HOPS, 77);
  set_number(fd, IPPROTO_IPV6, IPV6_TCLASS, 184);
  set_number(fd, SOL_SOCKET, SO_RCVBUF, 1'000'000);
  for (const char* group : {kGroup, kLinkGroup}) {
    expect(change(fd, IPV6_JOIN_GROUP, membership(group, card)) == 0, "IPV6_JOIN_GROUP");
  }
  const int listener = socket(AF_INET6, SOCK_STREAM, 0);
  expect(bind_to(listener, Name("::", kPort)) == 0 && listen(listener, 4) == 0, "listen");
  for (;;) {
    pollfd both[] = {{.fd = fd, .events = POLLIN, .revents = 0},
                     {.fd = listener, .events = POLLIN, .revents = 0}};
    poll(both, 2, -1);
    if (both[0].revents != 0) answer_datagram(fd);
    if (both[1].revents != 0) answer_stream(listener);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "answer") == 0) answer();
  sleep(1);
  check_addresses();
  check_device();
  check_heads();
  check_source();
  check_groups();
  check_loop();
  check_refusals();
  check_error_queue();
  check_large();
  check_streams();
  finish();
}

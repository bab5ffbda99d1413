// What ip(7) and socket(7) promise of multicasts and broadcasts.
//
//   group_calls answer   answers what comes for the group or for all
//   group_calls check
#include <initializer_list>

#include "tests/programs/promises.h"

namespace {

using promises::address;
using promises::bind_to;
using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::gets;
using promises::has_input;
using promises::send_text;
using promises::set_number;
using promises::udp;

constexpr const char* kGroup = "224.0.1.200";
constexpr const char* kOther = "224.0.1.201";
constexpr std::uint16_t kPort = 3200;

ip_mreqn membership(const char* group, int interface = 0) {
  ip_mreqn result{};
  inet_pton(AF_INET, group, &result.imr_multiaddr);
  result.imr_ifindex = interface;
  return result;
}

int change(int fd, int option, const ip_mreqn& wanted) {
  return setsockopt(fd, IPPROTO_IP, option, &wanted, sizeof wanted);
}

int member(std::uint16_t port) {
  const int fd = udp();
  expect(set_number(fd, SOL_SOCKET, SO_REUSEADDR, 1) == 0, "SO_REUSEADDR");
  expect(bind_to(fd, address("0.0.0.0", port)) == 0, "sockets share a port");
  expect(change(fd, IP_ADD_MEMBERSHIP, membership(kGroup)) == 0, "IP_ADD_MEMBERSHIP");
  return fd;
}

void check_membership() {
  const int fd = udp();
  expect(change(fd, IP_ADD_MEMBERSHIP, membership(kGroup, 2)) == 0, "by number of the interface");
  expect_error(change(fd, IP_ADD_MEMBERSHIP, membership(kGroup)), EADDRINUSE, "only once");
  expect_error(change(fd, IP_ADD_MEMBERSHIP, membership("10.0.0.1")), EINVAL, "groups only");
  expect_error(change(fd, IP_ADD_MEMBERSHIP, membership(kGroup, 9)), ENODEV, "no interface 9");
  expect_error(change(fd, IP_DROP_MEMBERSHIP, membership(kOther)), EADDRNOTAVAIL, "not joined");
  expect(change(fd, IP_DROP_MEMBERSHIP, membership(kGroup)) == 0, "IP_DROP_MEMBERSHIP");
  ip_mreq by_address{};
  inet_pton(AF_INET, kGroup, &by_address.imr_multiaddr);
  expect(setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &by_address, sizeof by_address) == 0,
         "by address of the interface");
  int error = 0;
  for (int i = 0; i < 25 && error == 0; ++i) {
    ip_mreqn another = membership("224.0.2.0");
    another.imr_multiaddr.s_addr += htonl(static_cast<std::uint32_t>(i));
    error = change(fd, IP_ADD_MEMBERSHIP, another) < 0 ? errno : 0;
  }
  expect(error == ENOBUFS, "a socket has at most 20 groups");
  close(fd);
}

void check_sharing() {
  const int first = member(5100);
  const int second = member(5100);
  const int alone = udp();
  expect_error(bind_to(alone, address("0.0.0.0", 5100)), EADDRINUSE, "both must share");
  const int sender = udp();
  expect(send_text(sender, "all", address(kGroup, 5100)) == 3, "a send to a group");
  expect(gets(first, "all") && gets(second, "all"), "every member on the host gets it");
  expect(set_number(sender, IPPROTO_IP, IP_MULTICAST_LOOP, 0) == 0, "IP_MULTICAST_LOOP");
  send_text(sender, "others", address(kGroup, 5100));
  expect(!has_input(first), "without the loop the host hears itself no more");
  set_number(sender, IPPROTO_IP, IP_MULTICAST_LOOP, 1);
  expect(set_number(second, IPPROTO_IP, IP_MULTICAST_ALL, 0) == 0, "IP_MULTICAST_ALL");
  change(second, IP_DROP_MEMBERSHIP, membership(kGroup));
  send_text(sender, "own", address(kGroup, 5100));
  expect(gets(first, "own") && !has_input(second), "own groups only");
  set_number(second, IPPROTO_IP, IP_MULTICAST_ALL, 1);
  send_text(sender, "any", address(kGroup, 5100));
  expect(gets(first, "any") && gets(second, "any"), "any that the host has joined");
  send_text(sender, "none", address(kOther, 5100));
  expect(!has_input(first), "not what nobody has joined");
  for (const int each : {first, second, alone, sender}) close(each);
}

void check_broadcast() {
  const int fd = udp();
  expect_error(send_text(fd, "x", address("255.255.255.255", kPort)), EACCES, "SO_BROADCAST first");
  expect(set_number(fd, SOL_SOCKET, SO_BROADCAST, 1) == 0, "SO_BROADCAST");
  expect(send_text(fd, "x", address("255.255.255.255", kPort)) == 1 &&
             gets(fd, "for 255.255.255.255") && gets(fd, "for 255.255.255.255"),
         "both others answer a broadcast");
  expect(send_text(fd, "x", address("10.0.255.255", kPort)) == 1 && gets(fd, "for 10.0.255.255") &&
             gets(fd, "for 10.0.255.255"),
         "and one to the network");
  close(fd);
}

void check_answers() {
  const int fd = udp();
  expect(send_text(fd, "x", address(kGroup, kPort)) == 1 && gets(fd, "for 224.0.1.200") &&
             gets(fd, "for 224.0.1.200"),
         "both others answer a message to the group");
  expect(!has_input(fd), "once");
  expect(send_text(fd, "x", address(kOther, kPort)) == 1 && !has_input(fd), "by members alone");
  close(fd);
}

// Says to which address a message came.
[[noreturn]] void answer() {
  const int fd = member(kPort);
  set_number(fd, IPPROTO_IP, IP_PKTINFO, 1);
  for (;;) {
    char byte = 0;
    sockaddr_in from{};
    alignas(cmsghdr) char control[128];
    iovec piece{.iov_base = &byte, .iov_len = 1};
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    expect(recvmsg(fd, &message, 0) == 1, "recvmsg");
    in_pktinfo to{};
    std::memcpy(&to, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof to);
    char text[64] = "for ";
    inet_ntop(AF_INET, &to.ipi_addr, text + 4, sizeof text - 4);
    send_text(fd, text, from);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "answer") == 0) answer();
  check_membership();
  check_sharing();
  check_broadcast();
  check_answers();
  finish();
}

// Packet sockets on the loopback as packet(7) and the kernel's documents of filters and stamps have
// them.
#include <arpa/inet.h>
#include <linux/errqueue.h>
#include <linux/filter.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <linux/net_tstamp.h>
#include <time.h>

#include "tests/programs/twin.h"

namespace {

using namespace twin;

constexpr std::uint16_t kPtp = 0x88F7;
constexpr int kIgnoreOutgoing = 23;

sockaddr_ll link_name(int interface, std::uint16_t protocol) {
  sockaddr_ll name{};
  name.sll_family = AF_PACKET;
  name.sll_ifindex = interface;
  name.sll_protocol = htons(protocol);
  name.sll_halen = 6;
  return name;
}

int bind_to(int fd, const sockaddr_ll& name) {
  return bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
}

ssize_t send_to(int fd, const std::string& data, const sockaddr_ll& name) {
  return sendto(fd, data.data(), data.size(), 0, reinterpret_cast<const sockaddr*>(&name),
                sizeof name);
}

std::string describe(const sockaddr_ll& name) {
  char mac[20];
  std::snprintf(mac, sizeof mac, "%02x:%02x:%02x:%02x:%02x:%02x", name.sll_addr[0],
                name.sll_addr[1], name.sll_addr[2], name.sll_addr[3], name.sll_addr[4],
                name.sll_addr[5]);
  return "family " + std::to_string(name.sll_family) + " protocol " +
         std::to_string(ntohs(name.sll_protocol)) + " interface " +
         std::to_string(name.sll_ifindex) + " hardware " + std::to_string(name.sll_hatype) +
         " kind " + std::to_string(name.sll_pkttype) + " length " + std::to_string(name.sll_halen) +
         " " + mac;
}

std::string own_name(int fd) {
  sockaddr_ll name{};
  socklen_t size = sizeof name;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&name), &size) < 0) return strerrorname_np(errno);
  return describe(name);
}

// A frame of an Ethertype to a group, with some payload.
std::string frame(const std::string& payload, std::uint16_t protocol = kPtp) {
  const char head[] = {0x01,
                       0x1B,
                       0x19,
                       0,
                       0,
                       0,
                       2,
                       0,
                       0,
                       0,
                       0,
                       9,
                       static_cast<char>(protocol >> 8),
                       static_cast<char>(protocol & 0xFF)};
  return std::string(head, sizeof head) + payload;
}

std::string hexadecimal(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) {
    char two[3];
    std::snprintf(two, sizeof two, "%02x", static_cast<unsigned char>(byte));
    text += two;
  }
  return text;
}

std::string describe_control(msghdr& message) {
  std::string text;
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    text += " (" + std::to_string(each->cmsg_level) + ", " + std::to_string(each->cmsg_type) +
            ", " + std::to_string(each->cmsg_len);
    if (each->cmsg_level == SOL_PACKET && each->cmsg_type == PACKET_AUXDATA) {
      tpacket_auxdata facts{};
      std::memcpy(&facts, CMSG_DATA(each), sizeof facts);
      text += ": " + std::to_string(facts.tp_status & 1U) + " " + std::to_string(facts.tp_len) +
              " " + std::to_string(facts.tp_snaplen) + " " + std::to_string(facts.tp_mac) + " " +
              std::to_string(facts.tp_net);
    } else if (each->cmsg_level == SOL_PACKET && each->cmsg_type == PACKET_TX_TIMESTAMP) {
      sock_extended_err error{};
      std::memcpy(&error, CMSG_DATA(each), sizeof error);
      text += ": " + std::to_string(error.ee_errno) + " " + std::to_string(error.ee_origin) + " " +
              std::to_string(error.ee_info) + " " + std::to_string(error.ee_data);
    } else if (each->cmsg_level == SOL_SOCKET && each->cmsg_type == SCM_TIMESTAMPING) {
      timespec stamps[3];
      std::memcpy(stamps, CMSG_DATA(each), sizeof stamps);
      text += stamps[0].tv_sec != 0 ? ": software" : ": none";
      text += stamps[2].tv_sec != 0 ? " and hardware" : "";
    }
    text += ")";
  }
  return text;
}

std::string next(int fd, int flags = 0, std::size_t room = 2000) {
  static char bytes[2000];
  alignas(cmsghdr) char control[512];
  sockaddr_ll from{};
  iovec piece{.iov_base = bytes, .iov_len = room};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  const ssize_t size = recvmsg(fd, &message, flags | MSG_DONTWAIT);
  if (size < 0) return strerrorname_np(errno);
  const std::size_t shown =
      static_cast<std::size_t>(size) < room ? static_cast<std::size_t>(size) : room;
  return std::to_string(size) + " " + hexadecimal(std::string(bytes, shown)) + " flags " +
         std::to_string(message.msg_flags) + " from " +
         (message.msg_namelen == 0 ? std::string("no name") : describe(from)) +
         describe_control(message);
}

void names() {
  const int fd = socket(AF_PACKET, SOCK_RAW, htons(kPtp));
  say("raw", fd >= 0 ? 0 : -1);
  tell("name", own_name(fd));
  say("bind to the loopback", bind_to(fd, link_name(1, kPtp)));
  tell("name", own_name(fd));
  say("no such interface", bind_to(fd, link_name(99, kPtp)));
  sockaddr_ll name = link_name(1, kPtp);
  say("too short", bind(fd, reinterpret_cast<const sockaddr*>(&name), 10));
  name.sll_family = AF_INET;
  say("not its family", bind_to(fd, name));
  say("bind anew", bind_to(fd, link_name(1, ETH_P_ALL)));
  tell("name", own_name(fd));
  say("connect", connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name));
  say("peer", getpeername(fd, reinterpret_cast<sockaddr*>(&name), Name().room()));
  say("listen", listen(fd, 1));
  say("shutdown", shutdown(fd, SHUT_RDWR));
  tell("SO_TYPE", number_of(fd, SOL_SOCKET, SO_TYPE));
  tell("SO_DOMAIN", number_of(fd, SOL_SOCKET, SO_DOMAIN));
  tell("SO_PROTOCOL", number_of(fd, SOL_SOCKET, SO_PROTOCOL));
  say("an option of IP", set_number(fd, IPPROTO_IP, IP_TTL, 3));
  close(fd);
  const int dgram = socket(AF_PACKET, SOCK_DGRAM, htons(kPtp));
  tell("SO_TYPE", number_of(dgram, SOL_SOCKET, SO_TYPE));
  close(dgram);
  say("a stream", socket(AF_PACKET, SOCK_STREAM, htons(kPtp)));
}

void sends() {
  const int fd = socket(AF_PACKET, SOCK_RAW, 0);
  say("by no interface", send(fd, "x", 1, 0));
  say("by one that is not there", send_to(fd, frame("x"), link_name(99, kPtp)));
  say("without a head", send_to(fd, "short", link_name(1, kPtp)));
  say("a head alone", send_to(fd, frame(""), link_name(1, kPtp)));
  say("a frame", send_to(fd, frame("payload"), link_name(1, kPtp)));
  const sockaddr_ll name = link_name(1, kPtp);
  say("too short a name", sendto(fd, "x", 1, 0, reinterpret_cast<const sockaddr*>(&name), 10));
  say("bound", bind_to(fd, link_name(1, 0)));
  say("then by that", send(fd, frame("payload").data(), frame("payload").size(), 0));
  tell("nothing comes to no protocol", next(fd));
  close(fd);
}

void arrivals() {
  const int all = socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL));
  const int ptp = socket(AF_PACKET, SOCK_RAW, htons(kPtp));
  const int without = socket(AF_PACKET, SOCK_DGRAM, htons(kPtp));
  const int other = socket(AF_PACKET, SOCK_RAW, htons(0x88F8));
  const int here = socket(AF_PACKET, SOCK_RAW, htons(kPtp));
  bind_to(here, link_name(1, kPtp));
  say("send", send_to(ptp, frame("hello"), link_name(1, kPtp)));
  tell("all", next(all));
  tell("all", next(all));
  tell("all", next(all));
  tell("PTP", next(ptp));
  tell("PTP", next(ptp));
  tell("without heads", next(without));
  tell("other", next(other));
  tell("bound", next(here));
  sockaddr_ll to = link_name(1, kPtp);
  std::memcpy(to.sll_addr, "\x01\x80\xC2\x00\x00\x0E", 6);
  say("send without a head", send_to(without, "world", to));
  tell("PTP", next(ptp));
  tell("all", next(all));
  tell("all", next(all));
  say("ignore what leaves", set_number(all, SOL_PACKET, kIgnoreOutgoing, 1));
  tell("is kept", number_of(all, SOL_PACKET, kIgnoreOutgoing));
  send_to(without, "again", to);
  tell("all", next(all));
  tell("all", next(all));
  tell("cut", next(ptp, 0, 3));
  send_to(without, "whole", to);
  tell("cut, whole length", next(ptp, MSG_TRUNC, 3));
  for (const int fd : {all, ptp, without, other, here}) close(fd);
}

int attach(int fd, sock_filter* code, unsigned short count) {
  const sock_fprog program{.len = count, .filter = code};
  return setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program);
}

void filters() {
  sock_filter first_is_h[] = {BPF_STMT(BPF_LD | BPF_B | BPF_ABS, 14),
                              BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 'h', 0, 1),
                              BPF_STMT(BPF_RET | BPF_K, 16), BPF_STMT(BPF_RET | BPF_K, 0)};
  sock_filter endless[] = {BPF_STMT(BPF_LD | BPF_B | BPF_ABS, 14)};
  const int fd = socket(AF_PACKET, SOCK_RAW, htons(kPtp));
  const int sender = socket(AF_PACKET, SOCK_RAW, 0);
  say("detach nothing", set_number(fd, SOL_SOCKET, SO_DETACH_FILTER, 0));
  say("no end", attach(fd, endless, 1));
  say("attach", attach(fd, first_is_h, 4));
  send_to(sender, frame("hello"), link_name(1, kPtp));
  send_to(sender, frame("other"), link_name(1, kPtp));
  tell("passes, cut", next(fd));
  tell("does not", next(fd));
  say("detach", set_number(fd, SOL_SOCKET, SO_DETACH_FILTER, 0));
  send_to(sender, frame("other"), link_name(1, kPtp));
  tell("passes", next(fd));
  tpacket_stats count{};
  socklen_t size = sizeof count;
  say("PACKET_STATISTICS", getsockopt(fd, SOL_PACKET, PACKET_STATISTICS, &count, &size));
  say("passed", count.tp_packets);
  for (const int each : {fd, sender}) close(each);
  const int udp = socket(AF_INET, SOCK_DGRAM, 0);
  twin::bind_to(udp, Name("127.0.0.1", 4000));
  sock_filter ninth_is_h[] = {BPF_STMT(BPF_LD | BPF_B | BPF_ABS, 8),
                              BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 'h', 0, 1),
                              BPF_STMT(BPF_RET | BPF_K, 11), BPF_STMT(BPF_RET | BPF_K, 0)};
  say("of UDP", attach(udp, ninth_is_h, 4));
  const int from = socket(AF_INET, SOCK_DGRAM, 0);
  twin::send_to(from, "hello", Name("127.0.0.1", 4000));
  twin::send_to(from, "other", Name("127.0.0.1", 4000));
  tell("passes, cut", received(udp, MSG_DONTWAIT));
  tell("does not", received(udp, MSG_DONTWAIT));
  for (const int each : {udp, from}) close(each);
}

int change(int fd, int option, int interface, unsigned short kind) {
  packet_mreq wanted{};
  wanted.mr_ifindex = interface;
  wanted.mr_type = kind;
  wanted.mr_alen = 6;
  std::memcpy(wanted.mr_address, "\x01\x1B\x19\x00\x00\x00", 6);
  return setsockopt(fd, SOL_PACKET, option, &wanted, sizeof wanted);
}

void memberships() {
  const int fd = socket(AF_PACKET, SOCK_RAW, htons(kPtp));
  say("join", change(fd, PACKET_ADD_MEMBERSHIP, 1, PACKET_MR_MULTICAST));
  say("all groups", change(fd, PACKET_ADD_MEMBERSHIP, 1, PACKET_MR_ALLMULTI));
  say("everything", change(fd, PACKET_ADD_MEMBERSHIP, 1, PACKET_MR_PROMISC));
  say("no such interface", change(fd, PACKET_ADD_MEMBERSHIP, 99, PACKET_MR_MULTICAST));
  say("leave", change(fd, PACKET_DROP_MEMBERSHIP, 1, PACKET_MR_MULTICAST));
  say("too short", setsockopt(fd, SOL_PACKET, PACKET_ADD_MEMBERSHIP, "x", 1));
  close(fd);
}

void stamps() {
  const int receiver = socket(AF_PACKET, SOCK_RAW, htons(kPtp));
  say("PACKET_AUXDATA", set_number(receiver, SOL_PACKET, PACKET_AUXDATA, 1));
  const int fd = socket(AF_PACKET, SOCK_RAW, 0);
  say("departures", set_number(fd, SOL_SOCKET, SO_TIMESTAMPING,
                               SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE |
                                   SOF_TIMESTAMPING_OPT_ID));
  say("unknown stamps", set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, 1 << 28));
  send_to(fd, frame("one"), link_name(1, kPtp));
  send_to(fd, frame("two"), link_name(1, kPtp));
  tell("events", events_of(fd, POLLIN));
  tell("first", next(fd, MSG_ERRQUEUE));
  tell("second", next(fd, MSG_ERRQUEUE));
  tell("no more", next(fd, MSG_ERRQUEUE));
  tell("arrival", next(receiver));
  for (const int each : {receiver, fd}) close(each);
}

}  // namespace

int main() {
  names();
  sends();
  arrivals();
  filters();
  memberships();
  stamps();
  return 0;
}

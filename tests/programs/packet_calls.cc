// What packet(7) promises between hosts, and IEEE 802.1Q of a switch that knows no PTP: frames to
// cards and groups, what a card takes, what is never forwarded, stamps.
//
//   packet_calls answer   sends frames back to where they came from
//   packet_calls check
#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/errqueue.h>
#include <linux/ethtool.h>
#include <linux/if_packet.h>
#include <linux/net_tstamp.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <time.h>

#include <array>
#include <string>

#include "tests/programs/promises.h"

namespace {

using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::has_input;
using promises::read_clock;
using promises::set_number;
using promises::to_ns;

using Card = std::array<unsigned char, 6>;

constexpr std::uint16_t kProtocol = 0x88F7;
constexpr std::uint16_t kOtherProtocol = 0x88B5;
constexpr Card kGroup{0x01, 0x1B, 0x19, 0, 0, 0};
constexpr Card kOtherGroup{0x01, 0x1B, 0x19, 0, 0, 1};
constexpr Card kForLink{0x01, 0x80, 0xC2, 0, 0, 0x0E};
constexpr Card kAll{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
constexpr Card kOwn{0x02, 0, 10, 0, 0, 1};
constexpr Card kSecond{0x02, 0, 10, 0, 0, 2};
constexpr Card kNobody{0x02, 0, 10, 0, 9, 9};

int open_bound(std::uint16_t protocol, int type = SOCK_RAW) {
  const int fd = socket(AF_PACKET, type, htons(protocol));
  sockaddr_ll name{};
  name.sll_family = AF_PACKET;
  name.sll_ifindex = static_cast<int>(if_nametoindex("eth0"));
  name.sll_protocol = htons(protocol);
  expect(bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0, "bind to eth0");
  return fd;
}

int join(int fd, unsigned short kind, const Card& group) {
  packet_mreq wanted{};
  wanted.mr_ifindex = static_cast<int>(if_nametoindex("eth0"));
  wanted.mr_type = kind;
  wanted.mr_alen = 6;
  std::memcpy(wanted.mr_address, group.data(), group.size());
  return setsockopt(fd, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &wanted, sizeof wanted);
}

std::string frame(const Card& to, const std::string& payload, std::uint16_t protocol = kProtocol) {
  std::string bytes(to.begin(), to.end());
  bytes.append(kOwn.begin(), kOwn.end());
  bytes += static_cast<char>(protocol >> 8);
  bytes += static_cast<char>(protocol & 0xFF);
  return bytes + payload;
}

ssize_t send_frame(int fd, const Card& to, const std::string& payload,
                   std::uint16_t protocol = kProtocol) {
  const std::string bytes = frame(to, payload, protocol);
  return send(fd, bytes.data(), bytes.size(), 0);
}

struct Came {
  std::string bytes;
  Card from{};
  unsigned kind = 0;
};

Came next(int fd, int patience_ms = 50) {
  Came came;
  if (!has_input(fd, patience_ms)) return came;
  char bytes[2000];
  sockaddr_ll from{};
  socklen_t size = sizeof from;
  const ssize_t got =
      recvfrom(fd, bytes, sizeof bytes, MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &size);
  if (got < 0) return came;
  came.bytes = std::string(bytes, static_cast<std::size_t>(got));
  std::memcpy(came.from.data(), from.sll_addr, came.from.size());
  came.kind = from.sll_pkttype;
  return came;
}

// The answers of the two other hosts, or fewer.
int answers(int fd) {
  int count = 0;
  while (!next(fd).bytes.empty()) ++count;
  return count;
}

void check_ways() {
  const int fd = open_bound(kProtocol);
  expect(send_frame(fd, kSecond, "hello") == 19, "a frame leaves");
  const Came came = next(fd);
  expect(came.bytes.size() == 60 && came.bytes.substr(14, 5) == "hello", "it comes padded");
  expect(came.bytes[19] == 0 && came.from == kSecond && came.kind == PACKET_HOST,
         "and says whence");
  expect(answers(fd) == 0, "to one host alone");
  send_frame(fd, kAll, "all");
  expect(answers(fd) == 2, "a broadcast goes to both others");
  send_frame(fd, kGroup, "group");
  expect(answers(fd) == 2, "a group that they have joined, too");
  send_frame(fd, kOtherGroup, "other");
  expect(answers(fd) == 0, "another is flooded, and not taken");
  send_frame(fd, kNobody, "nobody");
  expect(answers(fd) == 0, "nor what is for no card");
  send_frame(fd, kOwn, "self");
  expect(answers(fd) == 0, "nothing comes back from the switch");
  send_frame(fd, kForLink, "link");
  expect(answers(fd) == 0, "the switch does not forward what is for the cable");
  send_frame(fd, kGroup, std::string(1486, 'x'), kOtherProtocol);
  expect(answers(fd) == 0, "of another protocol");
  expect(send_frame(fd, kSecond, std::string(1500, 'x')) == 1514 && next(fd).bytes.size() == 1514,
         "as much as a link carries");
  expect_error(send_frame(fd, kSecond, std::string(1501, 'x')), EMSGSIZE, "and no more");
  close(fd);
}

void check_taking() {
  const int fd = open_bound(kProtocol);
  const int listener = open_bound(kProtocol, SOCK_DGRAM);
  send_frame(fd, kAll, "to group");  // both answer to kOtherGroup
  expect(answers(listener) == 0, "groups that were not joined");
  expect(join(listener, PACKET_MR_MULTICAST, kOtherGroup) == 0, "PACKET_ADD_MEMBERSHIP");
  send_frame(fd, kAll, "to group");
  const Came came = next(listener);
  expect(came.kind == PACKET_MULTICAST && came.bytes.size() == 46 &&
             came.bytes.substr(0, 8) == "to group",
         "come once they are, without heads");
  expect(answers(listener) == 1, "from both");
  expect(answers(fd) == 2, "for all sockets of the host");
  close(listener);
  send_frame(fd, kAll, "to group");
  expect(answers(fd) == 0, "until the socket is closed");
  expect(join(fd, PACKET_MR_ALLMULTI, {}) == 0, "or all groups");
  send_frame(fd, kAll, "to group");
  expect(answers(fd) == 2, "which take any");
  close(fd);
}

void switch_stamps_on(int fd) {
  hwtstamp_config config{};
  ifreq card{};
  std::strcpy(card.ifr_name, "eth0");
  card.ifr_data = reinterpret_cast<char*>(&config);
  config.tx_type = HWTSTAMP_TX_ON;
  config.rx_filter = HWTSTAMP_FILTER_PTP_V2_L2_EVENT;
  expect(ioctl(fd, SIOCSHWTSTAMP, &card) == 0, "SIOCSHWTSTAMP by a packet socket");
}

struct Stamped {
  std::string bytes;
  std::int64_t hardware = 0;
  bool is_error = false;
};

Stamped receive(int fd, int flags) {
  char bytes[2000];
  alignas(cmsghdr) char control[512];
  iovec piece{.iov_base = bytes, .iov_len = sizeof bytes};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  Stamped result;
  const ssize_t size = recvmsg(fd, &message, flags);
  if (size < 0) return result;
  result.bytes = std::string(bytes, static_cast<std::size_t>(size));
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    if (each->cmsg_level == SOL_SOCKET && each->cmsg_type == SCM_TIMESTAMPING) {
      timespec stamps[3];
      std::memcpy(stamps, CMSG_DATA(each), sizeof stamps);
      result.hardware = to_ns(stamps[2]);
    }
    result.is_error |= each->cmsg_level == SOL_PACKET && each->cmsg_type == PACKET_TX_TIMESTAMP;
  }
  return result;
}

void check_stamps() {
  const int clock_fd = open("/dev/ptp0", O_RDWR);
  const clockid_t clock = (~static_cast<clockid_t>(clock_fd) << 3) | 3;
  const int fd = open_bound(kProtocol);
  switch_stamps_on(fd);
  set_number(
      fd, SOL_SOCKET, SO_TIMESTAMPING,
      SOF_TIMESTAMPING_TX_HARDWARE | SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE);
  const std::int64_t before = read_clock(clock);
  send_frame(fd, kSecond, "stamp");
  pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
  expect(poll(&interest, 1, 50) == 1 && interest.revents == POLLERR, "a stamp waits");
  const Stamped left = receive(fd, MSG_ERRQUEUE | MSG_DONTWAIT);
  expect(left.is_error && left.bytes == frame(kSecond, "stamp") && left.hardware > before,
         "with the frame as it left");
  expect(has_input(fd, 50), "the answer");
  const Stamped came = receive(fd, MSG_DONTWAIT);
  expect(!came.is_error && came.hardware > left.hardware && came.hardware < read_clock(clock),
         "is stamped by the card, too");
  send_frame(fd, kForLink, "lost");
  expect(poll(&interest, 1, 50) == 1 && receive(fd, MSG_ERRQUEUE).hardware > came.hardware,
         "what the switch drops has passed the card");
  close(fd);
  close(clock_fd);
}

[[noreturn]] void answer() {
  const int fd = open_bound(kProtocol);
  expect(join(fd, PACKET_MR_MULTICAST, kGroup) == 0, "join");
  expect(join(fd, PACKET_MR_MULTICAST, kForLink) == 0, "join what is for the cable");
  ifreq card{};
  std::strcpy(card.ifr_name, "eth0");
  ioctl(fd, SIOCGIFHWADDR, &card);
  for (;;) {
    char bytes[2000];
    const ssize_t size = recv(fd, bytes, sizeof bytes, 0);
    if (size < 14) continue;
    std::memcpy(bytes, bytes + 6, 6);
    if (std::memcmp(bytes + 14, "to group", 8) == 0) {
      std::memcpy(bytes, kOtherGroup.data(), kOtherGroup.size());
    }
    std::memcpy(bytes + 6, card.ifr_hwaddr.sa_data, 6);
    send(fd, bytes, static_cast<std::size_t>(size), 0);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "answer") == 0) answer();
  sleep(1);
  check_ways();
  check_taking();
  if (access("/dev/ptp0", F_OK) == 0 || count > 2) check_stamps();
  finish();
}

// What netdevice(7), getifaddrs(3), rtnetlink(7), getaddrinfo(3) and their kin promise, and what
// the simulated world says of itself: host N is "hostN", 10.0.0.1 + N, with interfaces lo and eth0.
//
//   interface_calls NUMBER ADDRESS
#include <ifaddrs.h>
#include <linux/ethtool.h>
#include <linux/net_tstamp.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/ioctl.h>
#include <sys/utsname.h>

#include <string>

#include "tests/programs/promises.h"

namespace {

using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::has_input;
using promises::udp;

std::string own_address;

ifreq about(const char* name) {
  ifreq request{};
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  return request;
}

std::string dotted(const sockaddr& name) {
  sockaddr_in in{};
  std::memcpy(&in, &name, sizeof in);
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &in.sin_addr, text, sizeof text);
  return text;
}

void check_requests() {
  const int fd = udp();
  ifreq card = about("eth0");
  expect(ioctl(fd, SIOCGIFINDEX, &card) == 0 && card.ifr_ifindex == 2, "SIOCGIFINDEX");
  expect(ioctl(fd, SIOCGIFADDR, &card) == 0 && dotted(card.ifr_addr) == own_address, "SIOCGIFADDR");
  expect(ioctl(fd, SIOCGIFNETMASK, &card) == 0 && dotted(card.ifr_netmask) == "255.255.0.0",
         "SIOCGIFNETMASK");
  expect(ioctl(fd, SIOCGIFBRDADDR, &card) == 0 && dotted(card.ifr_broadaddr) == "10.0.255.255",
         "SIOCGIFBRDADDR");
  expect(ioctl(fd, SIOCGIFFLAGS, &card) == 0 &&
             (card.ifr_flags & (IFF_UP | IFF_RUNNING | IFF_LOOPBACK)) == (IFF_UP | IFF_RUNNING),
         "SIOCGIFFLAGS");
  expect(ioctl(fd, SIOCGIFMTU, &card) == 0 && card.ifr_mtu == 1500, "SIOCGIFMTU");
  expect(ioctl(fd, SIOCGIFHWADDR, &card) == 0 && card.ifr_hwaddr.sa_data[0] == 2,
         "SIOCGIFHWADDR: locally administered");
  ifreq loopback = about("lo");
  expect(ioctl(fd, SIOCGIFADDR, &loopback) == 0 && dotted(loopback.ifr_addr) == "127.0.0.1", "lo");
  ifreq other = about("eth1");
  expect_error(ioctl(fd, SIOCGIFADDR, &other), ENODEV, "no other interface");
  ifreq places[4];
  ifconf list{};
  list.ifc_len = sizeof places;
  list.ifc_req = places;
  expect(ioctl(fd, SIOCGIFCONF, &list) == 0 && list.ifc_len == 2 * int{sizeof(ifreq)} &&
             std::strcmp(places[1].ifr_name, "eth0") == 0,
         "SIOCGIFCONF");
  close(fd);
}

void check_abilities() {
  const int fd = udp();
  ethtool_ts_info info{};
  info.cmd = ETHTOOL_GET_TS_INFO;
  ifreq card = about("eth0");
  card.ifr_data = reinterpret_cast<char*>(&info);
  expect(ioctl(fd, SIOCETHTOOL, &card) == 0 && (info.so_timestamping & SOF_TIMESTAMPING_SOFTWARE),
         "ETHTOOL_GET_TS_INFO");
  ethtool_link_settings settings{};
  settings.cmd = ETHTOOL_GLINKSETTINGS;
  card.ifr_data = reinterpret_cast<char*>(&settings);
  expect_error(ioctl(fd, SIOCETHTOOL, &card), EOPNOTSUPP, "no speed is stated");
  if (info.phc_index < 0) {
    hwtstamp_config config{};
    card.ifr_data = reinterpret_cast<char*>(&config);
    expect_error(ioctl(fd, SIOCSHWTSTAMP, &card), EOPNOTSUPP, "a card without a clock");
  }
  close(fd);
}

void check_lists() {
  expect(if_nametoindex("eth0") == 2 && if_nametoindex("lo") == 1, "if_nametoindex");
  expect(if_nametoindex("eth1") == 0 && errno == ENODEV, "if_nametoindex of none");
  char name[IFNAMSIZ];
  expect(if_indextoname(2, name) == name && std::strcmp(name, "eth0") == 0, "if_indextoname");
  expect(if_indextoname(3, name) == nullptr && errno == ENXIO, "if_indextoname of none");
  struct if_nameindex* all = if_nameindex();
  expect(all != nullptr && all[1].if_index == 2 && all[2].if_name == nullptr, "if_nameindex");
  if_freenameindex(all);
  ifaddrs* list = nullptr;
  expect(getifaddrs(&list) == 0, "getifaddrs");
  int cards = 0;
  std::string found;
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr->sa_family == AF_PACKET) ++cards;
    if (each->ifa_addr->sa_family != AF_INET) continue;
    found += std::string(each->ifa_name) + "=" + dotted(*each->ifa_addr) + " ";
  }
  expect(cards == 2 && found == "lo=127.0.0.1 eth0=" + own_address + " ", "both, by both families");
  freeifaddrs(list);
}

struct LinkQuestion {
  nlmsghdr head;
  ifinfomsg link;
};

LinkQuestion ask_for(int index, int flags) {
  LinkQuestion question{};
  question.head.nlmsg_len = sizeof question;
  question.head.nlmsg_type = RTM_GETLINK;
  question.head.nlmsg_flags = static_cast<std::uint16_t>(NLM_F_REQUEST | flags);
  question.head.nlmsg_seq = 77;
  question.link.ifi_index = index;
  return question;
}

void check_links() {
  const int fd = socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE);
  sockaddr_nl name{};
  name.nl_family = AF_NETLINK;
  name.nl_groups = RTMGRP_LINK;
  expect(bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0, "a routing socket");
  expect(!has_input(fd, 10), "nothing happens to links");
  LinkQuestion question = ask_for(2, 0);
  expect(send(fd, &question, sizeof question, 0) == sizeof question, "RTM_GETLINK");
  alignas(nlmsghdr) unsigned char bytes[1024];
  expect(has_input(fd), "is answered");
  expect(recv(fd, bytes, sizeof bytes, MSG_PEEK) > 0 && has_input(fd), "MSG_PEEK leaves it");
  expect(recv(fd, bytes, sizeof bytes, 0) > 0, "and read");
  const auto* head = reinterpret_cast<const nlmsghdr*>(bytes);
  const auto* link = static_cast<const ifinfomsg*>(NLMSG_DATA(head));
  expect(head->nlmsg_type == RTM_NEWLINK && head->nlmsg_seq == 77 && link->ifi_index == 2 &&
             (link->ifi_flags & IFF_RUNNING) != 0,
         "eth0 is up");
  expect_error(recv(fd, bytes, sizeof bytes, MSG_DONTWAIT), EAGAIN, "then silence");
  question = ask_for(0, NLM_F_DUMP);
  send(fd, &question, sizeof question, 0);
  ssize_t left = recv(fd, bytes, sizeof bytes, 0);
  int links = 0;
  for (head = reinterpret_cast<const nlmsghdr*>(bytes); NLMSG_OK(head, left);
       head = NLMSG_NEXT(head, left)) {
    if (head->nlmsg_type == RTM_NEWLINK) ++links;
    if (head->nlmsg_type == NLMSG_DONE) break;
  }
  expect(links == 2 && head->nlmsg_type == NLMSG_DONE, "a dump of both links");
  close(fd);
  expect(socket(AF_NETLINK, SOCK_RAW, NETLINK_GENERIC) == -1, "no other protocol");
}

// What a name means, or an error's number.
std::string resolved(const char* node, const char* service, int flags = 0) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = flags;
  addrinfo* list = nullptr;
  const int error = getaddrinfo(node, service, &hints, &list);
  if (error != 0) return std::to_string(error);
  char host[64];
  char port[16];
  expect(list->ai_next == nullptr && list->ai_socktype == SOCK_DGRAM, "as asked for");
  expect(getnameinfo(list->ai_addr, list->ai_addrlen, host, sizeof host, port, sizeof port,
                     NI_NUMERICHOST | NI_NUMERICSERV) == 0,
         "getnameinfo");
  freeaddrinfo(list);
  return std::string(host) + ":" + port;
}

void check_names(const std::string& number) {
  expect(resolved("host0", "ntp") == "10.0.0.1:123", "a host of the world");
  expect(resolved("10.0.0.2", "319", AI_NUMERICHOST) == "10.0.0.2:319", "a dotted quad");
  expect(resolved("localhost", nullptr) == "127.0.0.1:0", "localhost");
  expect(resolved(nullptr, "7", AI_PASSIVE) == "0.0.0.0:7", "AI_PASSIVE");
  expect(resolved("pool.ntp.org", "ntp") == std::to_string(EAI_NONAME), "no other host");
  expect(resolved("host99", nullptr) == std::to_string(EAI_NONAME), "nor one beyond the last");
  expect(resolved("host0", nullptr, AI_NUMERICHOST) == std::to_string(EAI_NONAME),
         "AI_NUMERICHOST");
  expect(resolved("host0", "nonsense") == std::to_string(EAI_SERVICE), "no other service");
  const hostent* entry = gethostbyname("host1");
  expect(entry != nullptr && std::memcmp(entry->h_addr_list[0], "\x0A\x00\x00\x02", 4) == 0,
         "gethostbyname");
  expect(gethostbyname("nobody") == nullptr && h_errno == HOST_NOT_FOUND, "gethostbyname of none");
  char name[64];
  utsname system{};
  expect(gethostname(name, sizeof name) == 0 && name == "host" + number, "gethostname");
  expect(uname(&system) == 0 && system.nodename == "host" + number, "uname");
  expect_error(gethostname(name, 3), ENAMETOOLONG, "a name that is too long");
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) return 2;
  own_address = words[2];
  check_requests();
  check_abilities();
  check_lists();
  check_links();
  check_names(words[1]);
  finish();
}

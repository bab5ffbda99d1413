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
  std::string found6;
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr->sa_family != AF_INET6) continue;
    const auto& address = reinterpret_cast<const sockaddr_in6&>(*each->ifa_addr);
    char text[INET6_ADDRSTRLEN];
    inet_ntop(AF_INET6, &address.sin6_addr, text, sizeof text);
    found6 += std::string(each->ifa_name) + "=" + text + "%" +
              std::to_string(address.sin6_scope_id) + " ";
  }
  const std::string number = std::to_string(std::stoi(own_address.substr(7)));
  expect(found6 == "lo=::1%0 eth0=fd00::" + number + "%0 eth0=fe80::aff:fe00:" + number + "%2 ",
         "by IPv6, the link's own last");
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

struct AddressQuestion {
  nlmsghdr head;
  ifaddrmsg address;
};

// How many addresses of a family there are.
int count_addresses(unsigned char family) {
  const int fd = socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE);
  AddressQuestion question{};
  question.head.nlmsg_len = sizeof question;
  question.head.nlmsg_type = RTM_GETADDR;
  question.head.nlmsg_flags = NLM_F_REQUEST | NLM_F_DUMP;
  question.address.ifa_family = family;
  send(fd, &question, sizeof question, 0);
  alignas(nlmsghdr) unsigned char bytes[2048];
  ssize_t left = recv(fd, bytes, sizeof bytes, 0);
  int addresses = 0;
  for (auto* head = reinterpret_cast<const nlmsghdr*>(bytes); NLMSG_OK(head, left);
       head = NLMSG_NEXT(head, left)) {
    if (head->nlmsg_type == RTM_NEWADDR) ++addresses;
  }
  close(fd);
  return addresses;
}

void check_addresses() {
  expect(count_addresses(AF_INET) == 2, "RTM_GETADDR of IPv4");
  expect(count_addresses(AF_INET6) == 3, "of IPv6");
  expect(count_addresses(AF_UNSPEC) == 5, "of both");
}

// What a name means, in the order of the list, or an error's number.
std::string resolved(const char* node, const char* service, int flags = 0, int family = AF_UNSPEC) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = flags;
  hints.ai_family = family;
  addrinfo* list = nullptr;
  const int error = getaddrinfo(node, service, &hints, &list);
  if (error != 0) return std::to_string(error);
  std::string all;
  for (const addrinfo* each = list; each != nullptr; each = each->ai_next) {
    char host[64];
    char port[16];
    expect(each->ai_socktype == SOCK_DGRAM && each->ai_protocol == IPPROTO_UDP, "as asked for");
    expect(getnameinfo(each->ai_addr, each->ai_addrlen, host, sizeof host, port, sizeof port,
                       NI_NUMERICHOST | NI_NUMERICSERV) == 0,
           "getnameinfo");
    all += std::string(all.empty() ? "" : " ") + host + ":" + port;
  }
  freeaddrinfo(list);
  return all;
}

// The name of an address, or an error's number.
std::string name_of(const char* number, int flags = 0) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST;
  addrinfo* list = nullptr;
  if (getaddrinfo(number, nullptr, &hints, &list) != 0) return "no address";
  char host[64];
  const int error =
      getnameinfo(list->ai_addr, list->ai_addrlen, host, sizeof host, nullptr, 0, flags);
  freeaddrinfo(list);
  return error == 0 ? host : std::to_string(error);
}

void check_names(const std::string& number) {
  expect(resolved("host0", "ntp") == "fd00::1:123 10.0.0.1:123", "a host, by IPv6 first");
  expect(resolved("host0", "ntp", 0, AF_INET) == "10.0.0.1:123", "by IPv4 alone");
  expect(resolved("host0", "ntp", 0, AF_INET6) == "fd00::1:123", "by IPv6 alone");
  expect(resolved("10.0.0.2", "1", AI_V4MAPPED, AF_INET6) == "::ffff:10.0.0.2:1", "mapped");
  expect(resolved("10.0.0.2", "1", 0, AF_INET6) == std::to_string(EAI_ADDRFAMILY),
         "an address of the other family");
  expect(resolved("fe80::aff:fe00:2%eth0", "1") == "fe80::aff:fe00:2%eth0:1", "with its link");
  expect(resolved("fe80::aff:fe00:2%2", "1") == "fe80::aff:fe00:2%eth0:1", "by its number");
  expect(resolved("fe80::aff:fe00:2%eth9", "1") == std::to_string(EAI_NONAME), "no such link");
  expect(resolved("fd00::2%eth0", "1") == std::to_string(EAI_NONAME), "a link without need");
  expect(resolved("10.0.0.2", "319", AI_NUMERICHOST) == "10.0.0.2:319", "a dotted quad");
  expect(resolved("localhost", nullptr) == "::1:0 127.0.0.1:0", "localhost");
  expect(resolved("ip6-localhost", nullptr) == "::1:0", "by IPv6 alone");
  expect(resolved(nullptr, "7", AI_PASSIVE) == "0.0.0.0:7 :::7", "AI_PASSIVE");
  expect(resolved(nullptr, "7") == "::1:7 127.0.0.1:7", "without it, the loopback");
  expect(resolved("pool.ntp.org", "ntp") == std::to_string(EAI_NONAME), "no other host");
  expect(resolved("host99", nullptr) == std::to_string(EAI_NONAME), "nor one beyond the last");
  expect(resolved("host0", nullptr, AI_NUMERICHOST) == std::to_string(EAI_NONAME),
         "AI_NUMERICHOST");
  expect(resolved("host0", "nonsense") == std::to_string(EAI_SERVICE), "no other service");
  const hostent* entry = gethostbyname("host1");
  expect(entry != nullptr && std::memcmp(entry->h_addr_list[0], "\x0A\x00\x00\x02", 4) == 0,
         "gethostbyname");
  const hostent* entry6 = gethostbyname2("host1", AF_INET6);
  expect(entry6 != nullptr && entry6->h_length == 16 && entry6->h_addr_list[0][15] == 2,
         "gethostbyname2");
  hostent own{};
  hostent* result = nullptr;
  char room[512];
  int error = 0;
  expect(gethostbyname_r("host2", &own, room, sizeof room, &result, &error) == 0 &&
             result == &own && own.h_addr_list[0][3] == 3,
         "gethostbyname_r");
  expect(gethostbyname_r("host2", &own, room, 8, &result, &error) == ERANGE, "needs room");
  const in_addr second{.s_addr = htonl(0x0A000002)};
  entry = gethostbyaddr(&second, sizeof second, AF_INET);
  expect(entry != nullptr && std::string(entry->h_name) == "host1", "gethostbyaddr");
  expect(name_of("fd00::3") == "host2" && name_of("10.0.0.3") == "host2" &&
             name_of("::1") == "localhost",
         "names of addresses");
  expect(name_of("fe80::aff:fe00:2%eth0") == "fe80::aff:fe00:2%eth0", "or their numbers");
  expect(name_of("fd00::77", NI_NAMEREQD) == std::to_string(EAI_NONAME), "nobody's");
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
  check_addresses();
  check_names(words[1]);
  finish();
}

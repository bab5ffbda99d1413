#include "shim/interfaces.h"

#include <arpa/inet.h>
#include <errno.h>
#include <ifaddrs.h>
#include <linux/ethtool.h>
#include <linux/net_tstamp.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netpacket/packet.h>
#include <stdio.h>
#include <string.h>

#include "shim/sockets.h"

namespace simbench::shim {

int interfaces() {
  const int all = 1 + static_cast<int>(identity().cards);
  return all < kMostInterfaces ? all : kMostInterfaces;
}

namespace {

InterfaceFacts loopback() {
  InterfaceFacts facts{};
  facts.index = kLoopbackInterface;
  snprintf(facts.name, sizeof facts.name, "lo");
  facts.address = INADDR_LOOPBACK;
  facts.netmask = 0xFF000000;
  facts.flags = IFF_UP | IFF_LOOPBACK | IFF_RUNNING;
  facts.hardware = ARPHRD_LOOPBACK;
  facts.mtu = static_cast<int>(kLoopbackMtu);
  facts.has_carrier = true;
  facts.addresses6 = 1;
  facts.address6[0] = kLoopback6;
  facts.prefix6 = 128;
  return facts;
}

IpAddress own_unique_local() {
  return unique_local(identity().address - identity().first_address + 1);
}

InterfaceFacts card(std::uint32_t number) {
  InterfaceFacts facts{};
  facts.index = kFirstCard + number;
  snprintf(facts.name, sizeof facts.name, "eth%u", number);
  facts.has_carrier = (identity().carriers & (1U << number)) != 0;
  facts.flags = IFF_UP | IFF_BROADCAST | IFF_MULTICAST;
  if (facts.has_carrier) facts.flags |= IFF_RUNNING;
  facts.hardware = ARPHRD_ETHER;
  facts.mtu = static_cast<int>(kLinkMtu);
  write_card_address(identity().address, number, facts.mac);
  if (number > 0) return facts;
  facts.address = identity().address;
  facts.netmask = identity().netmask;
  facts.broadcast = facts.address | ~facts.netmask;
  facts.addresses6 = 2;
  facts.address6[0] = own_unique_local();
  facts.address6[1] = link_local(identity().address);
  facts.prefix6 = 64;
  return facts;
}

}  // namespace

InterfaceFacts interface_at(int place) {
  return place == 0 ? loopback() : card(static_cast<std::uint32_t>(place - 1));
}

bool is_own_address(const IpAddress& address) {
  return address == mapped(identity().address) || address == own_unique_local() ||
         address == link_local(identity().address);
}

namespace {

template <class Matches>
bool find_matching(Matches matches, InterfaceFacts& found) {
  for (int i = 0; i < interfaces(); ++i) {
    found = interface_at(i);
    if (matches(found)) return true;
  }
  errno = ENODEV;
  return false;
}

}  // namespace

bool find_interface(const char* name, InterfaceFacts& found) {
  return find_matching(
      [name](const InterfaceFacts& each) { return strncmp(name, each.name, IFNAMSIZ) == 0; },
      found);
}

bool find_interface(unsigned index, InterfaceFacts& found) {
  return find_matching([index](const InterfaceFacts& each) { return each.index == index; }, found);
}

namespace {

sockaddr_in internet(std::uint32_t address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(address);
  return result;
}

template <class Address>
void store(sockaddr& place, const Address& address) {
  static_assert(sizeof address <= sizeof place);
  memcpy(&place, &address, sizeof address);
}

// The interfaces that have an address.
int list_interfaces(ifconf& list) {
  const int room = list.ifc_buf == nullptr ? kMostInterfaces : list.ifc_len / int{sizeof(ifreq)};
  int count = 0;
  for (int i = 0; i < interfaces() && count < room; ++i) {
    const InterfaceFacts facts = interface_at(i);
    if (facts.address == 0) continue;
    if (list.ifc_buf != nullptr) {
      ifreq& entry = list.ifc_req[count];
      entry = {};
      snprintf(entry.ifr_name, IFNAMSIZ, "%s", facts.name);
      store(entry.ifr_addr, internet(facts.address));
    }
    ++count;
  }
  list.ifc_len = count * int{sizeof(ifreq)};
  return 0;
}

// What the card and the kernel can stamp.
int state_stamping(ethtool_ts_info& info) {
  info = {};
  info.cmd = ETHTOOL_GET_TS_INFO;
  info.so_timestamping =
      SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  info.phc_index = -1;
  if (identity().has_card_clock == 0) return 0;
  info.so_timestamping |=
      SOF_TIMESTAMPING_TX_HARDWARE | SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
  info.phc_index = 0;
  info.tx_types = 1U << HWTSTAMP_TX_OFF | 1U << HWTSTAMP_TX_ON;
  info.rx_filters = 1U << HWTSTAMP_FILTER_NONE | 1U << HWTSTAMP_FILTER_ALL;
  return 0;
}

int ask_ethtool(const InterfaceFacts& facts, const ifreq& request) {
  if (request.ifr_data == nullptr) return refuse(EFAULT);
  std::uint32_t command = 0;
  memcpy(&command, request.ifr_data, sizeof command);
  if (command != ETHTOOL_GET_TS_INFO || facts.index < kFirstCard) return refuse(EOPNOTSUPP);
  return state_stamping(*reinterpret_cast<ethtool_ts_info*>(request.ifr_data));
}

constexpr std::int64_t kReadStamping = -1;

// The card stamps everything or nothing; a filter that asks for less gets all, as drivers may.
int set_stamping(hwtstamp_config& config) {
  if (config.flags != 0) return refuse(EINVAL);
  if (config.tx_type != HWTSTAMP_TX_OFF && config.tx_type != HWTSTAMP_TX_ON) return refuse(ERANGE);
  if (config.rx_filter < 0 || config.rx_filter > HWTSTAMP_FILTER_NTP_ALL) return refuse(ERANGE);
  if (config.rx_filter != HWTSTAMP_FILTER_NONE) config.rx_filter = HWTSTAMP_FILTER_ALL;
  const std::int64_t wanted = (config.rx_filter != HWTSTAMP_FILTER_NONE ? 1 : 0) |
                              (config.tx_type != HWTSTAMP_TX_OFF ? 2 : 0);
  return ask({.call = Call::kCardStamping, .a = wanted}) < 0 ? -1 : 0;
}

int get_stamping(hwtstamp_config& config) {
  const std::int64_t now = ask({.call = Call::kCardStamping, .a = kReadStamping});
  if (now < 0) return -1;
  config = {};
  config.tx_type = (now & 2) != 0 ? HWTSTAMP_TX_ON : HWTSTAMP_TX_OFF;
  config.rx_filter = (now & 1) != 0 ? HWTSTAMP_FILTER_ALL : HWTSTAMP_FILTER_NONE;
  return 0;
}

int ask_card_stamping(const InterfaceFacts& facts, unsigned long what, const ifreq& request) {
  if (facts.index < kFirstCard || identity().has_card_clock == 0) return refuse(EOPNOTSUPP);
  if (request.ifr_data == nullptr) return refuse(EFAULT);
  auto& config = *reinterpret_cast<hwtstamp_config*>(request.ifr_data);
  return what == SIOCSHWTSTAMP ? set_stamping(config) : get_stamping(config);
}

int ask_interface(unsigned long what, ifreq& request) {
  InterfaceFacts facts{};
  if (what == SIOCGIFNAME) {
    if (!find_interface(static_cast<unsigned>(request.ifr_ifindex), facts)) return -1;
    snprintf(request.ifr_name, IFNAMSIZ, "%s", facts.name);
    return 0;
  }
  if (!find_interface(request.ifr_name, facts)) return -1;
  const bool asks_for_address =
      what == SIOCGIFADDR || what == SIOCGIFNETMASK || what == SIOCGIFBRDADDR;
  if (asks_for_address && facts.address == 0) return refuse(EADDRNOTAVAIL);
  switch (what) {
    case SIOCGIFINDEX:
      request.ifr_ifindex = static_cast<int>(facts.index);
      return 0;
    case SIOCGIFADDR:
      store(request.ifr_addr, internet(facts.address));
      return 0;
    case SIOCGIFNETMASK:
      store(request.ifr_netmask, internet(facts.netmask));
      return 0;
    case SIOCGIFBRDADDR:
      store(request.ifr_broadaddr, internet(facts.broadcast));
      return 0;
    case SIOCGIFFLAGS:
      request.ifr_flags = static_cast<short>(facts.flags);
      return 0;
    case SIOCGIFMTU:
      request.ifr_mtu = facts.mtu;
      return 0;
    case SIOCGIFHWADDR:
      request.ifr_hwaddr.sa_family = facts.hardware;
      memcpy(request.ifr_hwaddr.sa_data, facts.mac, kMacBytes);
      return 0;
    case SIOCETHTOOL:
      return ask_ethtool(facts, request);
    case SIOCSHWTSTAMP:
    case SIOCGHWTSTAMP:
      return ask_card_stamping(facts, what, request);
    default:
      return refuse(EOPNOTSUPP);
  }
}

}  // namespace

bool is_about_interfaces(unsigned long what) {
  return (what >= SIOCGIFNAME && what <= SIOCSIFMAP) || what == SIOCETHTOOL ||
         what == SIOCSHWTSTAMP || what == SIOCGHWTSTAMP;
}

int interface_ioctl(unsigned long what, void* argument) {
  if (what == SIOCGIFCONF) return list_interfaces(*static_cast<ifconf*>(argument));
  return ask_interface(what, *static_cast<ifreq*>(argument));
}

SIMBENCH_CALL unsigned int if_nametoindex(const char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(if_nametoindex)(name);
  InterfaceFacts facts{};
  return find_interface(name, facts) ? facts.index : 0;
}

SIMBENCH_CALL char* if_indextoname(unsigned int index, char* name) {
  if (!is_simulated()) return SIMBENCH_REAL(if_indextoname)(index, name);
  InterfaceFacts facts{};
  if (!find_interface(index, facts)) {
    errno = ENXIO;
    return nullptr;
  }
  snprintf(name, IFNAMSIZ, "%s", facts.name);
  return name;
}

SIMBENCH_CALL struct if_nameindex* if_nameindex() {
  if (!is_simulated()) return SIMBENCH_REAL(if_nameindex)();
  static struct if_nameindex list[kMostInterfaces + 1];
  static char names[kMostInterfaces][IFNAMSIZ];
  for (int i = 0; i < interfaces(); ++i) {
    const InterfaceFacts facts = interface_at(i);
    snprintf(names[i], IFNAMSIZ, "%s", facts.name);
    list[i] = {facts.index, names[i]};
  }
  list[interfaces()] = {};
  return list;
}

SIMBENCH_CALL void if_freenameindex(struct if_nameindex* list) {
  if (!is_simulated()) SIMBENCH_REAL(if_freenameindex)(list);
}

namespace {

// An interface as getifaddrs() lists it: its card, and its addresses.
struct Listed {
  ifaddrs card;
  ifaddrs internet;
  ifaddrs internet6[kMostAddresses6];
  char name[IFNAMSIZ];
  sockaddr_ll link;
  sockaddr_in address;
  sockaddr_in netmask;
  sockaddr_in broadcast;
  sockaddr_in6 address6[kMostAddresses6];
  sockaddr_in6 netmask6;
};
Listed listed[kMostInterfaces];

sockaddr_in6 internet6(const IpAddress& address, unsigned scope) {
  sockaddr_in6 result{};
  result.sin6_family = AF_INET6;
  memcpy(&result.sin6_addr, &address, sizeof result.sin6_addr);
  result.sin6_scope_id = scope;
  return result;
}

void fill_listed6(Listed& entry, const InterfaceFacts& facts) {
  entry.netmask6 = internet6({}, 0);
  for (int i = 0; i < facts.prefix6 / 8; ++i) entry.netmask6.sin6_addr.s6_addr[i] = 0xFF;
  for (int i = 0; i < facts.addresses6; ++i) {
    const IpAddress& address = facts.address6[i];
    entry.address6[i] = internet6(address, is_link_local(address) ? facts.index : 0);
    entry.internet6[i] = entry.card;
    entry.internet6[i].ifa_addr = reinterpret_cast<sockaddr*>(&entry.address6[i]);
    entry.internet6[i].ifa_netmask = reinterpret_cast<sockaddr*>(&entry.netmask6);
  }
}

void fill_listed(Listed& entry, const InterfaceFacts& facts) {
  entry = {};
  snprintf(entry.name, IFNAMSIZ, "%s", facts.name);
  entry.link.sll_family = AF_PACKET;
  entry.link.sll_ifindex = static_cast<int>(facts.index);
  entry.link.sll_hatype = facts.hardware;
  entry.link.sll_halen = kMacBytes;
  memcpy(entry.link.sll_addr, facts.mac, kMacBytes);
  entry.address = internet(facts.address);
  entry.netmask = internet(facts.netmask);
  entry.broadcast = internet(facts.broadcast);
  entry.card.ifa_name = entry.name;
  entry.card.ifa_flags = facts.flags;
  entry.card.ifa_addr = reinterpret_cast<sockaddr*>(&entry.link);
  entry.internet = entry.card;
  entry.internet.ifa_addr = reinterpret_cast<sockaddr*>(&entry.address);
  entry.internet.ifa_netmask = reinterpret_cast<sockaddr*>(&entry.netmask);
  if ((facts.flags & IFF_BROADCAST) != 0) {
    entry.internet.ifa_broadaddr = reinterpret_cast<sockaddr*>(&entry.broadcast);
  }
  fill_listed6(entry, facts);
}

}  // namespace

// The cards, then their addresses by IPv4, then by IPv6. The list is the same at each call, and
// lives as long as the program.
SIMBENCH_CALL int getifaddrs(ifaddrs** list) {
  if (!is_simulated()) return SIMBENCH_REAL(getifaddrs)(list);
  ifaddrs** next = list;
  const auto append = [&next](ifaddrs& entry) {
    *next = &entry;
    next = &entry.ifa_next;
  };
  for (int i = 0; i < interfaces(); ++i) {
    fill_listed(listed[i], interface_at(i));
    append(listed[i].card);
  }
  for (int i = 0; i < interfaces(); ++i) {
    if (interface_at(i).address != 0) append(listed[i].internet);
  }
  for (int i = 0; i < interfaces(); ++i) {
    for (int k = 0; k < interface_at(i).addresses6; ++k) append(listed[i].internet6[k]);
  }
  *next = nullptr;
  return 0;
}

SIMBENCH_CALL void freeifaddrs(ifaddrs* list) {
  if (!is_simulated()) SIMBENCH_REAL(freeifaddrs)(list);
}

}  // namespace simbench::shim

#include "hardware/experiment/network_sandbox.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <linux/veth.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>

#include "hardware/descriptor.h"
#include "processes/placeholders.h"

namespace simbench::hardware {
namespace {

constexpr const char* kMemberInterface = "eth0";
constexpr std::uint32_t kNetwork = 10u << 24 | 77u << 16;
constexpr std::uint32_t kMask = 0xfffffffc;  // four addresses a pair

std::uint32_t side_address(unsigned member, unsigned side) { return kNetwork | member << 8 | side; }

std::string dotted(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 255, address >> 8 & 255,
                     address & 255);
}

std::string interface_of(unsigned member) { return fmt::format("hub{}", member); }

[[noreturn]] void fail_call(const std::string& doing) {
  throw SandboxError(fmt::format("{}: {}", doing, std::strerror(errno)));
}

// Async-signal-safe. An address of 0: none.
bool set_up(const char* interface, std::uint32_t address, std::uint32_t mask = kMask) {
  const Descriptor opened(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!opened.good()) return false;
  const int socket = opened.number();
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  auto* internet = reinterpret_cast<sockaddr_in*>(&request.ifr_addr);
  bool good = true;
  if (address != 0) {
    internet->sin_family = AF_INET;
    internet->sin_addr.s_addr = htonl(address);
    good = ioctl(socket, SIOCSIFADDR, &request) == 0;
    internet->sin_family = AF_INET;
    internet->sin_addr.s_addr = htonl(mask);
    good = good && ioctl(socket, SIOCSIFNETMASK, &request) == 0;
  }
  good = good && ioctl(socket, SIOCGIFFLAGS, &request) == 0;
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP);
  good = good && ioctl(socket, SIOCSIFFLAGS, &request) == 0;
  return good;
}

// Async-signal-safe.
bool write_file(const char* path, std::string_view text) {
  const Descriptor file(open(path, O_WRONLY | O_CLOEXEC));
  return file.good() &&
         write(file.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

// A request to the kernel's routing socket, put together attribute by attribute.
class LinkRequest {
 public:
  LinkRequest(std::uint16_t type, std::uint16_t flags) {
    nlmsghdr header{};
    header.nlmsg_type = type;
    header.nlmsg_flags = static_cast<std::uint16_t>(NLM_F_REQUEST | NLM_F_ACK | flags);
    put(header);
    put(ifinfomsg{});
  }

  void add(std::uint16_t type, std::span<const char> value) {
    const std::size_t begin = open(type);
    append(value.data(), value.size());
    close_at(begin);
  }
  void add(std::uint16_t type, const std::string& text) {
    add(type, std::span(text.c_str(), text.size() + 1));
  }
  void add(std::uint16_t type, std::uint32_t number) {
    add(type, std::span(reinterpret_cast<const char*>(&number), sizeof number));
  }
  // Attributes until close_at(the result) are inside this one.
  std::size_t open(std::uint16_t type) {
    const std::size_t begin = size_;
    rtattr attribute{};
    attribute.rta_type = type;
    put(attribute);
    return begin;
  }
  void close_at(std::size_t begin) {
    const auto length = static_cast<std::uint16_t>(size_ - begin);
    std::memcpy(buffer_.data() + begin + offsetof(rtattr, rta_len), &length, sizeof length);
    while (size_ % RTA_ALIGNTO != 0) buffer_[size_++] = 0;
  }
  template <class Header>
  void put(const Header& header) {
    append(&header, sizeof header);
  }

  // 0, or the error the kernel answered.
  int send() {
    const auto length = static_cast<std::uint32_t>(size_);
    std::memcpy(buffer_.data(), &length, sizeof length);
    const Descriptor socket(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
    if (!socket.good()) return errno;
    sockaddr_nl kernel{};
    kernel.nl_family = AF_NETLINK;
    if (sendto(socket.number(), buffer_.data(), size_, 0, reinterpret_cast<sockaddr*>(&kernel),
               sizeof kernel) < 0) {
      return errno;
    }
    alignas(nlmsghdr) std::array<char, 4096> answer{};
    if (recv(socket.number(), answer.data(), answer.size(), 0) <
        static_cast<ssize_t>(sizeof(nlmsghdr) + sizeof(nlmsgerr))) {
      return EBADMSG;
    }
    nlmsgerr error{};
    std::memcpy(&error, answer.data() + sizeof(nlmsghdr), sizeof error);
    return -error.error;
  }

 private:
  void append(const void* data, std::size_t size) {
    std::memcpy(buffer_.data() + size_, data, size);
    size_ += size;
  }

  alignas(nlmsghdr) std::array<char, 512> buffer_{};
  std::size_t size_ = 0;
};

int add_pair(const std::string& interface, const char* member_interface, pid_t process) {
  LinkRequest request(RTM_NEWLINK, NLM_F_CREATE | NLM_F_EXCL);
  request.add(IFLA_IFNAME, interface);
  const std::size_t info = request.open(IFLA_LINKINFO);
  request.add(IFLA_INFO_KIND, std::span("veth", 4));
  const std::size_t data = request.open(IFLA_INFO_DATA);
  const std::size_t peer = request.open(VETH_INFO_PEER);
  request.put(ifinfomsg{});
  request.add(IFLA_IFNAME, std::string(member_interface));
  request.add(IFLA_NET_NS_PID, static_cast<std::uint32_t>(process));
  request.close_at(peer);
  request.close_at(data);
  request.close_at(info);
  return request.send();
}

void remove_pair(const std::string& interface) {
  LinkRequest request(RTM_DELLINK, 0);
  request.add(IFLA_IFNAME, interface);
  request.send();  // mostly there is none
}

void connect_pair(unsigned member, const std::string& interface, const char* member_interface,
                  std::uint32_t address, pid_t process) {
  if (member >= NetworkSandbox::kMaxMembers) {
    throw SandboxError(
        fmt::format("member {}: allowed: below {}", member, NetworkSandbox::kMaxMembers));
  }
  remove_pair(interface);
  errno = add_pair(interface, member_interface, process);
  if (errno != 0) fail_call("making a veth pair");
  if (!set_up(interface.c_str(), address)) fail_call("setting up " + interface);
}

}  // namespace

std::optional<std::string> NetworkSandbox::enter() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (unshare(CLONE_NEWNET) != 0) {
    if (errno != EPERM || unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
      return fmt::format("no network namespace: {}", std::strerror(errno));
    }
    // In the new user namespace this process is root; outside it stays the same user.
    write_file("/proc/self/setgroups", "deny");
    if (!write_file("/proc/self/uid_map", fmt::format("0 {} 1", user)) ||
        !write_file("/proc/self/gid_map", fmt::format("0 {} 1", group))) {
      fail_call("writing the user namespace's map");
    }
  }
  if (!set_up("lo", 0)) fail_call("setting up lo in a new network namespace");
  return std::nullopt;
}

std::string NetworkSandbox::hub_address(unsigned member) { return dotted(side_address(member, 1)); }

std::string NetworkSandbox::member_address(unsigned member) {
  return dotted(side_address(member, 2));
}

bool NetworkSandbox::leave_hub() { return unshare(CLONE_NEWNET) == 0; }

std::string NetworkSandbox::wire(unsigned member) { return fmt::format("wire{}", member); }

void NetworkSandbox::connect(unsigned member, pid_t process) {
  connect_pair(member, interface_of(member), kMemberInterface, side_address(member, 1), process);
}

void NetworkSandbox::connect_wire(unsigned member, pid_t process) {
  connect_pair(member, wire(member), kWireInterface, 0, process);
}

bool NetworkSandbox::set_up_member(unsigned member) {
  return set_up("lo", 0) && set_up(kMemberInterface, side_address(member, 2));
}

bool NetworkSandbox::set_up_wire(unsigned member) {
  return set_up(kWireInterface, processes::address_of(member), processes::kNetmask) &&
         write_file("/proc/sys/net/ipv4/ip_unprivileged_port_start", "0");
}

}  // namespace simbench::hardware

// Datagrams on the loopback as ip(7), ipv6(7), udp(7) and socket(7) have them: closed ports, error
// queues, associations that are dissolved, large datagrams, both families.
#include <arpa/inet.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <time.h>

#include <initializer_list>
#include <utility>

#include "tests/programs/twin.h"

namespace {

using namespace twin;

struct Family {
  const char* name;
  int family;
  const char* loopback;
  const char* any;
  int level;
  int receive_errors;
  int discover_mtu;
  int mtu;
};
constexpr Family kFamilies[] = {
    {"v4", AF_INET, "127.0.0.1", "0.0.0.0", IPPROTO_IP, IP_RECVERR, IP_MTU_DISCOVER, IP_MTU},
    {"v6", AF_INET6, "::1", "::", IPPROTO_IPV6, IPV6_RECVERR, IPV6_MTU_DISCOVER, IPV6_MTU},
};

int open_socket(const Family& family) { return socket(family.family, SOCK_DGRAM, 0); }

// Addresses and interface, as far as the head has them.
std::string describe_facts(const cmsghdr& head) {
  char host[INET6_ADDRSTRLEN] = "";
  std::string text;
  if (head.cmsg_level == IPPROTO_IP && head.cmsg_type == IP_PKTINFO) {
    in_pktinfo facts{};
    std::memcpy(&facts, CMSG_DATA(&head), sizeof facts);
    text = " interface " + std::to_string(facts.ipi_ifindex);
    for (const in_addr& address : {facts.ipi_spec_dst, facts.ipi_addr}) {
      text += std::string(" ") + inet_ntop(AF_INET, &address, host, sizeof host);
    }
  } else if (head.cmsg_level == IPPROTO_IPV6 && head.cmsg_type == IPV6_PKTINFO) {
    in6_pktinfo facts{};
    std::memcpy(&facts, CMSG_DATA(&head), sizeof facts);
    text = " interface " + std::to_string(facts.ipi6_ifindex) + " " +
           inet_ntop(AF_INET6, &facts.ipi6_addr, host, sizeof host);
  }
  return text;
}

std::string describe_error(const msghdr& message) {
  std::string text;
  auto& readable = const_cast<msghdr&>(message);
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&readable, each)) {
    const bool is_v4 = each->cmsg_level == IPPROTO_IP && each->cmsg_type == IP_RECVERR;
    const bool is_v6 = each->cmsg_level == IPPROTO_IPV6 && each->cmsg_type == IPV6_RECVERR;
    if (!is_v4 && !is_v6) {
      text += " level " + std::to_string(each->cmsg_level) + " type " +
              std::to_string(each->cmsg_type) + describe_facts(*each);
      continue;
    }
    struct {
      sock_extended_err error;
      sockaddr_in6 offender;
    } found{};
    const std::size_t size = each->cmsg_len - CMSG_LEN(0);
    std::memcpy(&found, CMSG_DATA(each), size < sizeof found ? size : sizeof found);
    char host[INET6_ADDRSTRLEN] = "nobody";
    if (found.offender.sin6_family == AF_INET6) {
      inet_ntop(AF_INET6, &found.offender.sin6_addr, host, sizeof host);
    } else if (found.offender.sin6_family == AF_INET) {
      inet_ntop(AF_INET, &reinterpret_cast<sockaddr_in&>(found.offender).sin_addr, host,
                sizeof host);
    }
    const sock_extended_err& error = found.error;
    text += std::string(" ") + strerrorname_np(static_cast<int>(error.ee_errno)) + " origin " +
            std::to_string(error.ee_origin) + " type " + std::to_string(error.ee_type) + " code " +
            std::to_string(error.ee_code) + " info " + std::to_string(error.ee_info) + " data " +
            std::to_string(error.ee_data) + " of " + host + " size " + std::to_string(size);
  }
  return text;
}

// The next message of the error queue.
class QueuedError {
 public:
  explicit QueuedError(int fd) {
    message_.msg_name = to_.name();
    message_.msg_namelen = *to_.room();
    message_.msg_iov = &piece_;
    message_.msg_iovlen = 1;
    message_.msg_control = control_;
    message_.msg_controllen = sizeof control_;
    size_ = recvmsg(fd, &message_, MSG_ERRQUEUE);
    if (size_ >= 0) *to_.room() = message_.msg_namelen;
  }
  ssize_t size() const { return size_; }  // -1: there is none, errno says why
  const msghdr& message() const { return message_; }
  std::string bytes() const { return {bytes_, static_cast<std::size_t>(size_)}; }
  std::string receiver() { return message_.msg_namelen == 0 ? "no name" : to_.text(); }

 private:
  char bytes_[70'000];
  alignas(cmsghdr) char control_[512];
  Name to_;
  iovec piece_{.iov_base = bytes_, .iov_len = sizeof bytes_};
  msghdr message_{};
  ssize_t size_ = -1;
};

std::string error_of_queue(int fd) {
  QueuedError error(fd);
  if (error.size() < 0) return strerrorname_np(errno);
  return std::to_string(error.size()) + " bytes to " + error.receiver() + " flags " +
         std::to_string(error.message().msg_flags) + describe_error(error.message());
}

// A connected socket hears that nobody is there, once.
void refuse_connected(const Family& family) {
  const int fd = open_socket(family);
  say("connect", connect_to(fd, Name(family.loopback, 9)));
  say("first send", send(fd, "one", 3, 0));
  tell("events", events_of(fd, POLLIN));
  say("second send", send(fd, "two", 3, 0));
  say("third send", send(fd, "three", 5, 0));
  char byte = 0;
  say("receive", recv(fd, &byte, 1, 0));
  say("again", recv(fd, &byte, 1, MSG_DONTWAIT));
  say("fourth send", send(fd, "four", 4, 0));
  tell("SO_ERROR", number_of(fd, SOL_SOCKET, SO_ERROR));
  tell("SO_ERROR again", number_of(fd, SOL_SOCKET, SO_ERROR));
  tell("events", events_of(fd, POLLIN | POLLOUT));
  close(fd);
}

void refuse_unconnected(const Family& family) {
  const int fd = open_socket(family);
  say("send to a closed port", send_to(fd, "x", Name(family.loopback, 9)));
  say("and again", send_to(fd, "x", Name(family.loopback, 9)));
  tell("events", events_of(fd, POLLIN | POLLOUT));
  tell("SO_ERROR", number_of(fd, SOL_SOCKET, SO_ERROR));
  tell("queue", error_of_queue(fd));
  say("port 0", send_to(fd, "x", Name(family.loopback, 0)));
  close(fd);
}

void queue_errors(const Family& family) {
  const int fd = open_socket(family);
  say("receive errors", set_number(fd, family.level, family.receive_errors, 1));
  tell("as read back", number_of(fd, family.level, family.receive_errors));
  say("send", send_to(fd, "first", Name(family.loopback, 9)));
  say("send", send_to(fd, "second", Name(family.loopback, 9)));
  tell("events", events_of(fd, POLLIN | POLLOUT));
  tell("queue", error_of_queue(fd));
  tell("events", events_of(fd, POLLIN | POLLOUT));
  say("send", send_to(fd, "third", Name(family.loopback, 10)));
  say("send", send_to(fd, "fourth", Name(family.loopback, 10)));
  tell("SO_ERROR", number_of(fd, SOL_SOCKET, SO_ERROR));
  tell("queue", error_of_queue(fd));
  tell("queue", error_of_queue(fd));
  tell("queue", error_of_queue(fd));
  tell("events", events_of(fd, POLLIN | POLLOUT));
  send_to(fd, std::string(2000, 'x'), Name(family.loopback, 9));
  tell("a long one", error_of_queue(fd));
  close(fd);
}

void dissolve_association(const Family& family) {
  const int server = open_socket(family);
  bind_to(server, Name(family.loopback, 4000));
  const int fd = open_socket(family);
  tell("own", own_name(fd));
  tell("peer", peer_name(fd));
  say("dissolve nothing", dissolve(fd));
  say("connect", connect_to(fd, Name(family.loopback, 4000)));
  tell("own", own_name(fd));
  tell("peer", peer_name(fd));
  say("connect again", connect_to(fd, Name(family.loopback, 9)));
  tell("peer", peer_name(fd));
  say("dissolve", dissolve(fd));
  tell("own", own_name(fd));
  tell("peer", peer_name(fd));
  say("send to nobody", send(fd, "x", 1, 0));
  say("send", send_to(fd, "x", Name(family.loopback, 4000)));
  tell("server", received(server));
  close(fd);
  const int bound = open_socket(family);
  bind_to(bound, Name(family.any, 4001));
  connect_to(bound, Name(family.loopback, 4000));
  tell("bound to a port", own_name(bound));
  say("dissolve", dissolve(bound));
  tell("bound to a port", own_name(bound));
  connect_to(bound, Name(family.loopback, 4000));
  say("another sends", send_to(server, "x", Name(family.loopback, 4001)));
  tell("peer's", received(bound));
  const int stranger = open_socket(family);
  say("a stranger sends", send_to(stranger, "y", Name(family.loopback, 4001)));
  tell("not heard", received(bound, MSG_DONTWAIT));
  dissolve(bound);
  say("a stranger sends", send_to(stranger, "y", Name(family.loopback, 4001)));
  tell("heard", received(bound));
  for (const int each : {server, bound, stranger}) close(each);
}

void send_large(const Family& family) {
  const int server = open_socket(family);
  bind_to(server, Name(family.loopback, 4000));
  const int fd = open_socket(family);
  connect_to(fd, Name(family.loopback, 4000));
  tell("MTU", number_of(fd, family.level, family.mtu));
  tell("MTU of no peer", number_of(server, family.level, family.mtu));
  for (const std::size_t size :
       {1472u, 1473u, 40'000u, 65'507u, 65'508u, 65'527u, 65'528u, 66'000u}) {
    const std::string large(size, 'x');
    say("send", send(fd, large.data(), large.size(), 0));
    tell("received", received(server, MSG_DONTWAIT));
  }
  tell("default", number_of(fd, family.level, family.discover_mtu));
  for (const int mode : {0, 1, 2, 3, 4, 5, 6, -1}) {
    say("IP_MTU_DISCOVER", set_number(fd, family.level, family.discover_mtu, mode));
    say("send", send(fd, std::string(60'000, 'x').data(), 60'000, 0));
    tell("received", received(server, MSG_DONTWAIT));
  }
  say("cut", send(fd, "abcdef", 6, 0));
  tell("cut", received(server, 0, 3));
  say("cut, whole length", send(fd, "abcdef", 6, 0));
  tell("cut, whole length", received(server, MSG_TRUNC, 3));
  say("empty", send(fd, "", 0, 0));
  tell("empty", received(server));
  for (const int each : {server, fd}) close(each);
}

void shut_down(const Family& family) {
  const int fd = open_socket(family);
  bind_to(fd, Name(family.loopback, 4000));
  say("not connected", shutdown(fd, SHUT_RD));
  char byte = 0;
  say("a blocking read ends", recv(fd, &byte, 1, 0));
  say("one that does not wait", recv(fd, &byte, 1, MSG_DONTWAIT));
  tell("events", events_of(fd, POLLIN | POLLOUT | POLLRDHUP));
  close(fd);
  const int both = open_socket(family);
  bind_to(both, Name(family.loopback, 4000));
  connect_to(both, Name(family.loopback, 4000));
  send(both, "left", 4, 0);
  say("connected", shutdown(both, SHUT_WR));
  say("send", send(both, "x", 1, MSG_NOSIGNAL));
  tell("events", events_of(both, POLLIN | POLLOUT | POLLRDHUP));
  tell("what had come", received(both));
  say("both", shutdown(both, SHUT_RDWR));
  tell("events", events_of(both, POLLIN | POLLOUT | POLLRDHUP));
  say("nonsense", shutdown(both, 7));
  close(both);
}

void bind_in_vain(const Family& family) {
  const int fd = open_socket(family);
  const bool is_v6 = family.family == AF_INET6;
  say("no such address", bind_to(fd, Name(is_v6 ? "fd77::9" : "192.0.2.77", 4000)));
  say("the other family", bind_to(fd, Name(is_v6 ? "127.0.0.1" : "::1", 4000)));
  Name name(family.loopback, 4000);
  say("too short", bind(fd, name.name(), 10));
  say("no name", bind(fd, nullptr, 0));
  reinterpret_cast<sockaddr_in*>(name.name())->sin_family = AF_UNSPEC;
  say("no family", bind(fd, name.name(), name.size()));
  say("bind", bind_to(fd, Name(family.loopback, 4000)));
  say("twice", bind_to(fd, Name(family.loopback, 4001)));
  const int other = open_socket(family);
  say("taken", bind_to(other, Name(family.loopback, 4000)));
  say("taken of any", bind_to(other, Name(family.any, 4000)));
  say("SO_REUSEADDR of one", set_number(other, SOL_SOCKET, SO_REUSEADDR, 1));
  say("still taken", bind_to(other, Name(family.any, 4000)));
  say("connect to the other family", connect_to(other, Name(is_v6 ? "127.0.0.1" : "::1", 9)));
  tell("peer", peer_name(other));
  say("send to the other family", send_to(other, "x", Name(is_v6 ? "127.0.0.1" : "::1", 9)));
  say("send to nowhere", send_to(other, "x", Name(is_v6 ? "2001:db8::1" : "127.0.0.1", 9)));
  say("out of band", send_to(other, "x", Name(family.loopback, 4000), MSG_OOB));
  say("listen", listen(other, 1));
  say("accept", accept(other, nullptr, nullptr));
  for (const int each : {fd, other}) close(each);
}

// Sockets of both families on one port.
void share_a_port() {
  const int six = socket(AF_INET6, SOCK_DGRAM, 0);
  const int four = socket(AF_INET, SOCK_DGRAM, 0);
  tell("IPV6_V6ONLY", number_of(six, IPPROTO_IPV6, IPV6_V6ONLY));
  say("any of both", bind_to(six, Name("::", 4000)));
  say("then v4", bind_to(four, Name("0.0.0.0", 4000)));
  say("then one of v4", bind_to(four, Name("127.0.0.1", 4000)));
  say("too late", set_number(six, IPPROTO_IPV6, IPV6_V6ONLY, 1));
  const int client = socket(AF_INET, SOCK_DGRAM, 0);
  bind_to(client, Name("127.0.0.1", 4001));
  send_to(client, "by v4", Name("127.0.0.1", 4000));
  tell("mapped", received(six));
  say("answer", send_to(six, "back", Name("::ffff:127.0.0.1", 4001)));
  tell("answer", received(client));
  say("connect mapped", connect_to(six, Name("::ffff:127.0.0.1", 9)));
  tell("own", own_name(six));
  tell("peer", peer_name(six));
  say("send", send(six, "x", 1, 0));
  say("refused", send(six, "x", 1, 0));
  close(six);
  const int only = socket(AF_INET6, SOCK_DGRAM, 0);
  say("IPV6_V6ONLY", set_number(only, IPPROTO_IPV6, IPV6_V6ONLY, 1));
  say("any of v6", bind_to(only, Name("::", 4000)));
  say("and of v4", bind_to(four, Name("0.0.0.0", 4000)));
  say("mapped, of v6 only", bind_to(only, Name("::ffff:127.0.0.1", 4002)));
  say("send by v6 only", send_to(only, "x", Name("::ffff:127.0.0.1", 4000)));
  say("connect by v6 only", connect_to(only, Name("::ffff:127.0.0.1", 4000)));
  send_to(client, "four", Name("127.0.0.1", 4000));
  tell("v4 has its own", received(four));
  tell("v6 nothing", received(only, MSG_DONTWAIT));
  const int mapped = socket(AF_INET6, SOCK_DGRAM, 0);
  say("bind mapped", bind_to(mapped, Name("::ffff:127.0.0.1", 4003)));
  tell("own", own_name(mapped));
  say("send to v6", send_to(mapped, "x", Name("::1", 4000)));
  say("send to v4", send_to(mapped, "x", Name("127.0.0.1", 4000)));
  tell("from", received(four));
  for (const int each : {only, four, client, mapped}) close(each);
}

// The packet that comes back with a stamp: what of it is the same everywhere, and its payload.
std::string describe_packet(const std::string& packet, bool is_v6) {
  const std::size_t ip = is_v6 ? 40 : 20;
  if (packet.size() < 14 + ip + 8) return "\"" + packet + "\"";
  const auto byte = [&](std::size_t at) {
    return std::to_string(static_cast<unsigned char>(packet[at])) + " ";
  };
  const std::size_t udp = 14 + ip;
  std::string text = byte(12) + byte(13) + byte(14) + byte(is_v6 ? 20 : 23);
  for (const std::size_t at : {udp + 2, udp + 3, udp + 4, udp + 5}) text += byte(at);
  for (std::size_t at = udp - (is_v6 ? 32 : 8); at < udp; ++at) text += byte(at);
  return text + "\"" + packet.substr(udp + 8) + "\"";
}

std::string stamped_packet(int fd, bool is_v6) {
  const QueuedError error(fd);
  if (error.size() < 0) return strerrorname_np(errno);
  return std::to_string(error.size()) + " bytes, " + describe_packet(error.bytes(), is_v6) +
         ", name " + std::to_string(error.message().msg_namelen) + describe_error(error.message());
}

void stamp_departures(const Family& family) {
  const bool is_v6 = family.family == AF_INET6;
  const int receiver = open_socket(family);
  bind_to(receiver, Name(family.loopback, 4000));
  const int fd = open_socket(family);
  constexpr int kFlags = SOF_TIMESTAMPING_TX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  say("stamps", set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, kFlags));
  send_to(fd, "hello", Name(family.loopback, 4000));
  tell("events", events_of(fd, POLLIN | POLLPRI));
  tell("packet", stamped_packet(fd, is_v6));
  tell("no more", stamped_packet(fd, is_v6));
  say("urgent", set_number(fd, SOL_SOCKET, SO_SELECT_ERR_QUEUE, 1));
  say("numbers", set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, kFlags | SOF_TIMESTAMPING_OPT_ID));
  send_to(fd, "one", Name(family.loopback, 4000));
  send_to(fd, "two", Name(family.loopback, 4000));
  tell("events", events_of(fd, POLLPRI));
  tell("one", stamped_packet(fd, is_v6));
  tell("two", stamped_packet(fd, is_v6));
  say("facts", is_v6 ? set_number(fd, IPPROTO_IPV6, IPV6_RECVPKTINFO, 1)
                     : set_number(fd, IPPROTO_IP, IP_PKTINFO, 1));
  send_to(fd, "three", Name(family.loopback, 4000));
  tell("without being asked for", stamped_packet(fd, is_v6));
  say("with facts",
      set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, kFlags | SOF_TIMESTAMPING_OPT_CMSG));
  send_to(fd, "asked", Name(family.loopback, 4000));
  tell("asked for", stamped_packet(fd, is_v6));
  set_number(fd, family.level, family.receive_errors, 1);
  send_to(fd, "lost", Name(family.loopback, 9));
  stamped_packet(fd, is_v6);
  // The refusal has the stamp of its arrival where anybody on the machine has asked for stamps.
  say("no stamps", set_number(fd, SOL_SOCKET, SO_TIMESTAMPING, SOF_TIMESTAMPING_OPT_CMSG));
  tell("of what was refused", error_of_queue(fd));
  say("alone", set_number(fd, SOL_SOCKET, SO_TIMESTAMPING,
                          kFlags | SOF_TIMESTAMPING_OPT_TSONLY | SOF_TIMESTAMPING_OPT_CMSG));
  send_to(fd, "four", Name(family.loopback, 4000));
  tell("without the packet", stamped_packet(fd, is_v6));
  for (const int each : {receiver, fd}) close(each);
}

}  // namespace

int main() {
  for (const Family& family : kFamilies) {
    for (const auto& [name, part] :
         std::initializer_list<std::pair<const char*, void (*)(const Family&)>>{
             {"connected", refuse_connected},
             {"unconnected", refuse_unconnected},
             {"queue", queue_errors},
             {"dissolve", dissolve_association},
             {"large", send_large},
             {"shutdown", shut_down},
             {"bind", bind_in_vain},
             {"stamps", stamp_departures}}) {
      tell(family.name, name);
      part(family);
    }
  }
  share_a_port();
  return 0;
}

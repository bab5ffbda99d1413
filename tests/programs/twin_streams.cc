// Connections on the loopback as tcp(7), ip(7) and ipv6(7) have them: names, closed ports, both
// families on one port.
#include <netinet/tcp.h>

#include <initializer_list>

#include "tests/programs/twin.h"

namespace {

using namespace twin;

struct Family {
  const char* name;
  int family;
  const char* loopback;
  const char* any;
};
constexpr Family kFamilies[] = {{"v4", AF_INET, "127.0.0.1", "0.0.0.0"},
                                {"v6", AF_INET6, "::1", "::"}};

int open_stream(int family, int flags = 0) { return socket(family, SOCK_STREAM | flags, 0); }

int listener_on(int family, const char* host, std::uint16_t port) {
  const int fd = open_stream(family);
  set_number(fd, SOL_SOCKET, SO_REUSEADDR, 1);
  say("bind", bind_to(fd, Name(host, port)));
  say("listen", listen(fd, 4));
  return fd;
}

std::string accepted_from(int listener, int& fd) {
  Name from;
  fd = accept(listener, from.name(), from.room());
  return fd < 0 ? strerrorname_np(errno) : from.text();
}

void connect_both(const Family& family) {
  const int listener = listener_on(family.family, family.any, 4000);
  tell("listener", own_name(listener));
  const int client = open_stream(family.family);
  tell("own", own_name(client));
  tell("peer", peer_name(client));
  say("connect", connect_to(client, Name(family.loopback, 4000)));
  tell("own", own_name(client));
  tell("peer", peer_name(client));
  int server = -1;
  tell("accepted", accepted_from(listener, server));
  tell("own", own_name(server));
  tell("peer", peer_name(server));
  say("send", send(client, "hello", 5, 0));
  tell("received", received(server));
  say("connect again", connect_to(client, Name(family.loopback, 4000)));
  say("bind connected", bind_to(client, Name(family.loopback, 4001)));
  say("shutdown", shutdown(client, SHUT_WR));
  tell("events", events_of(server, POLLIN | POLLOUT | POLLRDHUP));
  say("end", recv(server, nullptr, 0, 0));
  say("answer", send(server, "bye", 3, 0));
  tell("answer", received(client));
  say("SO_TYPE", std::stoi(number_of(client, SOL_SOCKET, SO_TYPE)));
  tell("SO_DOMAIN", number_of(client, SOL_SOCKET, SO_DOMAIN));
  tell("SO_PROTOCOL", number_of(client, SOL_SOCKET, SO_PROTOCOL));
  tell("SO_ACCEPTCONN", number_of(listener, SOL_SOCKET, SO_ACCEPTCONN));
  for (const int fd : {listener, client, server}) close(fd);
}

void refuse(const Family& family) {
  const int fd = open_stream(family.family);
  say("closed port", connect_to(fd, Name(family.loopback, 9)));
  close(fd);
  const int later = open_stream(family.family, SOCK_NONBLOCK);
  say("port 0", connect_to(later, Name(family.loopback, 0)));
  close(later);
  const int other = open_stream(family.family);
  const bool is_v6 = family.family == AF_INET6;
  say("the other family", connect_to(other, Name(is_v6 ? "127.0.0.1" : "::1", 9)));
  say("nowhere", connect_to(other, Name(is_v6 ? "2001:db8::1" : "224.0.0.5", 9)));
  say("no such address", bind_to(other, Name(is_v6 ? "fd77::9" : "192.0.2.77", 4000)));
  say("bind to the other", bind_to(other, Name(is_v6 ? "127.0.0.1" : "::1", 4000)));
  say("too short", connect(other, Name(family.loopback, 9).name(), 8));
  say("bind", bind_to(other, Name(family.loopback, 4000)));
  say("twice", bind_to(other, Name(family.loopback, 4000)));
  const int third = open_stream(family.family);
  say("taken", bind_to(third, Name(family.any, 4000)));
  tell("own", own_name(other));
  for (const int each : {other, third}) close(each);
}

// One socket until somebody listens.
void try_again(const Family& family) {
  const int fd = open_stream(family.family);
  say("refused", connect_to(fd, Name(family.loopback, 4000)));
  tell("peer", peer_name(fd));
  tell("own", own_name(fd));
  tell("events", events_of(fd, POLLIN | POLLOUT));
  say("again", connect_to(fd, Name(family.loopback, 4000)));
  const int listener = listener_on(family.family, family.loopback, 4000);
  say("now", connect_to(fd, Name(family.loopback, 4000)));
  tell("peer", peer_name(fd));
  const int later = open_stream(family.family, SOCK_NONBLOCK);
  say("in the background", connect_to(later, Name(family.loopback, 9)));
  tell("events", events_of(later, POLLOUT));
  say("its end", connect_to(later, Name(family.loopback, 9)));
  for (const int each : {fd, listener, later}) close(each);
}

void share_a_port() {
  const int six = listener_on(AF_INET6, "::", 4000);
  const int four = open_stream(AF_INET);
  set_number(four, SOL_SOCKET, SO_REUSEADDR, 1);
  say("bind v4", bind_to(four, Name("0.0.0.0", 4000)));
  const int client = open_stream(AF_INET);
  say("connect by v4", connect_to(client, Name("127.0.0.1", 4000)));
  int server = -1;
  const std::string from = accepted_from(six, server);
  tell("accepted", from);
  tell("own", own_name(server));
  close(client);
  close(server);
  const int mapped = open_stream(AF_INET6);
  say("connect mapped", connect_to(mapped, Name("::ffff:127.0.0.1", 4000)));
  tell("own", own_name(mapped));
  tell("peer", peer_name(mapped));
  tell("accepted", accepted_from(six, server));
  for (const int fd : {six, four, mapped, server}) close(fd);
}

void keep_apart() {
  const int only = open_stream(AF_INET6);
  say("IPV6_V6ONLY", set_number(only, IPPROTO_IPV6, IPV6_V6ONLY, 1));
  set_number(only, SOL_SOCKET, SO_REUSEADDR, 1);
  say("bind v6", bind_to(only, Name("::", 4005)));
  say("too late", set_number(only, IPPROTO_IPV6, IPV6_V6ONLY, 0));
  say("listen", listen(only, 4));
  const int refused = open_stream(AF_INET);
  say("v4 is refused", connect_to(refused, Name("127.0.0.1", 4005)));
  const int both = listener_on(AF_INET, "0.0.0.0", 4005);
  const int client = open_stream(AF_INET);
  say("v4 has its own", connect_to(client, Name("127.0.0.1", 4005)));
  const int mapped = open_stream(AF_INET6);
  set_number(mapped, IPPROTO_IPV6, IPV6_V6ONLY, 1);
  say("mapped by v6 only", connect_to(mapped, Name("::ffff:127.0.0.1", 4005)));
  for (const int fd : {only, refused, both, client, mapped}) close(fd);
}

}  // namespace

int main() {
  for (const Family& family : kFamilies) {
    tell(family.name, "connect");
    connect_both(family);
    tell(family.name, "refuse");
    refuse(family);
    tell(family.name, "again");
    try_again(family);
  }
  share_a_port();
  keep_apart();
  return 0;
}

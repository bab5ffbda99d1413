// What options of sockets begin with, what they may be set to, and what they then are.
#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/time.h>
#include <time.h>

#include "tests/programs/twin.h"

namespace {

using namespace twin;

struct Option {
  const char* name;
  int level;
  int option;
};
#define TWIN_OPTION(level, option) \
  { #option, level, option }

constexpr Option kOptions[] = {
    TWIN_OPTION(SOL_SOCKET, SO_TYPE),
    TWIN_OPTION(SOL_SOCKET, SO_DOMAIN),
    TWIN_OPTION(SOL_SOCKET, SO_PROTOCOL),
    TWIN_OPTION(SOL_SOCKET, SO_ERROR),
    TWIN_OPTION(SOL_SOCKET, SO_ACCEPTCONN),
    TWIN_OPTION(SOL_SOCKET, SO_REUSEADDR),
    TWIN_OPTION(SOL_SOCKET, SO_BROADCAST),
    TWIN_OPTION(SOL_SOCKET, SO_DONTROUTE),
    TWIN_OPTION(SOL_SOCKET, SO_KEEPALIVE),
    TWIN_OPTION(SOL_SOCKET, SO_OOBINLINE),
    TWIN_OPTION(SOL_SOCKET, SO_SELECT_ERR_QUEUE),
    TWIN_OPTION(SOL_SOCKET, SO_TIMESTAMP),
    TWIN_OPTION(SOL_SOCKET, SO_TIMESTAMPNS),
    TWIN_OPTION(SOL_SOCKET, SO_RXQ_OVFL),
    TWIN_OPTION(IPPROTO_IP, IP_TTL),
    TWIN_OPTION(IPPROTO_IP, IP_PKTINFO),
    TWIN_OPTION(IPPROTO_IP, IP_MTU),
    TWIN_OPTION(IPPROTO_IP, IP_MTU_DISCOVER),
    TWIN_OPTION(IPPROTO_IP, IP_RECVERR),
    TWIN_OPTION(IPPROTO_IP, IP_RECVTTL),
    TWIN_OPTION(IPPROTO_IP, IP_RECVTOS),
    TWIN_OPTION(IPPROTO_IP, IP_FREEBIND),
    TWIN_OPTION(IPPROTO_IP, IP_MINTTL),
    TWIN_OPTION(IPPROTO_IP, IP_MULTICAST_IF),
    TWIN_OPTION(IPPROTO_IP, IP_MULTICAST_ALL),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_V6ONLY),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_UNICAST_HOPS),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_MULTICAST_LOOP),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_MTU_DISCOVER),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_DONTFRAG),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_RECVERR),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_RECVPKTINFO),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_RECVHOPLIMIT),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_RECVTCLASS),
    TWIN_OPTION(IPPROTO_TCP, TCP_NODELAY),
    TWIN_OPTION(IPPROTO_TCP, TCP_CORK),
    TWIN_OPTION(IPPROTO_TCP, TCP_KEEPIDLE),
    TWIN_OPTION(IPPROTO_TCP, TCP_KEEPINTVL),
    TWIN_OPTION(IPPROTO_TCP, TCP_KEEPCNT),
    TWIN_OPTION(IPPROTO_TCP, TCP_USER_TIMEOUT),
    TWIN_OPTION(SOL_PACKET, PACKET_AUXDATA),
};

// Those of datagrams, which connections do not have.
constexpr Option kOfDatagrams[] = {
    TWIN_OPTION(IPPROTO_IP, IP_TOS),
    TWIN_OPTION(IPPROTO_IP, IP_MULTICAST_TTL),
    TWIN_OPTION(IPPROTO_IP, IP_MULTICAST_LOOP),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_MULTICAST_HOPS),
    TWIN_OPTION(IPPROTO_IPV6, IPV6_TCLASS),
};

// Whether IPv6's are asked for at another socket, where the error differs from kernel to kernel.
bool is_strange(const Option& option, int family, int type) {
  if (option.level == SOL_SOCKET) return false;
  if (option.level == IPPROTO_IP) return family == AF_PACKET;
  if (option.level == IPPROTO_IPV6) return family != AF_INET6;
  if (option.level == SOL_PACKET) return family != AF_PACKET;
  return family == AF_PACKET || type != SOCK_STREAM;
}

void look_at(const Option& option, int family, int type) {
  const int fd = socket(family, type, 0);
  tell(option.name, number_of(fd, option.level, option.option));
  for (const int value : {-1, 0, 1, 2, 5, 64, 255, 256, 1000}) {
    const int result = set_number(fd, option.level, option.option, value);
    const std::string set = result == 0 ? "0" : strerrorname_np(errno);
    tell(std::to_string(value).c_str(),
         set + ", then " + number_of(fd, option.level, option.option));
  }
  close(fd);
}

void look_at_times(int family, int type) {
  const int fd = socket(family, type, 0);
  timeval time{.tv_sec = 2, .tv_usec = 500'000};
  socklen_t size = sizeof time;
  say("SO_RCVTIMEO", setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time));
  time = {};
  say("again", getsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &time, &size));
  say("seconds", time.tv_sec);
  say("microseconds", time.tv_usec);
  say("size", size);
  time = {.tv_sec = 0, .tv_usec = 1'000'000};
  say("too many", setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time));
  say("too short", setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &time, 3));
  linger kept{.l_onoff = 7, .l_linger = 3};
  size = sizeof kept;
  say("SO_LINGER", setsockopt(fd, SOL_SOCKET, SO_LINGER, &kept, sizeof kept));
  say("again", getsockopt(fd, SOL_SOCKET, SO_LINGER, &kept, &size));
  say("on", kept.l_onoff);
  say("for", kept.l_linger);
  char name[20] = "x";
  size = sizeof name;
  say("SO_BINDTODEVICE", getsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, name, &size));
  say("no name", size);
  say("lo", setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, "lo", 3));
  size = sizeof name;
  say("again", getsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, name, &size));
  tell("name", name);
  char byte = 0;
  size = 1;
  say("SO_TYPE in a byte", getsockopt(fd, SOL_SOCKET, SO_TYPE, &byte, &size));
  say("it", byte);
  say("its size", size);
  close(fd);
}

}  // namespace

int main() {
  const struct {
    const char* name;
    int family;
    int type;
  } kinds[] = {{"UDP", AF_INET, SOCK_DGRAM},
               {"UDP by IPv6", AF_INET6, SOCK_DGRAM},
               {"TCP", AF_INET, SOCK_STREAM},
               {"TCP by IPv6", AF_INET6, SOCK_STREAM}};
  for (const auto& kind : kinds) {
    tell("kind", kind.name);
    for (const Option& option : kOptions) {
      if (!is_strange(option, kind.family, kind.type)) look_at(option, kind.family, kind.type);
    }
    for (const Option& option : kOfDatagrams) {
      const bool is_asked = kind.type == SOCK_DGRAM && !is_strange(option, kind.family, kind.type);
      if (is_asked) look_at(option, kind.family, kind.type);
    }
    look_at_times(kind.family, kind.type);
  }
  return 0;
}

// Calls with descriptors that are closed, were never opened or are of another kind, and sockets of
// families, types and protocols that there are not.
#include <fcntl.h>
#include <linux/sockios.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/timerfd.h>
#include <time.h>

#include <initializer_list>

#include "tests/programs/twin.h"

namespace {

using namespace twin;

void call_with(int fd, bool is_epoll = false) {
  char bytes[8] = "";
  const Name to("127.0.0.1", 4000);
  Name name;
  iovec piece{.iov_base = bytes, .iov_len = 1};
  msghdr message{};
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  mmsghdr several{};
  several.msg_hdr = message;
  int number = 0;
  socklen_t size = sizeof number;
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  itimerspec setting{};
  say("bind", bind_to(fd, to));
  say("connect", connect_to(fd, to));
  say("listen", listen(fd, 1));
  say("accept", accept(fd, nullptr, nullptr));
  say("accept4", accept4(fd, nullptr, nullptr, 0));
  say("getsockname", getsockname(fd, name.name(), name.room()));
  say("getpeername", getpeername(fd, name.name(), name.room()));
  say("getsockopt", getsockopt(fd, SOL_SOCKET, SO_TYPE, &number, &size));
  say("setsockopt", set_number(fd, SOL_SOCKET, SO_BROADCAST, 1));
  say("shutdown", shutdown(fd, SHUT_RDWR));
  say("send", send(fd, bytes, 1, MSG_DONTWAIT));
  say("sendto", sendto(fd, bytes, 1, MSG_DONTWAIT, to.name(), to.size()));
  say("sendmsg", sendmsg(fd, &message, MSG_DONTWAIT));
  say("sendmmsg", sendmmsg(fd, &several, 1, MSG_DONTWAIT));
  say("recv", recv(fd, bytes, 1, MSG_DONTWAIT));
  say("recvfrom", recvfrom(fd, bytes, 1, MSG_DONTWAIT, name.name(), name.room()));
  say("recvmsg", recvmsg(fd, &message, MSG_DONTWAIT));
  say("recvmmsg", recvmmsg(fd, &several, 1, MSG_DONTWAIT, nullptr));
  say("timerfd_settime", timerfd_settime(fd, 0, &setting, nullptr));
  say("timerfd_gettime", timerfd_gettime(fd, &setting));
  if (is_epoll) return;  // its requests differ from kernel to kernel
  say("SIOCGIFINDEX", ioctl(fd, SIOCGIFINDEX, &request));
  say("FIONREAD", ioctl(fd, FIONREAD, &number));
}

void call_all_kinds() {
  const int closed = socket(AF_INET, SOCK_DGRAM, 0);
  close(closed);
  const int closed_stream = socket(AF_INET6, SOCK_STREAM, 0);
  close(closed_stream);
  const int closed_timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  close(closed_timer);
  for (const int none : {-1, 777, 100'000, closed, closed_stream, closed_timer}) {
    tell("descriptor", none == -1 ? "-1" : none >= 777 ? "unknown" : "closed");
    call_with(none);
  }
  tell("descriptor", "a file");
  const int file = open("/proc/self/exe", O_RDONLY | O_CLOEXEC);
  call_with(file);
  close(file);
  tell("descriptor", "a timer");
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK);
  call_with(timer);
  close(timer);
  tell("descriptor", "an epoll");
  const int epoll = epoll_create1(0);
  call_with(epoll, true);
  close(epoll);
}

// Those are right that need no name or peer.
void call_sockets() {
  const int datagrams = socket(AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  const int stream = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  for (const int fd : {datagrams, stream}) {
    tell("socket", fd == stream ? "stream" : "datagrams");
    char byte = 0;
    itimerspec setting{};
    say("listen", fd == stream ? 0 : listen(fd, 1));
    say("accept", accept(fd, nullptr, nullptr));
    say("send", send(fd, &byte, 1, MSG_NOSIGNAL));
    say("recv", recv(fd, &byte, 1, 0));
    say("timerfd_settime", timerfd_settime(fd, 0, &setting, nullptr));
    say("timerfd_gettime", timerfd_gettime(fd, &setting));
    say("no such level", set_number(fd, 12345, 1, 1));
    say("no such option", set_number(fd, SOL_SOCKET, 999, 1));
    say("too short", setsockopt(fd, SOL_SOCKET, SO_BROADCAST, &byte, 1));
    tell("no such option", number_of(fd, SOL_SOCKET, 999));
    say("no such device", setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, "nosuch0", 8));
    close(fd);
  }
}

void open_in_vain() {
  const struct {
    const char* name;
    int domain;
    int type;
    int protocol;
  } kinds[] = {
      {"no family", AF_UNSPEC, SOCK_DGRAM, 0},
      {"an odd family", 250, SOCK_DGRAM, 0},
      {"a family below 0", -1, SOCK_DGRAM, 0},
      {"a type of no use", AF_INET, 9, 0},
      {"no type", AF_INET, 0, 0},
      {"a type below 0", AF_INET, -1, 0},
      {"unknown flags", AF_INET, SOCK_DGRAM | 0x100000, 0},
      {"sequenced packets", AF_INET, SOCK_SEQPACKET, 0},
      {"reliable messages", AF_INET, SOCK_RDM, 0},
      {"sequenced packets, v6", AF_INET6, SOCK_SEQPACKET, 0},
      {"TCP datagrams", AF_INET, SOCK_DGRAM, IPPROTO_TCP},
      {"UDP streams", AF_INET, SOCK_STREAM, IPPROTO_UDP},
      {"UDP streams, v6", AF_INET6, SOCK_STREAM, IPPROTO_UDP},
      {"UDP", AF_INET, SOCK_DGRAM, IPPROTO_UDP},
      {"UDP, v6", AF_INET6, SOCK_DGRAM, IPPROTO_UDP},
      {"TCP", AF_INET, SOCK_STREAM, IPPROTO_TCP},
      {"protocol below 0", AF_INET, SOCK_STREAM, -1},
      {"a large protocol", AF_INET, SOCK_STREAM, 70'000},
      {"netlink of no family", AF_NETLINK, SOCK_RAW, 31},
      {"netlink as a stream", AF_NETLINK, SOCK_STREAM, 0},
  };
  for (const auto& kind : kinds) {
    const int fd = socket(kind.domain, kind.type, kind.protocol);
    say(kind.name, fd >= 0 ? 0 : -1);
    if (fd >= 0) close(fd);
  }
}

void open_pairs_in_vain() {
  int ends[2];
  say("a pair of IPv4", socketpair(AF_INET, SOCK_STREAM, 0, ends));
  say("a pair of IPv6", socketpair(AF_INET6, SOCK_DGRAM, 0, ends));
  say("a pair of no family", socketpair(250, SOCK_STREAM, 0, ends));
  say("a local pair", socketpair(AF_UNIX, SOCK_STREAM, 0, ends));
  for (const int end : ends) close(end);
}

}  // namespace

int main() {
  call_all_kinds();
  call_sockets();
  open_in_vain();
  open_pairs_in_vain();
  return 0;
}

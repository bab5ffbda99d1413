// What tcp(7), connect(2), accept(2), shutdown(2) and dup(2) promise of connections.
//
//   stream_calls serve   sends back what comes on port 80, to all at once
//   stream_calls check ADDRESS
#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>

#include <string>
#include <vector>

#include "tests/programs/promises.h"

namespace {

using promises::address;
using promises::bind_to;
using promises::connect_to;
using promises::expect;
using promises::expect_error;
using promises::finish;
using promises::gets;
using promises::has_input;
using promises::kMillisecond;
using promises::send_text;
using promises::set_number;
using promises::steady;
using promises::udp;

constexpr std::uint16_t kPort = 80;

int tcp(int flags = 0) { return socket(AF_INET, SOCK_STREAM | flags, 0); }

int connected(const char* host, std::uint16_t port) {
  const int fd = tcp();
  expect(connect_to(fd, address(host, port)) == 0, "connect");
  return fd;
}

int error_of(int fd) {
  int error = -1;
  socklen_t size = sizeof error;
  expect(getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0, "SO_ERROR");
  return error;
}

short waits_for(int fd, short events, int patience_ms = 100) {
  pollfd interest{.fd = fd, .events = events, .revents = 0};
  return poll(&interest, 1, patience_ms) == 1 ? interest.revents : 0;
}

void check_connecting(const char* master) {
  const int refused = tcp();
  const std::int64_t begin = steady();
  expect_error(connect_to(refused, address(master, 81)), ECONNREFUSED, "nobody listens");
  expect(steady() - begin > kMillisecond / 5, "an answer takes a round trip");
  const int lost = tcp();
  expect_error(connect_to(lost, address("10.0.9.9", 80)), ENETUNREACH, "no such host");
  const int later = tcp(SOCK_NONBLOCK);
  expect_error(connect_to(later, address(master, kPort)), EINPROGRESS, "it takes its time");
  expect_error(connect_to(later, address(master, kPort)), EALREADY, "only one at a time");
  expect_error(send(later, "x", 1, 0), EAGAIN, "nothing is written before");
  expect(waits_for(later, POLLOUT) == POLLOUT && error_of(later) == 0, "connected");
  expect_error(connect_to(later, address(master, kPort)), EISCONN, "once");
  const int never = tcp(SOCK_NONBLOCK);
  expect_error(connect_to(never, address(master, 81)), EINPROGRESS, "nor does it fail at once");
  expect((waits_for(never, POLLOUT) & (POLLERR | POLLHUP)) == (POLLERR | POLLHUP), "refused");
  expect(error_of(never) == ECONNREFUSED && error_of(never) == 0, "SO_ERROR is read once");
  for (const int each : {refused, lost, later, never}) close(each);
}

void check_bytes(const char* master) {
  const int fd = connected(master, kPort);
  sockaddr_in name{};
  socklen_t size = sizeof name;
  expect(getpeername(fd, reinterpret_cast<sockaddr*>(&name), &size) == 0 &&
             ntohs(name.sin_port) == kPort,
         "getpeername");
  expect(set_number(fd, IPPROTO_TCP, TCP_NODELAY, 1) == 0, "TCP_NODELAY");
  char bytes[16] = "";
  expect_error(recv(fd, bytes, 1, MSG_DONTWAIT), EAGAIN, "nothing yet");
  expect(write(fd, "hello", 5) == 5, "write");
  expect(recv(fd, bytes, 5, MSG_WAITALL | MSG_PEEK) > 0, "a blocking read waits");
  expect(read(fd, bytes, 2) == 2 && recv(fd, bytes + 2, 3, MSG_WAITALL) == 3 &&
             std::memcmp(bytes, "hello", 5) == 0,
         "bytes come in any pieces");
  send(fd, "abc", 3, 0);
  int waiting = 0;
  expect(has_input(fd) && ioctl(fd, FIONREAD, &waiting) == 0 && waiting == 3, "FIONREAD");
  expect(recv(fd, bytes, 16, MSG_PEEK) == 3 && recv(fd, bytes, 16, 0) == 3, "MSG_PEEK leaves it");
  expect(shutdown(fd, SHUT_WR) == 0, "shutdown");
  expect(recv(fd, bytes, 16, 0) == 0, "the other end closes too");
  expect_error(send(fd, "x", 1, MSG_NOSIGNAL), EPIPE, "nothing is written after that");
  close(fd);
}

// More than fits on the way, both ways at once.
void check_much(const char* master) {
  const int fd = connected(master, kPort);
  int one = 1;
  expect(ioctl(fd, FIONBIO, &one) == 0, "FIONBIO");
  constexpr std::size_t kMuch = 1'000'000;
  std::string sent;
  for (std::size_t i = 0; i < kMuch; ++i) sent += static_cast<char>(i * 7919 >> 8);
  std::string came;
  std::size_t written = 0;
  bool was_full = false;
  while (came.size() < kMuch) {
    const short wanted = written < kMuch ? POLLIN | POLLOUT : POLLIN;
    const short ready = waits_for(fd, wanted, 5000);
    if (ready == 0) break;
    if ((ready & POLLOUT) != 0) {
      const ssize_t part = send(fd, sent.data() + written, kMuch - written, 0);
      expect(part > 0, "a socket that is ready takes something");
      written += static_cast<std::size_t>(part);
      was_full = was_full || written < kMuch;
    }
    char bytes[10'000];
    const ssize_t part = recv(fd, bytes, sizeof bytes, 0);
    if (part > 0) came.append(bytes, static_cast<std::size_t>(part));
  }
  expect(was_full, "a sender waits for its receiver");
  expect(came == sent, "everything comes, in order");
  close(fd);
}

void check_listening() {
  const int listener = tcp(SOCK_NONBLOCK);
  expect(bind_to(listener, address("0.0.0.0", 5000)) == 0 && listen(listener, 2) == 0, "listen");
  const int other = tcp();
  expect_error(bind_to(other, address("0.0.0.0", 5000)), EADDRINUSE, "a port has one listener");
  expect_error(accept(listener, nullptr, nullptr), EAGAIN, "nobody has come");
  const int client = connected("127.0.0.1", 5000);
  expect(waits_for(listener, POLLIN) == POLLIN, "somebody has");
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const int server = accept4(listener, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK);
  expect(server >= 0 && ntohl(from.sin_addr.s_addr) == INADDR_LOOPBACK, "accept4");
  expect((fcntl(server, F_GETFL) & O_NONBLOCK) != 0, "with its flags");
  send(client, "left", 4, 0);
  close(server);
  char byte = 0;
  expect_error(recv(client, &byte, 1, 0), ECONNRESET, "closed before all was read");
  close(client);
  close(listener);
  const int late = tcp();
  expect_error(connect_to(late, address("127.0.0.1", 5000)), ECONNREFUSED, "it has ceased");
  const int datagrams = udp();
  expect_error(listen(datagrams, 1), EOPNOTSUPP, "datagrams do not connect");
  for (const int each : {other, late, datagrams}) close(each);
}

void check_copies() {
  const int fd = udp();
  bind_to(fd, address("0.0.0.0", 6000));
  const int copy = dup(fd);
  close(fd);
  expect(copy >= 0 && send_text(copy, "one", address("127.0.0.1", 6000)) == 3 && gets(copy, "one"),
         "a copy is the same socket");
  const int next = udp();
  expect(next == fd && bind_to(next, address("0.0.0.0", 6001)) == 0, "its number is free again");
  expect(dup2(copy, next) == next && !gets(next, "x", 1), "dup2 closes what was there");
  expect(send_text(next, "two", address("127.0.0.1", 6000)) == 3 && gets(copy, "two"), "dup2");
  const int third = fcntl(copy, F_DUPFD_CLOEXEC, 50);
  expect(third >= 50 && (fcntl(third, F_GETFD) & FD_CLOEXEC) != 0, "F_DUPFD_CLOEXEC");
  expect(dup3(copy, 60, 0) == 60, "dup3");
  expect_error(dup3(copy, copy, 0), EINVAL, "dup3 to itself");
  for (const int each : {copy, next, 60}) close(each);
  expect(send_text(third, "all", address("127.0.0.1", 6000)) == 3 && gets(third, "all"),
         "it lives until the last is closed");
  close(third);
  const int again = udp();
  expect(bind_to(again, address("0.0.0.0", 6000)) == 0, "and then leaves its port");
  expect(connect_to(again, address("127.0.0.1", 6000)) == 0 && write(again, "rw", 2) == 2,
         "write to a datagram socket");
  char bytes[4];
  expect(read(again, bytes, sizeof bytes) == 2, "read from it");
  close(again);
}

[[noreturn]] void serve() {
  const int listener = tcp();
  expect(bind_to(listener, address("0.0.0.0", kPort)) == 0 && listen(listener, 8) == 0, "listen");
  std::vector<pollfd> all = {{.fd = listener, .events = POLLIN, .revents = 0}};
  for (;;) {
    expect(poll(all.data(), all.size(), -1) > 0, "poll");
    for (std::size_t i = all.size(); i-- > 1;) {
      if (all[i].revents == 0) continue;
      char bytes[4000];
      const ssize_t got = read(all[i].fd, bytes, sizeof bytes);
      if (got > 0) send(all[i].fd, bytes, static_cast<std::size_t>(got), MSG_NOSIGNAL);
      if (got > 0) continue;
      close(all[i].fd);
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (all[0].revents == 0) continue;
    all.push_back({.fd = accept(listener, nullptr, nullptr), .events = POLLIN, .revents = 0});
  }
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "serve") == 0) serve();
  if (count < 3) return 2;
  check_connecting(words[2]);
  check_bytes(words[2]);
  check_much(words[2]);
  check_listening();
  check_copies();
  finish();
}

// What the programs that look at intercepted calls have in common: each prints a line for every
// promise that does not hold.
//
//   expect(bind_to(fd, address("0.0.0.0", 5000)) == 0, "bind");
#pragma once

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace promises {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMillisecond = 1'000'000;

inline void expect(bool holds, const char* promise) {
  if (holds) return;
  std::printf("%s (errno %d)\n", promise, errno);
  std::fflush(stdout);
}

// A call that fails with this error.
inline void expect_error(long result, int error, const char* promise) {
  expect(result == -1 && errno == error, promise);
}

inline std::int64_t to_ns(const timespec& time) { return time.tv_sec * kSecond + time.tv_nsec; }

inline std::int64_t read_clock(clockid_t clock) {
  timespec now{};
  expect(clock_gettime(clock, &now) == 0, "clock_gettime");
  return to_ns(now);
}

inline std::int64_t steady() { return read_clock(CLOCK_MONOTONIC); }

inline bool is_about(std::int64_t ns, std::int64_t expected) {
  return std::llabs(ns - expected) < 50'000;
}

inline sockaddr_in address(const char* host, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  inet_pton(AF_INET, host, &result.sin_addr);
  return result;
}

inline int bind_to(int fd, const sockaddr_in& name) {
  return bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
}

inline int connect_to(int fd, const sockaddr_in& name) {
  return connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
}

inline ssize_t send_text(int fd, const char* text, const sockaddr_in& to) {
  return sendto(fd, text, std::strlen(text), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

inline int udp(int flags = 0) { return socket(AF_INET, SOCK_DGRAM | flags, 0); }

inline int set_number(int fd, int level, int option, int value) {
  return setsockopt(fd, level, option, &value, sizeof value);
}

// Whether the descriptor has something to read until then.
inline bool has_input(int fd, int patience_ms = 100) {
  pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
  return poll(&interest, 1, patience_ms) == 1 && (interest.revents & POLLIN) != 0;
}

// Whether this comes next, in time.
inline bool gets(int fd, const char* text, int patience_ms = 100) {
  char bytes[1500];
  if (!has_input(fd, patience_ms)) return false;
  const ssize_t size = recv(fd, bytes, sizeof bytes, MSG_DONTWAIT);
  return size == static_cast<ssize_t>(std::strlen(text)) &&
         std::memcmp(bytes, text, static_cast<std::size_t>(size)) == 0;
}

// Says that all was looked at, and stays as daemons do.
[[noreturn]] inline void finish() {
  std::puts("done");
  std::fflush(stdout);
  for (;;) sleep(3600);
}

}  // namespace promises

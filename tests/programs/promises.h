// What programs share that look at the promises of man pages in the simulated world: a promise that
// does not hold is a line of output.
//
//   expect(usleep(500) == 0 && is_about(steady() - begin, 500'000), "usleep");
#ifndef SIMBENCH_TESTS_PROGRAMS_PROMISES_H_
#define SIMBENCH_TESTS_PROGRAMS_PROMISES_H_

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

inline constexpr std::int64_t kSecond = 1'000'000'000;
inline constexpr std::int64_t kMillisecond = 1'000'000;

inline void expect(bool holds, const char* promise) {
  if (holds) return;
  std::printf("%s (errno %d)\n", promise, errno);
  std::fflush(stdout);
}

inline std::int64_t read_clock(clockid_t clock) {
  timespec now{};
  expect(clock_gettime(clock, &now) == 0, "clock_gettime");
  return now.tv_sec * kSecond + now.tv_nsec;
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

inline int udp(int flags = 0) { return socket(AF_INET, SOCK_DGRAM | flags, 0); }

#endif  // SIMBENCH_TESTS_PROGRAMS_PROMISES_H_

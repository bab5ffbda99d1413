// Cristian's algorithm as a daemon: asks the master's clock once a second and steps its own by the
// half of what the round trip does not explain. Plain sockets; nothing in it knows of simbench.
//
//   cristian serve | cristian follow ADDRESS
//
// Source: F. Cristian, Probabilistic clock synchronization, Distributed Computing 3, 1989.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>

namespace {

constexpr std::uint16_t kPort = 7123;
constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

sockaddr_in address(const char* host) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(kPort);
  inet_pton(AF_INET, host, &result.sin_addr);
  return result;
}

int serve() {
  const int socket_fd = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in own = address("0.0.0.0");
  if (bind(socket_fd, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) return 1;
  for (;;) {
    char question[64];
    sockaddr_in from{};
    socklen_t size = sizeof from;
    auto* name = reinterpret_cast<sockaddr*>(&from);
    if (recvfrom(socket_fd, question, sizeof question, 0, name, &size) < 0) return 1;
    const std::int64_t reading = now_ns();
    sendto(socket_fd, &reading, sizeof reading, 0, name, size);
  }
}

// Whether an answer came within a second.
bool ask(int socket_fd, std::int64_t& reading) {
  if (send(socket_fd, "?", 1, 0) != 1) return false;
  fd_set readers;
  FD_ZERO(&readers);
  FD_SET(socket_fd, &readers);
  timeval patience{.tv_sec = 1, .tv_usec = 0};
  return select(socket_fd + 1, &readers, nullptr, nullptr, &patience) == 1 &&
         recv(socket_fd, &reading, sizeof reading, 0) == sizeof reading;
}

int follow(const char* master) {
  const int socket_fd = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in peer = address(master);
  if (connect(socket_fd, reinterpret_cast<const sockaddr*>(&peer), sizeof peer) != 0) return 1;
  for (;;) {
    const std::int64_t asked = now_ns();
    std::int64_t reading = 0;
    if (ask(socket_fd, reading)) {
      const std::int64_t answered = now_ns();
      const std::int64_t right = reading + (answered - asked) / 2;
      const timespec setting{.tv_sec = right / kSecond, .tv_nsec = right % kSecond};
      if (clock_settime(CLOCK_REALTIME, &setting) != 0) return 1;
      std::printf("%lld\n", static_cast<long long>(right - answered));
      std::fflush(stdout);
    }
    sleep(1);
  }
}

}  // namespace

int main(int count, char** words) {
  if (count == 2 && std::strcmp(words[1], "serve") == 0) return serve();
  if (count == 3 && std::strcmp(words[1], "follow") == 0) return follow(words[2]);
  std::fputs("usage: cristian serve | cristian follow ADDRESS\n", stderr);
  return 2;
}

// Two programs of a host over Unix-domain sockets, which wait in simulated time.
//
//   local_calls answer   says "pong" to what comes at /run/answer, a second later
//   local_calls ask
#include <sys/stat.h>
#include <sys/un.h>

#include "tests/programs/promises.h"

namespace {

using promises::expect;
using promises::finish;
using promises::gets;
using promises::has_input;
using promises::kMillisecond;
using promises::kSecond;
using promises::steady;

sockaddr_un path(const char* text) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, text, sizeof name.sun_path - 1);
  return name;
}

int local(const char* own) {
  const int fd = socket(AF_UNIX, SOCK_DGRAM, 0);
  const sockaddr_un name = path(own);
  unlink(own);
  expect(bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0, "bind to a path");
  expect(chmod(own, 0600) == 0, "chmod of it");
  return fd;
}

ssize_t say(int fd, const char* text, const char* whom) {
  const sockaddr_un name = path(whom);
  return sendto(fd, text, std::strlen(text), 0, reinterpret_cast<const sockaddr*>(&name),
                sizeof name);
}

[[noreturn]] void answer() {
  const int fd = local("/run/answer");
  for (;;) {
    char bytes[16];
    sockaddr_un from{};
    socklen_t size = sizeof from;
    recvfrom(fd, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
    sleep(1);
    sendto(fd, "pong", 4, 0, reinterpret_cast<const sockaddr*>(&from), size);
  }
}

[[noreturn]] void ask() {
  const int fd = local("/var/run/ask");
  usleep(1000);  // the other binds
  struct stat found {};
  expect(stat("run/answer", &found) == 0, "hosts have folders of their own for such paths");
  for (int i = 0; i < 3; ++i) {
    const std::int64_t begin = steady();
    expect(say(fd, "ping", "/var/run/answer") == 4, "sendto another program");
    expect(!has_input(fd, 500), "no answer yet");
    expect(gets(fd, "pong", 5000), "a wait for another program ends when it writes");
    expect(std::llabs(steady() - begin - kSecond) < kMillisecond, "in simulated time");
  }
  int ends[2];
  expect(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0 && write(ends[0], "x", 1) == 1 &&
             gets(ends[1], "x"),
         "socketpair");
  close(ends[0]);
  char byte = 0;
  expect(has_input(ends[1]) && read(ends[1], &byte, 1) == 0, "a closed end is the end");
  finish();
}

}  // namespace

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "answer") == 0) answer();
  ask();
}

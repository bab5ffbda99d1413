// Attacks on the world by its own link: what is no request, too many, and none at all.
//
//   link_attacks ATTEMPT
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "shim/protocol.h"
#include "tests/programs/attempts.h"

namespace {

using attempts::Attempt;
using attempts::say;
using simbench::shim::Call;
using simbench::shim::Request;

int link_number() { return std::atoi(std::getenv(simbench::shim::kLinkVariable)); }

long send_bytes(const void* data, std::size_t size, int flags = 0) {
  return syscall(SYS_sendto, link_number(), data, size, flags, nullptr, 0);
}
long take_reply() {
  static std::array<char, 1 << 17> room;
  return syscall(SYS_recvfrom, link_number(), room.data(), room.size(), 0, nullptr, nullptr);
}

// The same numbers each time.
std::uint32_t chance() {
  static std::uint32_t state = 1;
  state ^= state << 13U;
  state ^= state >> 17U;
  state ^= state << 5U;
  return state;
}

void garbage() {
  std::vector<unsigned char> bytes(4096);
  for (int i = 0; i < 1000; ++i) {
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(chance());
    send_bytes(bytes.data(), 1 + chance() % bytes.size());
    take_reply();
  }
}
void short_request() {
  send_bytes("abc", 3);
  take_reply();
}
void empty_request() {
  send_bytes("", 0);
  take_reply();
}
void wrong_size() {
  const Request request{.call = Call::kReadClock,
                        .size = std::numeric_limits<std::uint32_t>::max()};
  send_bytes(&request, sizeof request);
  take_reply();
}
void unknown_call() {
  const Request request{.call = static_cast<Call>(9999)};
  send_bytes(&request, sizeof request);
  take_reply();
}
// Each call with the numbers that checks forget; the world ends the program at one of them, or
// answers.
void extremes() {
  constexpr std::int64_t kNumbers[] = {-1, 1, std::numeric_limits<std::int64_t>::max(),
                                       std::numeric_limits<std::int64_t>::min()};
  const auto call = static_cast<std::uint32_t>(std::atoi(attempts::path));
  std::vector<unsigned char> message(sizeof(Request) + 4096, 0xFF);
  for (const std::int64_t a : kNumbers) {
    for (const std::int64_t b : kNumbers) {
      for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{4096}}) {
        for (const std::int32_t fd : {-1, 0, 7, std::numeric_limits<std::int32_t>::max(),
                                      std::numeric_limits<std::int32_t>::min()}) {
          const Request request{.call = static_cast<Call>(call),
                                .fd = fd,
                                .a = a,
                                .b = b,
                                .size = static_cast<std::uint32_t>(size),
                                .flags = ~0U};
          std::memcpy(message.data(), &request, sizeof request);
          if (send_bytes(message.data(), sizeof request + size) < 0) return;
          take_reply();
        }
      }
    }
  }
}
void many_waits() {
  std::vector<unsigned char> message(sizeof(Request) + simbench::shim::kMostData, 0x11);
  for (int i = 0; i < 100; ++i) {
    const Request request{.call = Call::kWait, .size = simbench::shim::kMostData};
    std::memcpy(message.data(), &request, sizeof request);
    send_bytes(message.data(), message.size());
    take_reply();
  }
}
// Never takes a reply.
void flood() {
  const Request request{.call = Call::kRandom, .a = 60'000};
  for (;;) {
    if (send_bytes(&request, sizeof request) < 0) return;
  }
}
void open_many() {
  for (std::int32_t fd = 0; fd < 100'000; ++fd) {
    const Request request{.call = Call::kOpenSocket, .fd = fd, .a = SOCK_DGRAM};
    send_bytes(&request, sizeof request);
    take_reply();
  }
}
void with_descriptors() {
  const Request request{.call = Call::kReadClock};
  iovec piece{.iov_base = const_cast<Request*>(&request), .iov_len = sizeof request};
  std::array<int, 64> sent{};
  sent.fill(open("own", O_RDWR | O_CREAT, 0600));
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof sent)> control{};
  for (int i = 0; i < 1000; ++i) {
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* head = CMSG_FIRSTHDR(&message);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof sent);
    std::memcpy(CMSG_DATA(head), sent.data(), sizeof sent);
    if (syscall(SYS_sendmsg, link_number(), &message, 0) < 0) return;
    take_reply();
  }
}
void end_one_way() {
  say("shutdown", syscall(SYS_shutdown, link_number(), SHUT_RDWR));
  const Request request{.call = Call::kReadClock};
  say("send", send_bytes(&request, sizeof request, MSG_NOSIGNAL));
}
void map_it() {
  say("mmap", reinterpret_cast<std::intptr_t>(
                  mmap(nullptr, 4096, PROT_READ, MAP_SHARED, link_number(), 0)));
}
void colours() {
  std::puts("\x1b]0;title\x07\x1b[31mred\r\tline");
  std::fflush(stdout);
  _exit(3);
}

constexpr Attempt kAttempts[] = {{"garbage", garbage},
                                 {"short", short_request},
                                 {"empty", empty_request},
                                 {"wrong_size", wrong_size},
                                 {"unknown_call", unknown_call},
                                 {"extremes", extremes},
                                 {"many_waits", many_waits},
                                 {"flood", flood},
                                 {"open_many", open_many},
                                 {"with_descriptors", with_descriptors},
                                 {"end_one_way", end_one_way},
                                 {"map_it", map_it},
                                 {"colours", colours}};

}  // namespace

int main(int count, char** words) { return attempts::make(kAttempts, count, words); }

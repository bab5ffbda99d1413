#include "shim/link.h"

#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "shim/own_clock.h"

namespace simbench::shim {
namespace {

int world_link = -1;
pthread_t asking_thread{};
Identity own_identity{};

ssize_t transfer(bool is_request, iovec* pieces, std::size_t count) {
  msghdr message{};
  message.msg_iov = pieces;
  message.msg_iovlen = count;
  const long call = is_request ? SYS_sendmsg : SYS_recvmsg;
  ssize_t moved = 0;
  do {
    moved = syscall(call, world_link, &message, is_request ? MSG_NOSIGNAL : 0);
  } while (moved < 0 && errno == EINTR);
  return moved;
}

// Without a world there is nothing to go on with.
[[noreturn]] void lose() {
  syscall(SYS_exit_group, 125);
  __builtin_unreachable();
}

// Before the program's own code: the shim's variables have no constructors that could undo this.
__attribute__((constructor)) void join_world() {
  const char* number = getenv(kLinkVariable);
  if (number == nullptr) return;
  world_link = atoi(number);
  asking_thread = pthread_self();
  if (ask_for({.call = Call::kHello}, own_identity) < 0) lose();
  if (own_identity.only_clock != 0) open_own_clock();
}

}  // namespace

bool has_world() { return world_link >= 0; }

bool is_simulated() { return has_world() && own_identity.only_clock == 0; }

bool is_link(int fd) { return fd >= 0 && fd == world_link; }

const Identity& identity() { return own_identity; }

std::int64_t ask(const Request& request, Sent head, Sent tail, Received* reply) {
  if (pthread_self() != asking_thread) {
    asking_thread = pthread_self();
    give_up("a second thread or process that waits or asks for the time");
  }
  Request header = request;
  if (header.fd >= 0) header.fd = number_of(header.fd);
  header.size = static_cast<std::uint32_t>(head.size + tail.size);
  iovec out[] = {{&header, sizeof header},
                 {const_cast<void*>(head.data), head.size},
                 {const_cast<void*>(tail.data), tail.size}};
  if (transfer(true, out, 3) < 0) lose();
  Reply answer{};
  char nothing = 0;
  Received none{.data = &nothing};
  Received& received = reply != nullptr ? *reply : none;
  iovec in[] = {{&answer, sizeof answer}, {received.data, received.capacity}};
  if (transfer(false, in, 2) < static_cast<ssize_t>(sizeof answer)) lose();
  received.size = answer.size;
  if ((answer.error & kHasExpirations) != 0) make_signals();
  const int error = answer.error & ~kHasExpirations;
  return error == 0 ? answer.value : refuse(error);
}

int refuse(int error) {
  errno = error;
  return -1;
}

void give_up(const char* what, const char* why) {
  // The world ends the program in place of a reply.
  ask({.call = Call::kNote}, {what, strlen(what)}, {why, strlen(why)});
  lose();
}

void* find_real(const char* name) {
  void* function = dlsym(RTLD_NEXT, name);
  if (function == nullptr) give_up(name);
  return function;
}

}  // namespace simbench::shim

#include "shim/link.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "shim/local.h"
#include "shim/own_clock.h"

namespace simbench::shim {
namespace {

int world_link = -1;
long asking_thread = 0;
Identity own_identity{};
Kind kinds[kMostDescriptors];
// What the world calls them: descriptors that were duplicated have one number.
int numbers[kMostDescriptors];
int descriptors_of[kMostDescriptors];  // by number: how many

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
  asking_thread = syscall(SYS_gettid);
  Received reply{.data = &own_identity, .capacity = sizeof own_identity};
  if (ask({.call = Call::kHello}, {}, {}, &reply) < 0) lose();
  if (own_identity.only_clock != 0) open_own_clock();
}

}  // namespace

bool has_world() { return world_link >= 0; }

bool is_simulated() { return has_world() && own_identity.only_clock == 0; }

const Identity& identity() { return own_identity; }

std::int64_t ask(const Request& request, Sent head, Sent tail, Received* reply) {
  if (syscall(SYS_gettid) != asking_thread) {
    asking_thread = syscall(SYS_gettid);
    give_up("a second thread or process that waits or asks for the time");
  }
  Request header = request;
  header.fd = number_of(request.fd);
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
  if (error == 0) return answer.value;
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

namespace {

// Tells the world when it was the last.
void release(int fd) {
  if (kind_of(fd) == Kind::kReal) return;
  const bool is_last = --descriptors_of[numbers[fd]] == 0;
  if (is_last && (kinds[fd] == Kind::kSocket || kinds[fd] == Kind::kTimer)) {
    ask({.call = Call::kClose, .fd = fd});
  }
  kinds[fd] = Kind::kReal;
}

void name_descriptor(int fd, Kind kind, int number) {
  kinds[fd] = kind;
  numbers[fd] = number;
  ++descriptors_of[number];
}

}  // namespace

int number_of(int fd) { return kind_of(fd) == Kind::kReal ? fd : numbers[fd]; }

Kind kind_of(int fd) { return fd >= 0 && fd < kMostDescriptors ? kinds[fd] : Kind::kReal; }

void set_kind(int fd, Kind kind) {
  if (fd >= 0 && fd < kMostDescriptors) kinds[fd] = kind;
}

int open_descriptor(Kind kind, bool nonblocking, bool close_on_exec) {
  const int fd = eventfd(0, (nonblocking ? EFD_NONBLOCK : 0) | (close_on_exec ? EFD_CLOEXEC : 0));
  if (fd < 0) return -1;
  if (fd >= kMostDescriptors) {
    syscall(SYS_close, fd);
    errno = EMFILE;
    return -1;
  }
  release(fd);  // of one that is no more
  int number = fd;
  while (descriptors_of[number] != 0) number = (number + 1) % kMostDescriptors;
  name_descriptor(fd, kind, number);
  return fd;
}

int duplicate_descriptor(int from, int to) {
  if (to < 0) return -1;
  const Kind kind = kind_of(from);
  if (kind == Kind::kEpoll) give_up("a duplicate of an epoll descriptor");
  if (to >= kMostDescriptors && kind != Kind::kReal) {
    syscall(SYS_close, to);
    errno = EMFILE;
    return -1;
  }
  if (from == to) return to;
  const int number = number_of(from);
  if (kind != Kind::kReal) ++descriptors_of[number];  // though `to` were the last but this
  release(to);
  if (kind == Kind::kReal) return to;
  --descriptors_of[number];
  name_descriptor(to, kind, number);
  if (kind == Kind::kSocket) copy_socket_state(from, to);
  return to;
}

bool is_blocking(int fd) { return (syscall(SYS_fcntl, fd, F_GETFL) & O_NONBLOCK) == 0; }

SIMBENCH_CALL int close(int fd) {
  if (has_world() && fd == world_link) return 0;  // daemons close all that they do not know
  const bool was_local = is_local(fd);
  release(fd);
  const int result = static_cast<int>(syscall(SYS_close, fd));
  if (was_local) local_closed();
  return result;
}

SIMBENCH_CALL int fclose(FILE* file) {
  release(fileno(file));
  return SIMBENCH_REAL(fclose)(file);
}

}  // namespace simbench::shim

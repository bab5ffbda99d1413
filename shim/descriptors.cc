// Copies of descriptors: the world knows the original, and hears of it when the last is closed.
// A program that is executed has what its parent left of them.
#include <errno.h>
#include <fcntl.h>
#include <linux/close_range.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/begin.h"
#include "shim/children.h"
#include "shim/files.h"
#include "shim/link.h"
#include "shim/local.h"
#include "shim/refused_calls.h"
#include "shim/sockets.h"

namespace simbench::shim {
namespace {

Kind kinds[kMostDescriptors];
std::int16_t numbers[kMostDescriptors];  // the world's, by descriptor
std::int16_t copies[kMostDescriptors];   // how many descriptors a number has

bool is_kept(int fd) { return fd >= 0 && fd < kMostDescriptors; }

std::int16_t take_number() {
  std::int16_t number = 0;
  while (copies[number] != 0) ++number;  // there are as many as descriptors
  return number;
}

// `copy` stands for what `fd` stands for. Its own past is over.
int make_copy(int fd, int copy) {
  if (copy < 0 || kind_of(fd) == Kind::kReal) return copy;
  if (!is_kept(copy)) {
    machine_call(SYS_close, copy);
    return refuse(EMFILE);
  }
  kinds[copy] = kinds[fd];
  numbers[copy] = numbers[fd];
  ++copies[numbers[fd]];
  return copy;
}

void forget(int fd) {
  const Kind kind = kind_of(fd);
  if (kind == Kind::kReal) return;
  if (copies[numbers[fd]] == 1 && is_of_the_world(kind)) ask({.call = Call::kClose, .fd = fd});
  --copies[numbers[fd]];
  kinds[fd] = Kind::kReal;
}

}  // namespace

Kind kind_of(int fd) { return is_kept(fd) ? kinds[fd] : Kind::kReal; }

int number_of(int fd) { return numbers[fd]; }

bool is_open(int number) { return copies[number] != 0; }

void write_descriptors(char* room, std::size_t size) {
  room[0] = '\0';
  std::size_t used = 0;
  for (int fd = 0; fd < kMostDescriptors; ++fd) {
    if (!is_of_the_world(kinds[fd]) && kinds[fd] != Kind::kNetlink && kinds[fd] != Kind::kChance) {
      continue;
    }
    const long flags = machine_call(SYS_fcntl, fd, F_GETFD);
    if (flags < 0 || (flags & FD_CLOEXEC) != 0) continue;
    const int written = snprintf(room + used, size - used, "%d:%d:%d:%d ", fd,
                                 static_cast<int>(kinds[fd]), numbers[fd], state_of(fd).type);
    if (written < 0 || used + static_cast<std::size_t>(written) >= size) return;
    used += static_cast<std::size_t>(written);
  }
}

namespace {

// Takes "12" and what follows it.
int take_number(const char*& text) {
  int number = 0;
  for (; *text >= '0' && *text <= '9'; ++text) number = 10 * number + (*text - '0');
  if (*text != '\0') ++text;
  return number;
}

bool is_local_file(int fd) {
  struct stat status {};
  if (machine_call(SYS_fstat, fd, &status) < 0) return false;
  // A file without a type is one of the kernel's own: eventfd() and the like.
  return S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode) || (status.st_mode & S_IFMT) == 0;
}

}  // namespace

std::size_t take_descriptors(const char* text, std::int32_t* taken) {
  std::size_t count = 0;
  while (*text != '\0') {
    const int fd = take_number(text);
    const int kind = take_number(text);
    const int number = take_number(text);
    const int type = take_number(text);
    if (!is_kept(fd) || number >= kMostDescriptors || machine_call(SYS_fcntl, fd, F_GETFD) < 0) {
      continue;
    }
    kinds[fd] = static_cast<Kind>(kind);
    numbers[fd] = static_cast<std::int16_t>(number);
    if (copies[number]++ == 0) taken[count++] = number;
    state_of(fd) = {.type = type};
  }
  for (int fd = 0; fd < kMostDescriptors; ++fd) {
    if (kinds[fd] == Kind::kReal && !is_link(fd) && is_local_file(fd)) set_kind(fd, Kind::kLocal);
  }
  return count;
}

void set_kind(int fd, Kind kind) {
  if (!is_kept(fd)) return;
  kinds[fd] = kind;
  numbers[fd] = take_number();
  copies[numbers[fd]] = 1;
}

int open_descriptor(Kind kind, bool nonblocking, bool close_on_exec) {
  // A set of epoll() has real descriptors too, which the kernel watches.
  const long made =
      kind == Kind::kEpoll
          ? machine_call(SYS_epoll_create1, close_on_exec ? EPOLL_CLOEXEC : 0, 0, 0, 0, kOfTheShim)
          : machine_call(SYS_eventfd2, 0,
                         (nonblocking ? EFD_NONBLOCK : 0) | (close_on_exec ? EFD_CLOEXEC : 0));
  const int fd = static_cast<int>(made);
  if (fd < 0) return -1;
  if (!is_kept(fd)) {
    machine_call(SYS_close, fd);
    return refuse(EMFILE);
  }
  set_kind(fd, kind);
  return fd;
}

void discard_descriptor(int fd) {
  const int error = errno;
  --copies[numbers[fd]];
  kinds[fd] = Kind::kReal;
  machine_call(SYS_close, fd);
  errno = error;
}

bool is_blocking(int fd) { return (machine_call(SYS_fcntl, fd, F_GETFL) & O_NONBLOCK) == 0; }

SIMBENCH_CALL int close(int fd) {
  if (is_link(fd)) return 0;  // daemons close all that they do not know
  const bool was_local = is_local(fd);
  stamp_file(fd);
  forget(fd);
  const int result = static_cast<int>(machine_call(SYS_close, fd));
  if (was_local) local_closed();
  return result;
}

SIMBENCH_CALL int close_range(unsigned int first, unsigned int last, int flags) noexcept {
  if (!has_world()) return static_cast<int>(machine_call(SYS_close_range, first, last, flags));
  if (flags != 0 && flags != CLOSE_RANGE_CLOEXEC) return refuse(EINVAL);
  for (unsigned int fd = first; fd <= last && fd < kMostDescriptors; ++fd) {
    if (flags == 0) {
      close(static_cast<int>(fd));
    } else if (!is_link(static_cast<int>(fd))) {
      machine_call(SYS_fcntl, fd, F_SETFD, FD_CLOEXEC);
    }
  }
  return 0;
}

SIMBENCH_CALL void closefrom(int first) noexcept {
  close_range(static_cast<unsigned int>(first), kMostDescriptors, 0);
}

SIMBENCH_CALL int fclose(FILE* file) {
  const int fd = fileno(file);
  if (is_simulated() && fd >= 0) fflush(file);
  stamp_file(fd);
  forget(fd);
  return SIMBENCH_REAL(fclose)(file);
}

SIMBENCH_CALL int dup(int fd) noexcept {
  return make_copy(fd, static_cast<int>(machine_call(SYS_dup, fd)));
}

SIMBENCH_CALL int dup3(int fd, int copy, int flags) noexcept {
  if (is_link(copy)) return refuse(EBUSY);
  if (fd == copy) return refuse(EINVAL);
  const bool is_there = machine_call(SYS_fcntl, fd, F_GETFD) >= 0;
  if (is_there) forget(copy);
  return make_copy(fd, static_cast<int>(machine_call(SYS_dup3, fd, copy, flags)));
}

SIMBENCH_CALL int dup2(int fd, int copy) noexcept {
  if (fd == copy) return machine_call(SYS_fcntl, fd, F_GETFD) < 0 ? -1 : copy;
  return dup3(fd, copy, 0);
}

SIMBENCH_CALL int fcntl(int fd, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  const int result = static_cast<int>(machine_call(SYS_fcntl, fd, command, argument));
  const bool is_copy = command == F_DUPFD || command == F_DUPFD_CLOEXEC;
  return is_copy ? make_copy(fd, result) : result;
}

SIMBENCH_CALL int fcntl64(int fd, int command, ...) __attribute__((alias("fcntl")));

}  // namespace simbench::shim

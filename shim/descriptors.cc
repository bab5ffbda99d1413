// Copies of descriptors: the world knows the original, and hears of it when the last is closed.
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"
#include "shim/local.h"

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
    syscall(SYS_close, copy);
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

void set_kind(int fd, Kind kind) {
  if (!is_kept(fd)) return;
  kinds[fd] = kind;
  numbers[fd] = take_number();
  copies[numbers[fd]] = 1;
}

int open_descriptor(Kind kind, bool nonblocking, bool close_on_exec) {
  const int fd = eventfd(0, (nonblocking ? EFD_NONBLOCK : 0) | (close_on_exec ? EFD_CLOEXEC : 0));
  if (fd < 0) return -1;
  if (!is_kept(fd)) {
    syscall(SYS_close, fd);
    return refuse(EMFILE);
  }
  set_kind(fd, kind);
  return fd;
}

void discard_descriptor(int fd) {
  const int error = errno;
  --copies[numbers[fd]];
  kinds[fd] = Kind::kReal;
  syscall(SYS_close, fd);
  errno = error;
}

bool is_blocking(int fd) { return (syscall(SYS_fcntl, fd, F_GETFL) & O_NONBLOCK) == 0; }

SIMBENCH_CALL int close(int fd) {
  if (is_link(fd)) return 0;  // daemons close all that they do not know
  const bool was_local = is_local(fd);
  forget(fd);
  const int result = static_cast<int>(syscall(SYS_close, fd));
  if (was_local) local_closed();
  return result;
}

SIMBENCH_CALL int close_range(unsigned int first, unsigned int last, int flags) noexcept {
  if (!has_world()) return static_cast<int>(syscall(SYS_close_range, first, last, flags));
  if (flags != 0) return refuse(EINVAL);
  for (unsigned int fd = first; fd <= last && fd < kMostDescriptors; ++fd) {
    close(static_cast<int>(fd));
  }
  return 0;
}

SIMBENCH_CALL void closefrom(int first) noexcept {
  close_range(static_cast<unsigned int>(first), kMostDescriptors, 0);
}

SIMBENCH_CALL int fclose(FILE* file) {
  forget(fileno(file));
  return SIMBENCH_REAL(fclose)(file);
}

SIMBENCH_CALL int dup(int fd) noexcept {
  return make_copy(fd, static_cast<int>(syscall(SYS_dup, fd)));
}

SIMBENCH_CALL int dup3(int fd, int copy, int flags) noexcept {
  if (is_link(copy)) return refuse(EBUSY);
  if (fd == copy) return refuse(EINVAL);
  const bool is_there = syscall(SYS_fcntl, fd, F_GETFD) >= 0;
  if (is_there) forget(copy);
  return make_copy(fd, static_cast<int>(syscall(SYS_dup3, fd, copy, flags)));
}

SIMBENCH_CALL int dup2(int fd, int copy) noexcept {
  if (fd == copy) return syscall(SYS_fcntl, fd, F_GETFD) < 0 ? -1 : copy;
  return dup3(fd, copy, 0);
}

SIMBENCH_CALL int fcntl(int fd, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  const int result = static_cast<int>(syscall(SYS_fcntl, fd, command, argument));
  const bool is_copy = command == F_DUPFD || command == F_DUPFD_CLOEXEC;
  return is_copy ? make_copy(fd, result) : result;
}

SIMBENCH_CALL int fcntl64(int fd, int command, ...) __attribute__((alias("fcntl")));

}  // namespace simbench::shim

// Chance: every random byte comes from the world, so that a run repeats. This file also has read()
// and write() of descriptors that are not real.
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/card.h"
#include "shim/link.h"
#include "shim/local.h"
#include "shim/sockets.h"
#include "shim/streams.h"

namespace simbench::shim {
namespace {

bool is_chance(const char* path) {
  return is_simulated() && (strcmp(path, "/dev/urandom") == 0 || strcmp(path, "/dev/random") == 0);
}

ssize_t fill(void* data, std::size_t size) {
  if (!is_simulated()) return SIMBENCH_REAL(getrandom)(data, size, 0);
  std::size_t filled = 0;
  while (filled < size) {
    const std::size_t left = size - filled;
    const std::size_t part = left < kMostData ? left : kMostData;
    Received reply{.data = static_cast<unsigned char*>(data) + filled, .capacity = part};
    if (ask({.call = Call::kRandom, .a = static_cast<std::int64_t>(part)}, {}, {}, &reply) < 0) {
      return -1;
    }
    filled += part;
  }
  return static_cast<ssize_t>(size);
}

int open_path(int folder, const char* path, int flags, mode_t mode) {
  if (is_chance(path)) return open_descriptor(Kind::kChance, false, (flags & O_CLOEXEC) != 0);
  if (is_card(path)) return open_card(path, flags);
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

mode_t mode_of(int flags, va_list arguments) {
  const bool has_mode = (flags & (O_CREAT | O_TMPFILE)) != 0;
  return has_mode ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

SIMBENCH_CALL ssize_t getrandom(void* data, std::size_t size, unsigned int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(getrandom)(data, size, flags);
  return fill(data, size);
}

SIMBENCH_CALL int getentropy(void* data, std::size_t size) {
  if (!is_simulated()) return SIMBENCH_REAL(getentropy)(data, size);
  return fill(data, size) < 0 ? -1 : 0;
}

SIMBENCH_CALL void arc4random_buf(void* data, std::size_t size) { fill(data, size); }

SIMBENCH_CALL std::uint32_t arc4random() {
  std::uint32_t number = 0;
  fill(&number, sizeof number);
  return number;
}

SIMBENCH_CALL int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path(AT_FDCWD, path, flags, mode);
}

SIMBENCH_CALL int open64(const char* path, int flags, ...) __attribute__((alias("open")));

SIMBENCH_CALL int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_path(folder, path, flags, mode);
}

SIMBENCH_CALL int open_checked(const char* path, int flags) __asm__("__open_2");
int open_checked(const char* path, int flags) { return open_path(AT_FDCWD, path, flags, 0); }

SIMBENCH_CALL int open64_checked(const char* path, int flags) __asm__("__open64_2");
int open64_checked(const char* path, int flags) { return open_path(AT_FDCWD, path, flags, 0); }

namespace {

ssize_t read_chance(void* /*cookie*/, char* data, std::size_t size) { return fill(data, size); }

}  // namespace

SIMBENCH_CALL FILE* fopen(const char* path, const char* mode) {
  if (!is_chance(path)) return SIMBENCH_REAL(fopen)(path, mode);
  return fopencookie(nullptr, mode, {.read = read_chance, .write = {}, .seek = {}, .close = {}});
}

SIMBENCH_CALL FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

SIMBENCH_CALL ssize_t read(int fd, void* data, std::size_t size) {
  switch (kind_of(fd)) {
    case Kind::kSocket:
    case Kind::kStream:
      return recv(fd, data, size, 0);
    case Kind::kChance:
      return fill(data, size);
    case Kind::kTimer:
      return read_timer(fd, data, size);
    case Kind::kLocal:
      return local_read(fd, data, size);
    default:
      break;
  }
  return syscall(SYS_read, fd, data, size);
}

SIMBENCH_CALL ssize_t read_checked(int fd, void* data, std::size_t size,
                                   std::size_t room) __asm__("__read_chk");
ssize_t read_checked(int fd, void* data, std::size_t size, std::size_t room) {
  if (room < size) give_up("read() beyond its array");
  return read(fd, data, size);
}

SIMBENCH_CALL ssize_t write(int fd, const void* data, std::size_t size) {
  if (is_socket(fd) || is_stream(fd)) return send(fd, data, size, 0);
  if (is_local(fd)) return local_write(fd, data, size);
  return syscall(SYS_write, fd, data, size);
}

}  // namespace simbench::shim

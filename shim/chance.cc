// Chance: every random byte comes from the world, so that a run repeats. RDRAND and RDSEED cannot
// be taken from a program that has the instructions in its own code.
#include "shim/chance.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/card.h"
#include "shim/link.h"
#include "shim/local.h"

namespace simbench::shim {
namespace {

bool is_chance(const char* path) {
  return is_simulated() && (strcmp(path, "/dev/urandom") == 0 || strcmp(path, "/dev/random") == 0);
}

int open_path(int folder, const char* path, int flags, mode_t mode) {
  if (is_chance(path)) return open_descriptor(Kind::kChance, false, (flags & O_CLOEXEC) != 0);
  if (is_card(path)) return open_card(path, flags);
  const int fd = static_cast<int>(machine_call(SYS_openat, folder, path, flags, mode));
  if (fd >= 0 && is_simulated()) note_pipe(fd);
  return fd;
}

mode_t mode_of(int flags, va_list arguments) {
  const bool has_mode = (flags & (O_CREAT | O_TMPFILE)) != 0;
  return has_mode ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

ssize_t take_chance(void* data, std::size_t size) {
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

SIMBENCH_CALL ssize_t getrandom(void* data, std::size_t size, unsigned int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(getrandom)(data, size, flags);
  return take_chance(data, size);
}

SIMBENCH_CALL int getentropy(void* data, std::size_t size) {
  if (!is_simulated()) return SIMBENCH_REAL(getentropy)(data, size);
  return take_chance(data, size) < 0 ? -1 : 0;
}

SIMBENCH_CALL void arc4random_buf(void* data, std::size_t size) { take_chance(data, size); }

SIMBENCH_CALL std::uint32_t arc4random() {
  std::uint32_t number = 0;
  take_chance(&number, sizeof number);
  return number;
}

// What std::random_device("default") takes from the processor where it can.
SIMBENCH_CALL unsigned int device_value(void* device) __asm__("_ZNSt13random_device9_M_getvalEv");
unsigned int device_value(void* device) {
  if (!is_simulated()) {
    return real(&device_value, "_ZNSt13random_device9_M_getvalEv")(device);
  }
  return arc4random();
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

ssize_t read_chance(void* /*cookie*/, char* data, std::size_t size) {
  return take_chance(data, size);
}

}  // namespace

SIMBENCH_CALL FILE* fopen(const char* path, const char* mode) {
  if (!is_chance(path)) return SIMBENCH_REAL(fopen)(path, mode);
  return fopencookie(nullptr, mode, {.read = read_chance, .write = {}, .seek = {}, .close = {}});
}

SIMBENCH_CALL FILE* fopen64(const char* path, const char* mode) { return fopen(path, mode); }

}  // namespace simbench::shim

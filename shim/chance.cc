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

#include "shim/link.h"
#include "shim/local.h"

namespace simbench::shim {
bool is_chance(const char* path) {
  return is_simulated() && (strcmp(path, "/dev/urandom") == 0 || strcmp(path, "/dev/random") == 0);
}

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

}  // namespace simbench::shim

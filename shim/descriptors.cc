// Duplicates of descriptors: of those that stand for something of the world, too.
#include <fcntl.h>
#include <stdarg.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

int control(int fd, int command, long argument) {
  const int result = static_cast<int>(syscall(SYS_fcntl, fd, command, argument));
  const bool is_duplicate = command == F_DUPFD || command == F_DUPFD_CLOEXEC;
  return is_duplicate ? duplicate_descriptor(fd, result) : result;
}

}  // namespace

SIMBENCH_CALL int fcntl(int fd, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  const long argument = va_arg(arguments, long);
  va_end(arguments);
  return control(fd, command, argument);
}

SIMBENCH_CALL int fcntl64(int fd, int command, ...) __attribute__((alias("fcntl")));

SIMBENCH_CALL int dup(int fd) {
  return duplicate_descriptor(fd, static_cast<int>(syscall(SYS_dup, fd)));
}

SIMBENCH_CALL int dup2(int from, int to) {
  return duplicate_descriptor(from, static_cast<int>(syscall(SYS_dup2, from, to)));
}

SIMBENCH_CALL int dup3(int from, int to, int flags) {
  return duplicate_descriptor(from, static_cast<int>(syscall(SYS_dup3, from, to, flags)));
}

}  // namespace simbench::shim

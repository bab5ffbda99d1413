// What a call says of a descriptor that it is not for.
//
//   refuse_descriptor(-1, ENOTTY);  // EBADF: there is no such descriptor
#pragma once

#include <errno.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {

// Returns -1, with EBADF for a descriptor that is not open, else with what another kind gets.
inline int refuse_descriptor(int fd, int error_of_others) {
  const bool is_open_here = fd >= 0 && machine_call(SYS_fcntl, fd, F_GETFD) >= 0;
  return refuse(is_open_here ? error_of_others : EBADF);
}

}  // namespace simbench::shim

// System calls that are made past libc's functions, by syscall() or by libc itself, and that the
// world serves.
//
//   Word result = 0;
//   const Word arguments[6] = {CLOCK_REALTIME};
//   if (serve_call(SYS_clock_gettime, arguments, result)) print(result);
#pragma once

#include "shim/machine.h"

namespace simbench::shim {

// `result` is as the kernel's: minus an errno if it failed. False: the world has no such call.
bool serve_call(Word number, const Word* arguments, Word& result);

// futex(): waits in simulated time, and wakes who waits so. Locks that the kernel hands over
// (FUTEX_LOCK_PI and its kin) too.
Word serve_futex(const Word* arguments);

}  // namespace simbench::shim

// SIMBENCH_ASSERT(condition, message): a programming error stops the program, in Release too.
//
// For contracts that only a bug in simbench (or in an algorithm built on it) can break, where the
// check is cheap. Expected failures - input, network, hardware - are values or typed exceptions.
//
//   SIMBENCH_ASSERT(at >= now, "an event cannot be scheduled in the past");
#pragma once

#include <cstdio>
#include <cstdlib>

namespace simbench {

[[noreturn]] inline void assertion_failed(const char* condition, const char* message,
                                          const char* file, int line) {
  std::fprintf(stderr, "%s:%d: assertion failed: %s (%s)\n", file, line, message, condition);
  std::abort();
}

}  // namespace simbench

#define SIMBENCH_ASSERT(condition, message)                                  \
  do {                                                                       \
    if (!(condition)) [[unlikely]] {                                         \
      ::simbench::assertion_failed(#condition, message, __FILE__, __LINE__); \
    }                                                                        \
  } while (false)

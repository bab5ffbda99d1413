// Runs a part of a test in a process with a network namespace of its own; everything is gone with
// that.
//
//   const int result = in_sandbox([] { return reaches_member() ? kGood : 1; });
//   SKIP_WITHOUT_NAMESPACES(result);
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <string>

#include "hardware/experiment/network_sandbox.h"

namespace simbench::hardware {

inline constexpr int kGood = 0;
inline constexpr int kNotPermitted = 77;

// Runs `body` in a process with a network namespace of its own; its result, or kNotPermitted.
template <class Body>
int in_sandbox(const Body& body) {
  const pid_t process = fork();
  if (process == 0) {
    if (NetworkSandbox::enter()) _exit(kNotPermitted);
    int result = 99;
    try {
      result = body();
    } catch (const std::exception& error) {
      const std::string text = std::string(error.what()) + "\n";
      if (write(2, text.data(), text.size()) < 0) _exit(98);
    }
    _exit(result);
  }
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

#define SKIP_WITHOUT_NAMESPACES(result) \
  if ((result) == kNotPermitted) GTEST_SKIP() << "not run: no network namespace is permitted here"

}  // namespace simbench::hardware

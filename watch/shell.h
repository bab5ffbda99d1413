// A command of the user's, run by the shell (/bin/sh -c) beside the watch: it reads nothing, and is
// the leader of a process group, so that it ends with all that it has started.
//
//   const pid_t child = start_shell("date", {.output = STDERR_FILENO});
//
// Errors: std::system_error if it cannot be started.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace simbench::watch {

struct ShellOptions {
  int output = 2;                        // the descriptor that its standard output is
  std::vector<std::string> variables{};  // "NAME=value", beside those of this process
};

pid_t start_shell(const std::string& command, const ShellOptions& options);

}  // namespace simbench::watch

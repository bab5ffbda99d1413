// Other processes, of which there are none: a program of the simulated world is one process, in the
// foreground. Those that libc starts with all signals blocked are named here, since the kernel's
// filter (shim/refused_calls.h) could only kill; so is fork(), for a better text. The program's own
// number is here too: the world gives it.
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

constexpr char kBackground[] =
    ": the program starts a helper or goes to the background; run it as one process in the "
    "foreground";
constexpr char kAnother[] = ": the program starts another, which the world cannot follow";

}  // namespace

SIMBENCH_CALL pid_t getpid() {
  return is_simulated() ? identity().process : static_cast<pid_t>(syscall(SYS_getpid));
}

SIMBENCH_CALL pid_t fork() {
  if (has_world()) give_up("fork", kBackground);
  return SIMBENCH_REAL(fork)();
}

SIMBENCH_CALL int daemon(int keep_folder, int keep_output) {
  if (has_world()) give_up("daemon", kBackground);
  return SIMBENCH_REAL(daemon)(keep_folder, keep_output);
}

SIMBENCH_CALL int system(const char* command) {
  if (has_world()) give_up("system", kAnother);
  return SIMBENCH_REAL(system)(command);
}

SIMBENCH_CALL FILE* popen(const char* command, const char* mode) {
  if (has_world()) give_up("popen", kAnother);
  return SIMBENCH_REAL(popen)(command, mode);
}

SIMBENCH_CALL int posix_spawn(pid_t* process, const char* path,
                              const posix_spawn_file_actions_t* actions,
                              const posix_spawnattr_t* attributes, char* const* arguments,
                              char* const* environment) {
  if (has_world()) give_up("posix_spawn", kAnother);
  return SIMBENCH_REAL(posix_spawn)(process, path, actions, attributes, arguments, environment);
}

SIMBENCH_CALL int posix_spawnp(pid_t* process, const char* file,
                               const posix_spawn_file_actions_t* actions,
                               const posix_spawnattr_t* attributes, char* const* arguments,
                               char* const* environment) {
  if (has_world()) give_up("posix_spawnp", kAnother);
  return SIMBENCH_REAL(posix_spawnp)(process, file, actions, attributes, arguments, environment);
}

}  // namespace simbench::shim

// Processes: fork() and its kin, who waits for them, and signals between them. A forked process has
// a link of its own and begins when its turn comes. Numbers of processes are the world's.
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "shim/begin.h"
#include "shim/children.h"
#include "shim/link.h"
#include "shim/waiting.h"

namespace simbench::shim {
namespace {

constexpr int kMostChildren = 256;

struct KnownChild {
  int number = 0;  // 0: none
  pid_t machine = 0;
};
KnownChild children[kMostChildren];

void forget_child(int number) {
  for (KnownChild& child : children) {
    if (child.number == number) child = {};
  }
}

// What wait4() takes for the world's number, which may be -1, 0 or minus a group. 0 with ECHILD:
// none.
pid_t awaited(pid_t number) {
  if (number == -1 || number == 0) return number;
  const pid_t machine = number > 0
                            ? machine_number_of_child(number)
                            : static_cast<pid_t>(-ask({.call = Call::kFindProcess, .a = -number}));
  if (machine != -1 && machine != 1) return machine;
  errno = ECHILD;
  return 0;
}

}  // namespace

void add_child(int number, pid_t machine) {
  for (KnownChild& child : children) {
    if (child.number != 0) continue;
    child = {number, machine};
    return;
  }
}

pid_t machine_number_of_child(int number) {
  for (const KnownChild& child : children) {
    if (child.number == number && number > 0) return child.machine;
  }
  return -1;
}

int number_of_process(pid_t machine) {
  for (const KnownChild& child : children) {
    if (child.machine == machine && child.number != 0) return child.number;
  }
  const int before = errno;
  const std::int64_t number = ask({.call = Call::kFindProcess, .a = machine, .b = 1});
  errno = before;
  return static_cast<int>(number);
}

void forget_parent() {
  for (KnownChild& child : children) child = {};
  forget_signal_timers();
}

SIMBENCH_CALL pid_t getpid() {
  return is_simulated() ? identity().process : static_cast<pid_t>(machine_call(SYS_getpid));
}

SIMBENCH_CALL pid_t getppid() {
  return is_simulated() ? identity().parent : static_cast<pid_t>(machine_call(SYS_getppid));
}

SIMBENCH_CALL pid_t fork() {
  if (!has_world()) return SIMBENCH_REAL(fork)();
  if (!is_simulated()) {
    give_up("fork",
            ": the program starts a helper or goes to the background; beside real hosts it must be "
            "one process in the foreground");
  }
  Newcomer child;
  if (!announce(Call::kNewProcess, child)) return -1;
  const pid_t machine = SIMBENCH_REAL(fork)();
  if (machine == 0) {
    identity();  // begins the conversation, and with it the child's turn
    return 0;
  }
  if (machine > 0) add_child(child.number, machine);
  tell_started(child, false, machine > 0 ? machine : 0);
  return machine > 0 ? child.number : -1;
}

// As fork(), which it may be: the child has memory of its own.
SIMBENCH_CALL pid_t vfork() { return fork(); }
SIMBENCH_CALL pid_t fork_plainly() __asm__("_Fork");
pid_t fork_plainly() { return fork(); }

SIMBENCH_CALL int daemon(int keep_folder, int keep_output) {
  if (!is_simulated()) return SIMBENCH_REAL(daemon)(keep_folder, keep_output);
  const pid_t child = fork();
  if (child < 0) return -1;
  if (child > 0) _exit(0);
  setsid();
  // The program's folder is the root of what it may write to.
  if (keep_output == 0) {
    const int nothing = open("/dev/null", O_RDWR);
    for (int fd = 0; fd < 3; ++fd) dup2(nothing, fd);
    if (nothing > 2) close(nothing);
  }
  static_cast<void>(keep_folder);
  return 0;
}

SIMBENCH_CALL pid_t wait4(pid_t number, int* status, int options, struct rusage* usage) {
  if (!is_simulated()) {
    return static_cast<pid_t>(machine_call(SYS_wait4, number, status, options, usage));
  }
  const pid_t machine = awaited(number);
  if (machine == 0 && number != 0) return -1;
  int ended_how = 0;
  for (bool has_looked = false;; has_looked = true) {
    const long ended = machine_call(SYS_wait4, machine, &ended_how, options | WNOHANG, nullptr);
    if (ended < 0) return -1;
    if (ended == 0 && (options & WNOHANG) != 0) return 0;
    if (ended == 0) {
      if (!wait_for_activity(has_looked)) return -1;
      continue;
    }
    if (status != nullptr) *status = ended_how;
    if (usage != nullptr) *usage = {};
    const int known = number_of_process(static_cast<pid_t>(ended));
    if (!WIFSTOPPED(ended_how) && !WIFCONTINUED(ended_how)) forget_child(known);
    return known;
  }
}

SIMBENCH_CALL pid_t wait3(int* status, int options, struct rusage* usage) {
  return wait4(-1, status, options, usage);
}
SIMBENCH_CALL pid_t waitpid(pid_t number, int* status, int options) {
  return wait4(number, status, options, nullptr);
}
SIMBENCH_CALL pid_t wait(int* status) { return wait4(-1, status, 0, nullptr); }

SIMBENCH_CALL int waitid(idtype_t kind, id_t number, siginfo_t* info, int options) {
  if (!is_simulated()) return SIMBENCH_REAL(waitid)(kind, number, info, options);
  pid_t machine = static_cast<pid_t>(number);
  if (kind == P_PID && (machine = awaited(static_cast<pid_t>(number))) == 0) return -1;
  if (kind == P_PGID && number != 0) machine = -awaited(-static_cast<pid_t>(number));
  for (bool has_looked = false;; has_looked = true) {
    siginfo_t found{};
    const long result = machine_call(SYS_waitid, kind, machine, &found, options | WNOHANG, nullptr);
    if (result < 0) return -1;
    if (found.si_pid != 0) {
      found.si_pid = number_of_process(found.si_pid);
      found.si_utime = 0;
      found.si_stime = 0;
      const bool has_ended =
          found.si_code == CLD_EXITED || found.si_code == CLD_KILLED || found.si_code == CLD_DUMPED;
      if (has_ended && (options & WNOWAIT) == 0) forget_child(found.si_pid);
    }
    if (info != nullptr) *info = found;
    if (found.si_pid != 0 || (options & WNOHANG) != 0) return 0;
    if (!wait_for_activity(has_looked)) return -1;
  }
}

SIMBENCH_CALL int kill(pid_t process, int signal) {
  if (!is_simulated()) return SIMBENCH_REAL(kill)(process, signal);
  if (signal < 0 || signal >= NSIG) return refuse(EINVAL);
  return static_cast<int>(ask({.call = Call::kSignal, .a = process, .b = signal}));
}

SIMBENCH_CALL int sigqueue(pid_t process, int signal, const sigval value) {
  if (!is_simulated()) return SIMBENCH_REAL(sigqueue)(process, signal, value);
  if (signal < 0 || signal >= NSIG || process <= 0) return refuse(EINVAL);
  return static_cast<int>(
      ask({.call = Call::kSignal, .a = process, .b = signal}, {&value, sizeof value}));
}

SIMBENCH_CALL int raise(int signal) {
  if (!is_simulated()) return SIMBENCH_REAL(raise)(signal);
  const long result =
      machine_call(SYS_tgkill, machine_call(SYS_getpid), machine_call(SYS_gettid), signal);
  // The kernel's filter knows the first process of the program alone.
  if (result < 0 && errno == ESRCH) return kill(identity().process, signal);
  return static_cast<int>(result);
}

SIMBENCH_CALL int tgkill(pid_t process, pid_t thread, int signal) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_tgkill, process, thread, signal));
  return process == identity().process && thread == own_thread() ? raise(signal)
                                                                 : kill(process, signal);
}

SIMBENCH_CALL int killpg(pid_t group, int signal) {
  if (!is_simulated()) return SIMBENCH_REAL(killpg)(group, signal);
  return group < 0 ? refuse(EINVAL) : kill(group == 0 ? 0 : -group, signal);
}

SIMBENCH_CALL void abort() {
  if (is_simulated()) {
    sigset_t only{};
    sigaddset(&only, SIGABRT);
    sigprocmask(SIG_UNBLOCK, &only, nullptr);
    raise(SIGABRT);
    signal(SIGABRT, SIG_DFL);
    raise(SIGABRT);
  }
  SIMBENCH_REAL(abort)();
  __builtin_unreachable();
}

// Groups and sessions have the numbers of the processes that began them; one that began before the
// program is the program's first.

namespace {

pid_t known_number(long machine) {
  if (machine < 0) return -1;
  const int number = number_of_process(static_cast<pid_t>(machine));
  return number > 0 ? number : 1;
}

}  // namespace

SIMBENCH_CALL pid_t getpgid(pid_t process) {
  if (!is_simulated()) return static_cast<pid_t>(machine_call(SYS_getpgid, process));
  std::int64_t machine = 0;
  if (process != 0) machine = ask({.call = Call::kFindProcess, .a = process});
  return machine < 0 ? -1 : known_number(machine_call(SYS_getpgid, machine));
}

SIMBENCH_CALL pid_t getpgrp() { return getpgid(0); }

SIMBENCH_CALL pid_t getsid(pid_t process) {
  if (!is_simulated()) return static_cast<pid_t>(machine_call(SYS_getsid, process));
  std::int64_t machine = 0;
  if (process != 0) machine = ask({.call = Call::kFindProcess, .a = process});
  return machine < 0 ? -1 : known_number(machine_call(SYS_getsid, machine));
}

SIMBENCH_CALL pid_t setsid() {
  const long session = machine_call(SYS_setsid);
  return !is_simulated() || session < 0 ? static_cast<pid_t>(session) : identity().process;
}

SIMBENCH_CALL int setpgid(pid_t process, pid_t group) {
  if (!is_simulated()) return static_cast<int>(machine_call(SYS_setpgid, process, group));
  std::int64_t numbers[] = {process, group};
  for (std::int64_t& each : numbers) {
    if (each == identity().process) each = 0;
    if (each != 0) each = ask({.call = Call::kFindProcess, .a = each});
    if (each < 0) return -1;
  }
  return static_cast<int>(machine_call(SYS_setpgid, numbers[0], numbers[1]));
}

}  // namespace simbench::shim

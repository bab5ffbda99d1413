#include "processes/call_filter.h"

#include <linux/audit.h>
#include <linux/futex.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>

#include <bit>
#include <cerrno>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>

#include "shim/refused_calls.h"

namespace simbench::processes {
namespace {

using shim::Refusal;
using Code = std::vector<sock_filter>;

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
constexpr std::uint32_t kOtherAbi = 0x40000000;  // x32
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
constexpr std::uint32_t kOtherAbi = 0x40000000;  // none
#else
#error "the numbers of this architecture's system calls are not known"
#endif
static_assert(std::endian::native == std::endian::little, "arguments are read in two halves");

constexpr std::uint32_t kTrap = SECCOMP_RET_TRAP;
constexpr std::uint32_t kAllow = SECCOMP_RET_ALLOW;
constexpr std::uint32_t failing(std::uint32_t error) { return SECCOMP_RET_ERRNO | error; }

constexpr sock_filter statement(int code, std::uint32_t k) {
  return {.code = static_cast<std::uint16_t>(code), .jt = 0, .jf = 0, .k = k};
}
constexpr sock_filter verdict(std::uint32_t action) { return statement(BPF_RET | BPF_K, action); }
constexpr sock_filter load(std::size_t offset) {
  return statement(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
// The lower and upper half of an argument.
constexpr sock_filter load_low(int argument) {
  return load(offsetof(seccomp_data, args) + 8 * static_cast<std::size_t>(argument));
}
constexpr sock_filter load_high(int argument) {
  return load(offsetof(seccomp_data, args) + 8 * static_cast<std::size_t>(argument) + 4);
}
// Goes on if the test holds, or else skips as many statements.
constexpr sock_filter unless(int test, std::uint32_t k, std::size_t skipped) {
  return {.code = static_cast<std::uint16_t>(BPF_JMP | test | BPF_K),
          .jt = 0,
          .jf = static_cast<std::uint8_t>(skipped),
          .k = k};
}

void append(Code& code, const Code& more) { code.insert(code.end(), more.begin(), more.end()); }

// What is done if what was loaded is the value; it must end with a verdict.
Code on(std::uint32_t value, const Code& done) {
  Code code{unless(BPF_JEQ, value, done.size())};
  append(code, done);
  return code;
}

Code one_of(int argument, std::initializer_list<std::uint32_t> values, std::uint32_t then,
            std::uint32_t otherwise) {
  Code code{load_low(argument)};
  for (const std::uint32_t value : values) append(code, on(value, {verdict(then)}));
  code.push_back(verdict(otherwise));
  return code;
}

Code only_for(int argument, std::uint32_t value, std::uint32_t otherwise = kTrap) {
  return one_of(argument, {value}, kAllow, otherwise);
}

// Where the clock alone is the world's: those that end at a time of it.
Code futex_of_machine() {
  Code code{load_low(3), unless(BPF_JEQ, 0, 3), load_high(3), unless(BPF_JEQ, 0, 1),
            verdict(kAllow)};
  append(code,
         {load_low(1), unless(BPF_JSET, FUTEX_CLOCK_REALTIME, 1), verdict(kTrap), verdict(kAllow)});
  return code;
}

// Threads and processes, as libc makes them: of this program's namespaces, and with its parent.
// What fork() would do is handed to the shim.
Code clone() {
  constexpr std::uint32_t kElsewhere = CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC |
                                       CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET | CLONE_PARENT |
                                       CLONE_PTRACE | CLONE_UNTRACED;
  Code code{load_low(0)};
  append(code, on(SIGCHLD, {verdict(kTrap)}));
  append(code, {unless(BPF_JSET, kElsewhere, 1), verdict(kTrap), verdict(kAllow)});
  return code;
}

// SIGSYS is the shim's.
Code signal_action() {
  Code code{load_low(0)};
  append(code, on(SIGSYS, only_for(4, shim::kOfTheShim, failing(0))));
  code.push_back(verdict(kAllow));
  return code;
}

Code process_control() {
  return one_of(0,
                {PR_SET_PDEATHSIG, PR_SET_SECCOMP, PR_SET_SECUREBITS, PR_CAPBSET_DROP,
                 PR_CAP_AMBIENT, PR_SET_KEEPCAPS, PR_SET_DUMPABLE},
                failing(0), kAllow);
}

// What is the machine's where the clock alone is the world's.
bool is_of_machine(int number) {
  switch (number) {
    case SYS_clock_gettime:
    case SYS_nanosleep:
    case SYS_clock_nanosleep:
    case SYS_pselect6:
    case SYS_ppoll:
    case SYS_epoll_create1:
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
    case SYS_timerfd_create:
    case SYS_timer_create:
    case SYS_setitimer:
    case SYS_rt_sigsuspend:
    case SYS_rt_sigtimedwait:
    case SYS_getrandom:
    case SYS_getrusage:
    case SYS_times:
    case SYS_sysinfo:
    case SYS_getcpu:
    case SYS_sched_getaffinity:
#ifdef __x86_64__
    case SYS_select:
    case SYS_poll:
    case SYS_epoll_create:
    case SYS_epoll_wait:
    case SYS_alarm:
    case SYS_pause:
#endif
      return true;
    default:
      return false;
  }
}

// The calls that the table calls partly refused, and those that it does not have.
Code by_arguments(int number) {
  switch (number) {
    case SYS_socket:
    case SYS_socketpair:
      return only_for(0, AF_UNIX);
#ifdef SYS_poll
    case SYS_poll:
      return only_for(2, 0);
#endif
    case SYS_ppoll:
    case SYS_rt_sigtimedwait:
    case SYS_epoll_create1:
      return only_for(4, shim::kOfTheShim);
    case SYS_epoll_pwait:
      return only_for(3, 0);  // which does not wait
    case SYS_utimensat:
      return one_of(4, {shim::kOfTheShim}, kAllow, failing(0));
    case SYS_clone:
      return clone();
    case SYS_fallocate:  // room beyond the end of a file would pass RLIMIT_FSIZE
      return only_for(1, 0, failing(EOPNOTSUPP));
    default:
      throw std::logic_error("a call is partly refused, and no rule says which part");
  }
}

Code by_arguments_beside_clock(int number) {
  switch (number) {
    case SYS_socket:
      return one_of(0, {AF_UNIX, AF_INET, AF_INET6, AF_NETLINK}, kAllow, kTrap);
    case SYS_futex:
      return futex_of_machine();
    default:
      return by_arguments(number);
  }
}

// Locks of the world are all its own; beside the machine's, those that end at a time of its clock.
bool is_partly(const shim::RefusedCall& call, Served served) {
  return call.refusal == Refusal::kPartly || (call.number == SYS_futex && served == Served::kClock);
}

std::uint32_t verdict_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::kDenied:
      return failing(EPERM);
    case Refusal::kAbsent:
      return failing(ENOSYS);
    case Refusal::kIgnored:
      return failing(0);
    case Refusal::kNotIntercepted:
    case Refusal::kForbidden:
    case Refusal::kPartly:
      break;
  }
  return kTrap;
}

}  // namespace

std::vector<sock_filter> call_filter(Served served) {
  Code code{load(offsetof(seccomp_data, arch)), unless(BPF_JEQ, kArchitecture, 1),
            statement(BPF_JMP | BPF_JA, 1), verdict(SECCOMP_RET_KILL_PROCESS),
            load(offsetof(seccomp_data, nr))};
  append(code, {unless(BPF_JGE, kOtherAbi, 1), verdict(SECCOMP_RET_KILL_PROCESS)});
  append(code, {unless(BPF_JGT, shim::kYoungest, 1), verdict(failing(ENOSYS))});
  const bool has_machine = served == Served::kClock;
  const auto partly = has_machine ? by_arguments_beside_clock : by_arguments;
  for (const shim::RefusedCall& call : shim::kRefusedCalls) {
    if (has_machine && is_of_machine(call.number)) continue;
    append(code, on(static_cast<std::uint32_t>(call.number),
                    is_partly(call, served) ? partly(call.number)
                                            : Code{verdict(verdict_of(call.refusal))}));
  }
  for (const int kill :
       {SYS_kill, SYS_tkill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo}) {
    append(code, on(static_cast<std::uint32_t>(kill), only_for(0, kOwnProcess, failing(ESRCH))));
  }
  append(code, on(SYS_prlimit64, only_for(0, 0, failing(EPERM))));
  append(code, on(SYS_prctl, process_control()));
  append(code, on(SYS_rt_sigaction, signal_action()));
  code.push_back(verdict(kAllow));
  return code;
}

void set_own_process(std::span<sock_filter> filter, std::uint32_t process) {
  for (sock_filter& each : filter) {
    if (each.k == kOwnProcess) each.k = process;
  }
}

}  // namespace simbench::processes

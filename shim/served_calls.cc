#include "shim/served_calls.h"

#include <errno.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <sys/epoll.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/sysinfo.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/times.h>
#include <sys/timex.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "shim/link.h"

namespace simbench::shim {
namespace {

// What a function of libc's returned, as the kernel has it.
Word as_kernel(std::int64_t result) { return result == -1 ? -errno : static_cast<Word>(result); }

bool serve_clock(Word number, const Word* a, Word& result) {
  const auto clock = static_cast<clockid_t>(a[0]);
  switch (number) {
    case SYS_clock_gettime:
      result = as_kernel(clock_gettime(clock, at<timespec>(a[1])));
      return true;
    case SYS_clock_settime:
      result = as_kernel(clock_settime(clock, at<timespec>(a[1])));
      return true;
    case SYS_clock_adjtime:
      result = as_kernel(clock_adjtime(clock, at<timex>(a[1])));
      return true;
    case SYS_adjtimex:
      result = as_kernel(adjtimex(at<timex>(a[0])));
      return true;
    case SYS_gettimeofday:
      result = as_kernel(gettimeofday(at<timeval>(a[0]), at<void>(a[1])));
      return true;
    case SYS_settimeofday:
      result = as_kernel(settimeofday(at<timeval>(a[0]), at<struct timezone>(a[1])));
      return true;
#ifdef SYS_time
    case SYS_time:
      result = as_kernel(time(at<time_t>(a[0])));
      return true;
#endif
    default:
      return false;
  }
}

// The sixth argument of pselect6().
struct MaskWord {
  const sigset_t* mask;
  std::size_t size;
};

bool serve_wait(Word number, const Word* a, Word& result) {
  switch (number) {
    case SYS_nanosleep:
      result = as_kernel(nanosleep(at<timespec>(a[0]), at<timespec>(a[1])));
      return true;
    case SYS_clock_nanosleep:
      result = -clock_nanosleep(static_cast<clockid_t>(a[0]), static_cast<int>(a[1]),
                                at<timespec>(a[2]), at<timespec>(a[3]));
      return true;
    case SYS_ppoll:
      result = as_kernel(ppoll(at<pollfd>(a[0]), static_cast<nfds_t>(a[1]), at<timespec>(a[2]),
                               at<sigset_t>(a[3])));
      return true;
    case SYS_pselect6: {
      const auto* mask = at<MaskWord>(a[5]);
      result = as_kernel(pselect(static_cast<int>(a[0]), at<fd_set>(a[1]), at<fd_set>(a[2]),
                                 at<fd_set>(a[3]), at<timespec>(a[4]),
                                 mask != nullptr ? mask->mask : nullptr));
      return true;
    }
    case SYS_epoll_create1:
      result = as_kernel(epoll_create1(static_cast<int>(a[0])));
      return true;
    case SYS_epoll_ctl:
      result = as_kernel(epoll_ctl(static_cast<int>(a[0]), static_cast<int>(a[1]),
                                   static_cast<int>(a[2]), at<epoll_event>(a[3])));
      return true;
    case SYS_epoll_pwait:
      result = as_kernel(epoll_pwait(static_cast<int>(a[0]), at<epoll_event>(a[1]),
                                     static_cast<int>(a[2]), static_cast<int>(a[3]),
                                     at<sigset_t>(a[4])));
      return true;
    case SYS_epoll_pwait2:
      result =
          as_kernel(epoll_pwait2(static_cast<int>(a[0]), at<epoll_event>(a[1]),
                                 static_cast<int>(a[2]), at<timespec>(a[3]), at<sigset_t>(a[4])));
      return true;
    case SYS_timerfd_create:
      result = as_kernel(timerfd_create(static_cast<clockid_t>(a[0]), static_cast<int>(a[1])));
      return true;
    case SYS_rt_sigsuspend:
      result = as_kernel(sigsuspend(at<sigset_t>(a[0])));
      return true;
    case SYS_rt_sigtimedwait:
      result = as_kernel(sigtimedwait(at<sigset_t>(a[0]), at<siginfo_t>(a[1]), at<timespec>(a[2])));
      return true;
    case SYS_setitimer:
      result = as_kernel(
          setitimer(static_cast<__itimer_which_t>(a[0]), at<itimerval>(a[1]), at<itimerval>(a[2])));
      return true;
    case SYS_futex:
      result = serve_futex(a);
      return true;
    default:
      return false;
  }
}

#ifdef __x86_64__
// What later architectures do without.
bool serve_old_wait(Word number, const Word* a, Word& result) {
  switch (number) {
    case SYS_poll:
      result = as_kernel(poll(at<pollfd>(a[0]), static_cast<nfds_t>(a[1]), static_cast<int>(a[2])));
      return true;
    case SYS_select:
      result = as_kernel(select(static_cast<int>(a[0]), at<fd_set>(a[1]), at<fd_set>(a[2]),
                                at<fd_set>(a[3]), at<timeval>(a[4])));
      return true;
    case SYS_epoll_create:
      result = as_kernel(epoll_create(static_cast<int>(a[0])));
      return true;
    case SYS_epoll_wait:
      result = as_kernel(epoll_wait(static_cast<int>(a[0]), at<epoll_event>(a[1]),
                                    static_cast<int>(a[2]), static_cast<int>(a[3])));
      return true;
    case SYS_alarm:
      result = static_cast<Word>(alarm(static_cast<unsigned int>(a[0])));
      return true;
    case SYS_pause:
      result = as_kernel(pause());
      return true;
    default:
      return false;
  }
}
#else
bool serve_old_wait(Word /*number*/, const Word* /*arguments*/, Word& /*result*/) { return false; }
#endif

bool serve_facts(Word number, const Word* a, Word& result) {
  switch (number) {
    case SYS_getrusage:
      result = as_kernel(getrusage(static_cast<__rusage_who_t>(a[0]), at<struct rusage>(a[1])));
      return true;
    case SYS_times:
      result = as_kernel(times(at<struct tms>(a[0])));
      return true;
    case SYS_sysinfo:
      result = as_kernel(sysinfo(at<struct sysinfo>(a[0])));
      return true;
    case SYS_getcpu:
      result = as_kernel(getcpu(at<unsigned int>(a[0]), at<unsigned int>(a[1])));
      return true;
    case SYS_sched_getaffinity: {
      const auto size = static_cast<std::size_t>(a[1]);
      const auto done = sched_getaffinity(static_cast<pid_t>(a[0]), size, at<cpu_set_t>(a[2]));
      // The kernel says how much of it it has written.
      result =
          done < 0 ? as_kernel(done) : static_cast<Word>(size < sizeof(Word) ? size : sizeof(Word));
      return true;
    }
    default:
      return false;
  }
}

bool serve_process(Word number, const Word* a, Word& result) {
  const auto process = static_cast<pid_t>(a[0]);
  switch (number) {
    case SYS_getpid:
      result = getpid();
      return true;
    case SYS_getppid:
      result = getppid();
      return true;
    case SYS_gettid:
      result = gettid();
      return true;
    case SYS_kill:
      result = as_kernel(kill(process, static_cast<int>(a[1])));
      return true;
    case SYS_tgkill:
      result = as_kernel(tgkill(process, static_cast<pid_t>(a[1]), static_cast<int>(a[2])));
      return true;
    case SYS_wait4:
      result =
          as_kernel(wait4(process, at<int>(a[1]), static_cast<int>(a[2]), at<struct rusage>(a[3])));
      return true;
    case SYS_getrandom:
      result = as_kernel(getrandom(at<void>(a[0]), static_cast<std::size_t>(a[1]),
                                   static_cast<unsigned int>(a[2])));
      return true;
    case SYS_socket:
      result =
          as_kernel(socket(static_cast<int>(a[0]), static_cast<int>(a[1]), static_cast<int>(a[2])));
      return true;
#ifdef __x86_64__
    case SYS_fork:
    case SYS_vfork:
      result = as_kernel(fork());
      return true;
#endif
    case SYS_clone:
      // As fork(): with a memory of its own and no more than its parent's signal.
      if (static_cast<unsigned long>(a[0]) != SIGCHLD || a[1] != 0) return false;
      result = as_kernel(fork());
      return true;
    case SYS_execve:
      result = as_kernel(execve(at<char>(a[0]), at<char*>(a[1]), at<char*>(a[2])));
      return true;
    default:
      return false;
  }
}

}  // namespace

bool serve_call(Word number, const Word* arguments, Word& result) {
  if (!is_simulated()) return false;
  const int before = errno;
  const bool is_served =
      serve_clock(number, arguments, result) || serve_wait(number, arguments, result) ||
      serve_old_wait(number, arguments, result) || serve_facts(number, arguments, result) ||
      serve_process(number, arguments, result);
  errno = before;
  return is_served;
}

SIMBENCH_CALL long call_by_number(long number, ...) __asm__("syscall");
long call_by_number(long number, ...) {
  va_list words;
  va_start(words, number);
  Word arguments[6];
  for (Word& word : arguments) word = va_arg(words, Word);
  va_end(words);
  Word result = 0;
  if (!serve_call(number, arguments, result)) {
    result = kernel_call(number, arguments[0], arguments[1], arguments[2], arguments[3],
                         arguments[4], arguments[5]);
  }
  return result >= 0 || result < -4095 ? result : refuse(static_cast<int>(-result));
}

}  // namespace simbench::shim

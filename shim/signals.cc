// Signals: timers that make them (alarm(), setitimer(), timer_create()), waiting for one, and those
// that a process sends to itself.
//
// The world counts their expirations and tells of them with a reply; the shim then makes the real
// signal, so that handlers, masks and default actions are the kernel's.
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "shim/link.h"
#include "shim/own_clock.h"
#include "shim/refused_calls.h"
#include "shim/senders.h"

namespace simbench::shim {
namespace {

constexpr int kMostTimers = 64;
constexpr int kIntervalTimer = 0;  // alarm()'s and setitimer()'s; the others are timer_create()'s

struct SignalTimer {
  bool exists = false;
  int signal = SIGALRM;  // 0: none
  clockid_t clock = CLOCK_MONOTONIC;
  sigval value{};
  int overrun = 0;
};
SignalTimer timers[kMostTimers];
__thread HandledSignals handled __attribute__((tls_model("initial-exec")));

void count_handler(int signal, const sigset_t& blocked) {
  struct sigaction action {};
  sigaction(signal, nullptr, &action);
  const bool has_handler = (action.sa_flags & SA_SIGINFO) != 0 ||
                           (action.sa_handler != SIG_IGN && action.sa_handler != SIG_DFL);
  if (!has_handler || sigismember(&blocked, signal) == 1) return;
  ++handled.all;
  if ((action.sa_flags & SA_RESTART) == 0) ++handled.interrupting;
}

bool is_pending(int signal) {
  sigset_t pending{};
  sigpending(&pending);
  return sigismember(&pending, signal) == 1;
}

void make_signal(int number, int times) {
  SignalTimer& timer = timers[number];
  if (timer.signal == 0) return;
  if (is_pending(timer.signal)) {  // a signal that waits stands for all
    timer.overrun += times;
    return;
  }
  timer.overrun = times - 1;
  sigset_t blocked{};
  sigprocmask(SIG_SETMASK, nullptr, &blocked);
  count_handler(timer.signal, blocked);
  siginfo_t info{};
  info.si_signo = timer.signal;
  info.si_code = number == kIntervalTimer ? SI_KERNEL : SI_TIMER;
  if (number != kIntervalTimer) {
    info.si_timerid = number;
    info.si_overrun = timer.overrun;
    info.si_value = timer.value;
  }
  const long made = machine_call(SYS_rt_tgsigqueueinfo, machine_call(SYS_getpid),
                                 machine_call(SYS_gettid), timer.signal, &info);
  if (made < 0) raise(timer.signal);  // of a forked process
}

int set_timer(int number, bool is_absolute, const itimerspec& setting, itimerspec* before) {
  if (!is_time(setting.it_value) || !is_time(setting.it_interval)) return refuse(EINVAL);
  return set_world_timer({.call = Call::kSetSignalTimer,
                          .fd = -1 - number,
                          .a = is_absolute ? 1 : 0,
                          .b = timers[number].clock},
                         setting, before);
}

itimerspec query_timer(int number) {
  itimerspec setting{};
  query_world_timer({.call = Call::kQuerySignalTimer, .fd = -1 - number}, setting);
  return setting;
}

timespec timespec_of(const timeval& time) { return {time.tv_sec, time.tv_usec * 1000}; }

// Rounded up, as what is left must not seem to be over.
timeval to_timeval(const timespec& time) {
  const std::int64_t us = (time.tv_sec * kSecond + time.tv_nsec + 999) / 1000;
  return {us / 1'000'000, us % 1'000'000};
}

itimerval to_itimerval(const itimerspec& setting) {
  return {.it_interval = to_timeval(setting.it_interval), .it_value = to_timeval(setting.it_value)};
}

// timer_create()'s, or null with errno.
SignalTimer* find_timer(timer_t id) {
  for (SignalTimer& timer : timers) {
    if (&timer == id && timer.exists) return &timer;
  }
  errno = EINVAL;
  return nullptr;
}

int index_of(const SignalTimer* timer) { return static_cast<int>(timer - timers); }

bool is_clock_of_timers(clockid_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_MONOTONIC || clock == CLOCK_BOOTTIME ||
         clock == CLOCK_TAI || clock == CLOCK_REALTIME_ALARM || clock == CLOCK_BOOTTIME_ALARM;
}

// The signal that a timer is to make; 0: none, -1: not a valid wish.
int signal_of(const sigevent& event) {
  const bool is_signal = event.sigev_signo > 0 && event.sigev_signo < NSIG;
  switch (event.sigev_notify) {
    case SIGEV_NONE:
      return 0;
    case SIGEV_THREAD_ID:  // the process has it
    case SIGEV_SIGNAL:
      return is_signal ? event.sigev_signo : -1;
    case SIGEV_THREAD:
      give_up("timer_create() with SIGEV_THREAD");
    default:
      return -1;
  }
}

// Timers of the host's own clock where that alone is the world's; the machine measures the
// intervals.
timer_t own_timers[kMostTimers];
int own_timer_count = 0;

void note_own_timer(timer_t id) {
  if (own_timer_count < kMostTimers) own_timers[own_timer_count++] = id;
}

bool is_own_timer(timer_t id) {
  for (int i = 0; i < own_timer_count; ++i) {
    if (own_timers[i] == id) return true;
  }
  return false;
}

}  // namespace

HandledSignals handled_signals() { return handled; }

void count_handlers(const sigset_t& blocked) {
  sigset_t pending{};
  sigpending(&pending);
  for (int signal = 1; signal < NSIG; ++signal) {
    if (sigismember(&pending, signal) == 1 && sigismember(&blocked, signal) == 0) {
      count_handler(signal, blocked);
    }
  }
}

void forget_signal_timers() {
  for (SignalTimer& timer : timers) timer = {};
}

void make_signals() {
  const int before = errno;
  Expiration expirations[kMostTimers];
  Received reply{.data = expirations, .capacity = sizeof expirations};
  ask({.call = Call::kTakeExpirations}, {}, {}, &reply);
  for (std::size_t i = 0; i < reply.size / sizeof expirations[0]; ++i) {
    make_signal(-1 - expirations[i].timer, static_cast<int>(expirations[i].times));
  }
  errno = before;
}

SIMBENCH_CALL int setitimer(__itimer_which_t which, const itimerval* setting, itimerval* before) {
  if (!is_simulated()) return SIMBENCH_REAL(setitimer)(which, setting, before);
  if (which != ITIMER_REAL) give_up("setitimer() of CPU time");
  itimerspec old{};
  const itimerspec wanted{.it_interval = timespec_of(setting->it_interval),
                          .it_value = timespec_of(setting->it_value)};
  if (set_timer(kIntervalTimer, false, wanted, &old) < 0) return -1;
  if (before != nullptr) *before = to_itimerval(old);
  return 0;
}

SIMBENCH_CALL int getitimer(__itimer_which_t which, itimerval* setting) {
  if (!is_simulated()) return SIMBENCH_REAL(getitimer)(which, setting);
  if (which != ITIMER_REAL) give_up("getitimer() of CPU time");
  *setting = to_itimerval(query_timer(kIntervalTimer));
  return 0;
}

SIMBENCH_CALL unsigned int alarm(unsigned int seconds) {
  if (!is_simulated()) return SIMBENCH_REAL(alarm)(seconds);
  itimerspec before{};
  set_timer(kIntervalTimer, false, {.it_interval = {}, .it_value = {seconds, 0}}, &before);
  // To the nearest second, but an alarm that is set has one left.
  const bool is_first = before.it_value.tv_sec == 0 && before.it_value.tv_nsec > 0;
  const bool is_up = is_first || before.it_value.tv_nsec >= kSecond / 2;
  return static_cast<unsigned int>(before.it_value.tv_sec) + (is_up ? 1 : 0);
}

SIMBENCH_CALL useconds_t ualarm(useconds_t us, useconds_t interval_us) {
  if (!is_simulated()) return SIMBENCH_REAL(ualarm)(us, interval_us);
  const auto time = [](useconds_t each) {
    return timespec{.tv_sec = each / 1'000'000, .tv_nsec = each % 1'000'000 * 1000L};
  };
  itimerspec before{};
  set_timer(kIntervalTimer, false, {.it_interval = time(interval_us), .it_value = time(us)},
            &before);
  return static_cast<useconds_t>(nanoseconds(before.it_value) / 1000);
}

SIMBENCH_CALL int timer_create(clockid_t clock, sigevent* event, timer_t* id) {
  if (!is_simulated()) {
    const clockid_t machine = is_own_clock(clock) ? CLOCK_MONOTONIC : clock;
    const int result = SIMBENCH_REAL(timer_create)(machine, event, id);
    if (result == 0 && machine != clock) note_own_timer(*id);
    return result;
  }
  if (!is_clock_of_timers(clock)) return refuse(ENOTSUP);
  const int signal = event != nullptr ? signal_of(*event) : SIGALRM;
  if (signal < 0) return refuse(EINVAL);
  for (int number = kIntervalTimer + 1; number < kMostTimers; ++number) {
    if (timers[number].exists) continue;
    sigval value{.sival_int = number};
    if (event != nullptr) value = event->sigev_value;
    timers[number] = {
        .exists = true, .signal = signal, .clock = clock, .value = value, .overrun = 0};
    *id = &timers[number];
    return 0;
  }
  return refuse(EAGAIN);
}

SIMBENCH_CALL int timer_settime(timer_t id, int flags, const itimerspec* setting,
                                itimerspec* before) {
  if (!is_simulated()) {
    const bool is_absolute = (flags & TIMER_ABSTIME) != 0;
    if (is_absolute && is_own_timer(id)) give_up("timer_settime() to a time of the system clock");
    return SIMBENCH_REAL(timer_settime)(id, flags, setting, before);
  }
  const SignalTimer* timer = find_timer(id);
  if (timer == nullptr) return -1;
  return set_timer(index_of(timer), (flags & TIMER_ABSTIME) != 0, *setting, before);
}

SIMBENCH_CALL int timer_gettime(timer_t id, itimerspec* setting) {
  if (!is_simulated()) return SIMBENCH_REAL(timer_gettime)(id, setting);
  const SignalTimer* timer = find_timer(id);
  if (timer == nullptr) return -1;
  *setting = query_timer(index_of(timer));
  return 0;
}

SIMBENCH_CALL int timer_getoverrun(timer_t id) {
  if (!is_simulated()) return SIMBENCH_REAL(timer_getoverrun)(id);
  const SignalTimer* timer = find_timer(id);
  return timer == nullptr ? -1 : timer->overrun;
}

SIMBENCH_CALL int timer_delete(timer_t id) {
  if (!is_simulated()) return SIMBENCH_REAL(timer_delete)(id);
  SignalTimer* timer = find_timer(id);
  if (timer == nullptr) return -1;
  *timer = {};
  return static_cast<int>(ask({.call = Call::kDropSignalTimer, .fd = -1 - index_of(timer)}));
}

SIMBENCH_CALL int pause() {
  if (!is_simulated()) return SIMBENCH_REAL(pause)();
  return ppoll(nullptr, 0, nullptr, nullptr);
}

SIMBENCH_CALL int sigsuspend(const sigset_t* mask) {
  if (!is_simulated()) return SIMBENCH_REAL(sigsuspend)(mask);
  return ppoll(nullptr, 0, nullptr, mask);
}

// A signal that is awaited is blocked, so it stays pending until it is taken here.
SIMBENCH_CALL int sigtimedwait(const sigset_t* set, siginfo_t* info, const timespec* timeout) {
  if (!is_simulated()) return SIMBENCH_REAL(sigtimedwait)(set, info, timeout);
  if (timeout != nullptr && !is_time(*timeout)) return refuse(EINVAL);
  Request wait{.call = Call::kWait, .a = static_cast<std::int64_t>(Deadline::kNever)};
  if (timeout != nullptr) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    wait.a = static_cast<std::int64_t>(Deadline::kAtMonotonicTime);
    wait.b = nanoseconds(now) + nanoseconds(*timeout);
  }
  for (;;) {
    const timespec none{};
    const long taken = machine_call(SYS_rt_sigtimedwait, set, info, &none, 8, kOfTheShim);
    if (taken > 0 && info != nullptr) show_sender(*info);
    if (taken > 0 || errno != EAGAIN) return static_cast<int>(taken);
    const std::uint64_t before = handled.all;
    if (ask(wait) >= 0) return refuse(EAGAIN);
    if (handled.all != before) return -1;
  }
}

SIMBENCH_CALL int sigwaitinfo(const sigset_t* set, siginfo_t* info) {
  if (!is_simulated()) return SIMBENCH_REAL(sigwaitinfo)(set, info);
  return sigtimedwait(set, info, nullptr);
}

SIMBENCH_CALL int sigwait(const sigset_t* set, int* signal) {
  if (!is_simulated()) return SIMBENCH_REAL(sigwait)(set, signal);
  for (;;) {
    const int taken = sigtimedwait(set, nullptr, nullptr);
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0) return errno;
    *signal = taken;
    return 0;
  }
}

}  // namespace simbench::shim

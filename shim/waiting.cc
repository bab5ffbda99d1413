// Waiting: sleeps, select and poll.
//
// A wait asks the world which of its descriptors are ready, and how long to wait. Real descriptors
// (files, pipes, Unix-domain sockets) are looked at before and after, and whenever another thread
// of the host has done something that may have made one ready.
#include "shim/waiting.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <initializer_list>

#include "shim/descriptor_errors.h"
#include "shim/link.h"
#include "shim/own_clock.h"
#include "shim/refused_calls.h"

namespace simbench::shim {
namespace {

constexpr int kMostInterests = 1024;

Until after(const timespec* timeout) {
  return timeout == nullptr ? Until{} : Until{Deadline::kAfter, nanoseconds(*timeout)};
}

int look_at_real(pollfd* interests, nfds_t count) {
  const timespec now{};
  return static_cast<int>(machine_call(SYS_ppoll, interests, count, &now, nullptr, kOfTheShim));
}

// Asks until something is ready or the time has come. Fails with EINTR once a handler has run, and
// with EAGAIN when real descriptors should be looked at; what is left goes to `until` and
// `left_ns`. Signals without a handler do not end a wait.
std::int64_t ask_to_wait(Until& until, std::uint32_t flags, Sent interests, Received answer,
                         std::int64_t* left_ns) {
  for (;;) {
    const std::uint64_t before = handled_signals().all;
    Received reply = answer;
    const std::int64_t ready = ask({.call = Call::kWait,
                                    .a = static_cast<std::int64_t>(until.kind),
                                    .b = until.ns,
                                    .flags = flags},
                                   interests, {}, &reply);
    if (ready >= 0 || (errno != EINTR && errno != EAGAIN)) return ready;
    int reason = handled_signals().all != before ? EINTR : errno;
    std::int64_t left = 0;
    memcpy(&left, answer.data, sizeof left);
    if (left_ns != nullptr) *left_ns = left;
    if (until.kind == Deadline::kAfter) until.ns = left;
    if (reason == EINTR && handled_signals().all == before) {
      pthread_testcancel();
      if ((flags & kWatchesReal) == 0) continue;
      reason = EAGAIN;  // the signal may be what signalfd() waits for
    }
    return refuse(reason);
  }
}

bool is_of_the_kernel(Kind kind) { return !is_of_the_world(kind) || kind == Kind::kEpoll; }

// What of these the world and the kernel watch.
struct Watched {
  pollfd* real = nullptr;
  Interest* simulated = nullptr;
  std::size_t asked = 0;
  bool watches_real = false;
};

void divide(const pollfd* interests, nfds_t count, Watched& watched) {
  for (nfds_t i = 0; i < count; ++i) {
    const Kind kind = kind_of(interests[i].fd);
    const bool has_real = is_of_the_kernel(kind);
    watched.watches_real |= has_real && interests[i].fd >= 0;
    watched.real[i] = {
        .fd = has_real ? interests[i].fd : -1, .events = interests[i].events, .revents = 0};
    if (!is_of_the_world(kind)) continue;
    watched.simulated[watched.asked++] = {
        .fd = number_of(interests[i].fd), .events = interests[i].events, .ready = 0};
  }
}

}  // namespace

Until after_ms(int timeout_ms) {
  return timeout_ms < 0 ? Until{} : Until{Deadline::kAfter, timeout_ms * std::int64_t{1'000'000}};
}

Mask::Mask(const sigset_t* wanted) : is_set_(wanted != nullptr) {
  if (!is_set_) return;
  sigset_t pending{};
  sigpending(&pending);
  for (int signal = 1; signal < NSIG; ++signal) {
    has_handled_ |= sigismember(&pending, signal) == 1 && sigismember(wanted, signal) == 0;
  }
  sigprocmask(SIG_SETMASK, wanted, &before_);
}

Mask::~Mask() {
  if (is_set_) sigprocmask(SIG_SETMASK, &before_, nullptr);
}

int wait(pollfd* interests, nfds_t count, Until& until, std::int64_t* left_ns) {
  pthread_testcancel();
  if (count > kMostInterests) return refuse(EINVAL);
  const std::size_t places = count + 1;  // what is left of the time needs one too
  Watched watched{.real = static_cast<pollfd*>(__builtin_alloca(places * sizeof(pollfd))),
                  .simulated = static_cast<Interest*>(__builtin_alloca(places * sizeof(Interest)))};
  auto* answered = static_cast<Interest*>(__builtin_alloca(places * sizeof(Interest)));
  divide(interests, count, watched);
  std::uint32_t flags = watched.watches_real ? kWatchesReal : 0U;
  for (std::int64_t is_ready = -1; is_ready < 0; flags |= kHasOnlyLooked) {
    if (watched.watches_real && look_at_real(watched.real, count) > 0)
      until = {Deadline::kAfter, 0};
    is_ready = ask_to_wait(until, flags, {watched.simulated, watched.asked * sizeof(Interest)},
                           {.data = answered, .capacity = places * sizeof(Interest)}, left_ns);
    if (is_ready < 0 && errno != EAGAIN) {
      pthread_testcancel();
      return -1;
    }
  }
  if (watched.watches_real) look_at_real(watched.real, count);
  int ready = 0;
  std::size_t looked_at = 0;
  for (nfds_t i = 0; i < count; ++i) {
    const bool is_ours = is_of_the_world(kind_of(interests[i].fd));
    interests[i].revents = watched.real[i].revents;
    if (is_ours) interests[i].revents |= answered[looked_at++].ready;
    ready += interests[i].revents != 0;
  }
  return ready;
}

namespace {

int wait_masked(pollfd* interests, nfds_t count, Until until, const sigset_t* signals) {
  const Mask mask(signals);
  return mask.has_handled() ? refuse(EINTR) : wait(interests, count, until);
}

int sleep_until(Until until, std::int64_t* left_ns = nullptr) {
  return wait(nullptr, 0, until, left_ns) < 0 ? -1 : 0;
}

}  // namespace

bool is_time(const timespec& time) {
  return time.tv_sec >= 0 && time.tv_nsec >= 0 && time.tv_nsec < kSecond;
}

timespec to_timespec(std::int64_t ns) {
  timespec time{.tv_sec = ns / kSecond, .tv_nsec = ns % kSecond};
  if (time.tv_nsec < 0) {
    time.tv_nsec += kSecond;
    --time.tv_sec;
  }
  return time;
}

std::int64_t nanoseconds(const timespec& time) {
  return time.tv_sec >= INT64_MAX / kSecond ? INT64_MAX : time.tv_sec * kSecond + time.tv_nsec;
}

SIMBENCH_CALL int nanosleep(const timespec* interval, timespec* left) {
  if (!is_simulated()) return SIMBENCH_REAL(nanosleep)(interval, left);
  if (!is_time(*interval)) return refuse(EINVAL);
  std::int64_t left_ns = 0;
  const int result = sleep_until(after(interval), &left_ns);
  if (left != nullptr && result < 0) *left = to_timespec(left_ns);
  return result;
}

SIMBENCH_CALL int clock_nanosleep(clockid_t clock, int flags, const timespec* time,
                                  timespec* left) {
  if (!is_simulated()) {
    const bool waits_for_own = is_own_clock(clock) && (flags & TIMER_ABSTIME) != 0;
    if (!waits_for_own) return SIMBENCH_REAL(clock_nanosleep)(clock, flags, time, left);
    return is_time(*time) ? sleep_until_own_time(nanoseconds(*time)) : EINVAL;
  }
  if (!is_time(*time)) return EINVAL;
  if ((flags & TIMER_ABSTIME) == 0) return nanosleep(time, left) < 0 ? errno : 0;
  const bool is_system = clock == CLOCK_REALTIME || clock == CLOCK_TAI;
  const Until until{is_system ? Deadline::kAtSystemTime : Deadline::kAtMonotonicTime,
                    nanoseconds(*time)};
  return sleep_until(until) < 0 ? errno : 0;
}

SIMBENCH_CALL int usleep(useconds_t us) {
  if (!is_simulated()) return SIMBENCH_REAL(usleep)(us);
  return sleep_until({Deadline::kAfter, us * std::int64_t{1000}});
}

SIMBENCH_CALL unsigned int sleep(unsigned int seconds) {
  if (!is_simulated()) return SIMBENCH_REAL(sleep)(seconds);
  std::int64_t left_ns = 0;
  if (sleep_until({Deadline::kAfter, seconds * kSecond}, &left_ns) == 0) return 0;
  return static_cast<unsigned int>(left_ns / kSecond);
}

SIMBENCH_CALL int poll(pollfd* interests, nfds_t count, int timeout_ms) {
  if (!is_simulated()) return SIMBENCH_REAL(poll)(interests, count, timeout_ms);
  return wait_masked(interests, count, after_ms(timeout_ms), nullptr);
}

SIMBENCH_CALL int poll_checked(pollfd* interests, nfds_t count, int timeout_ms,
                               std::size_t size) __asm__("__poll_chk");
int poll_checked(pollfd* interests, nfds_t count, int timeout_ms, std::size_t size) {
  if (size / sizeof *interests < count) give_up("poll() beyond its array");
  return poll(interests, count, timeout_ms);
}

SIMBENCH_CALL int ppoll(pollfd* interests, nfds_t count, const timespec* timeout,
                        const sigset_t* mask) {
  if (!is_simulated()) return SIMBENCH_REAL(ppoll)(interests, count, timeout, mask);
  if (timeout != nullptr && !is_time(*timeout)) return refuse(EINVAL);
  return wait_masked(interests, count, after(timeout), mask);
}

SIMBENCH_CALL int ppoll_checked(pollfd* interests, nfds_t count, const timespec* timeout,
                                const sigset_t* mask, std::size_t size) __asm__("__ppoll_chk");
int ppoll_checked(pollfd* interests, nfds_t count, const timespec* timeout, const sigset_t* mask,
                  std::size_t size) {
  if (size / sizeof *interests < count) give_up("ppoll() beyond its array");
  return ppoll(interests, count, timeout, mask);
}

namespace {

constexpr int kBitsOfWord = 64;

bool has(fd_set* set, int fd) { return set != nullptr && FD_ISSET(fd, set); }

// Leaves in the set, where it was asked for, only what is so; returns how many that are.
int answer(const pollfd& interest, short asked, int ready, fd_set* set) {
  if ((interest.events & asked) == 0) return 0;
  if ((interest.revents & ready) != 0) return 1;
  FD_CLR(interest.fd, set);
  return 0;
}

}  // namespace

SIMBENCH_CALL int pselect(int count, fd_set* readers, fd_set* writers, fd_set* exceptions,
                          const timespec* timeout, const sigset_t* mask) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(pselect)(count, readers, writers, exceptions, timeout, mask);
  }
  if (count < 0 || (timeout != nullptr && !is_time(*timeout))) return refuse(EINVAL);
  const int asked_for = count < kMostInterests ? count : kMostInterests;
  pollfd interests[kMostInterests];
  nfds_t asked = 0;
  for (int fd = 0; fd < asked_for; ++fd) {
    const int events = (has(readers, fd) ? POLLIN : 0) | (has(writers, fd) ? POLLOUT : 0) |
                       (has(exceptions, fd) ? POLLPRI : 0);
    if (events == 0) continue;
    if (machine_call(SYS_fcntl, fd, F_GETFD) < 0) return refuse(EBADF);
    interests[asked++] = {.fd = fd, .events = static_cast<short>(events), .revents = 0};
  }
  if (wait_masked(interests, asked, after(timeout), mask) < 0) return -1;
  // Linux writes whole words of the sets.
  for (int fd = asked_for; fd % kBitsOfWord != 0 && fd < kMostInterests; ++fd) {
    for (fd_set* set : {readers, writers, exceptions}) {
      if (set != nullptr) FD_CLR(fd, set);
    }
  }
  int ready = 0;
  for (nfds_t i = 0; i < asked; ++i) {
    ready += answer(interests[i], POLLIN, POLLIN | POLLHUP | POLLERR, readers);
    ready += answer(interests[i], POLLOUT, POLLOUT | POLLERR, writers);
    ready += answer(interests[i], POLLPRI, POLLPRI, exceptions);
  }
  return ready;
}

SIMBENCH_CALL int select(int count, fd_set* readers, fd_set* writers, fd_set* exceptions,
                         timeval* timeout) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(select)(count, readers, writers, exceptions, timeout);
  }
  if (timeout == nullptr) return pselect(count, readers, writers, exceptions, nullptr, nullptr);
  const timespec interval{.tv_sec = timeout->tv_sec, .tv_nsec = timeout->tv_usec * 1000};
  if (timeout->tv_sec < 0 || timeout->tv_usec < 0) return refuse(EINVAL);
  timespec begin{};
  timespec end{};
  clock_gettime(CLOCK_MONOTONIC, &begin);
  const int ready = pselect(count, readers, writers, exceptions, &interval, nullptr);
  clock_gettime(CLOCK_MONOTONIC, &end);
  // Linux says what is left.
  const std::int64_t left_us =
      (nanoseconds(interval) - (nanoseconds(end) - nanoseconds(begin))) / 1000;
  const std::int64_t at_least = left_us > 0 ? left_us : 0;
  *timeout = {.tv_sec = at_least / 1'000'000, .tv_usec = at_least % 1'000'000};
  return ready;
}

bool wait_for_ready(int fd, short events, std::int64_t timeout_ns) {
  const std::uint64_t before = handled_signals().interrupting;
  pollfd interest{.fd = fd, .events = events, .revents = 0};
  Until until = timeout_ns < 0 ? Until{} : Until{Deadline::kAfter, timeout_ns};
  for (;;) {
    const int ready = wait(&interest, 1, until);
    if (ready > 0) return true;
    if (ready == 0) errno = EAGAIN;
    // One that has a timeout is never begun anew (signal(7)).
    const bool is_restarted =
        ready < 0 && errno == EINTR && timeout_ns < 0 && handled_signals().interrupting == before;
    if (!is_restarted) return false;
  }
}

bool wait_for_input(int fd, std::int64_t timeout_ns) {
  return wait_for_ready(fd, POLLIN, timeout_ns);
}

bool wait_for_activity(bool has_only_looked) {
  pthread_testcancel();
  const HandledSignals before = handled_signals();
  ask({.call = Call::kWait,
       .a = static_cast<std::int64_t>(Deadline::kNever),
       .flags = kWatchesReal | (has_only_looked ? kHasOnlyLooked : 0U)});
  if (handled_signals().interrupting == before.interrupting) return true;
  errno = EINTR;
  return false;
}

}  // namespace simbench::shim

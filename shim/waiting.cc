// Waiting: sleeps, select, poll, epoll and timers.
//
// A wait asks the world which of its descriptors are ready, and how long to wait. Real descriptors
// (files, pipes, Unix-domain sockets) are looked at before and after, and whenever another program
// of the host has done something that may have made one ready.
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
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

struct Until {
  Deadline kind = Deadline::kNever;
  std::int64_t ns = 0;
};

Until after(const timespec* timeout) {
  return timeout == nullptr ? Until{} : Until{Deadline::kAfter, nanoseconds(*timeout)};
}

Until after_ms(int timeout_ms) {
  return timeout_ms < 0 ? Until{} : Until{Deadline::kAfter, timeout_ms * std::int64_t{1'000'000}};
}

int look_at_real(pollfd* interests, nfds_t count) {
  const timespec now{};
  return static_cast<int>(syscall(SYS_ppoll, interests, count, &now, nullptr, kOfTheShim));
}

// The signal mask of ppoll() and its kin, while they wait.
class Mask {
 public:
  explicit Mask(const sigset_t* wanted) : is_set_(wanted != nullptr) {
    if (!is_set_) return;
    sigset_t pending{};
    sigpending(&pending);
    for (int signal = 1; signal < NSIG; ++signal) {
      has_handled_ |= sigismember(&pending, signal) == 1 && sigismember(wanted, signal) == 0;
    }
    sigprocmask(SIG_SETMASK, wanted, &before_);
  }
  ~Mask() {
    if (is_set_) sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  // Whether it let a signal through that had waited.
  bool has_handled() const { return has_handled_; }

 private:
  bool is_set_;
  bool has_handled_ = false;
  sigset_t before_{};
};

// Asks until something is ready or the time has come. Fails with EINTR once a handler has run, and
// with EAGAIN when real descriptors should be looked at; what is left goes to `until` and
// `left_ns`. Signals without a handler do not end a wait.
std::int64_t ask_to_wait(Until& until, bool watches_real, Sent interests, Received answer,
                         std::int64_t* left_ns) {
  for (;;) {
    const std::uint64_t before = handled_signals().all;
    Received reply = answer;
    const std::int64_t ready = ask({.call = Call::kWait,
                                    .a = static_cast<std::int64_t>(until.kind),
                                    .b = until.ns,
                                    .flags = watches_real ? kWatchesReal : 0U},
                                   interests, {}, &reply);
    if (ready >= 0 || (errno != EINTR && errno != EAGAIN)) return ready;
    const int reason = handled_signals().all != before ? EINTR : errno;
    std::int64_t left = 0;
    memcpy(&left, answer.data, sizeof left);
    if (left_ns != nullptr) *left_ns = left;
    if (until.kind == Deadline::kAfter) until.ns = left;
    if (reason == EINTR && handled_signals().all == before) continue;
    return refuse(reason);
  }
}

// As poll(): which of the descriptors are ready, at the latest then.
int wait(pollfd* interests, nfds_t count, Until until, const sigset_t* signals = nullptr,
         std::int64_t* left_ns = nullptr) {
  const Mask mask(signals);
  if (mask.has_handled()) return refuse(EINTR);
  if (count > kMostInterests) return refuse(EINVAL);
  pollfd real[kMostInterests];
  Interest simulated[kMostInterests];
  std::size_t asked = 0;
  bool watches_real = false;
  for (nfds_t i = 0; i < count; ++i) {
    const bool is_ours = is_of_the_world(kind_of(interests[i].fd));
    watches_real |= !is_ours && interests[i].fd >= 0;
    real[i] = {.fd = is_ours ? -1 : interests[i].fd, .events = interests[i].events, .revents = 0};
    if (is_ours) {
      simulated[asked++] = {
          .fd = number_of(interests[i].fd), .events = interests[i].events, .ready = 0};
    }
  }
  Interest answered[kMostInterests];
  std::int64_t is_ready = -1;
  while (is_ready < 0) {
    if (watches_real && look_at_real(real, count) > 0) until = {Deadline::kAfter, 0};
    is_ready = ask_to_wait(until, watches_real, {simulated, asked * sizeof simulated[0]},
                           {.data = answered, .capacity = sizeof answered}, left_ns);
    if (is_ready < 0 && errno != EAGAIN) return -1;
  }
  if (watches_real) look_at_real(real, count);
  int ready = 0;
  std::size_t looked_at = 0;
  for (nfds_t i = 0; i < count; ++i) {
    const bool is_ours = is_of_the_world(kind_of(interests[i].fd));
    interests[i].revents = is_ours ? answered[looked_at++].ready : real[i].revents;
    ready += interests[i].revents != 0;
  }
  return ready;
}

int sleep_until(Until until, std::int64_t* left_ns = nullptr) {
  return wait(nullptr, 0, until, nullptr, left_ns) < 0 ? -1 : 0;
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
  return wait(interests, count, after_ms(timeout_ms));
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
  return wait(interests, count, after(timeout), mask);
}

SIMBENCH_CALL int ppoll_checked(pollfd* interests, nfds_t count, const timespec* timeout,
                                const sigset_t* mask, std::size_t size) __asm__("__ppoll_chk");
int ppoll_checked(pollfd* interests, nfds_t count, const timespec* timeout, const sigset_t* mask,
                  std::size_t size) {
  if (size / sizeof *interests < count) give_up("ppoll() beyond its array");
  return ppoll(interests, count, timeout, mask);
}

SIMBENCH_CALL int pselect(int count, fd_set* readers, fd_set* writers, fd_set* exceptions,
                          const timespec* timeout, const sigset_t* mask) {
  if (!is_simulated()) {
    return SIMBENCH_REAL(pselect)(count, readers, writers, exceptions, timeout, mask);
  }
  pollfd interests[FD_SETSIZE];
  nfds_t asked = 0;
  const auto has = [](int fd, fd_set* set) { return set != nullptr && FD_ISSET(fd, set); };
  for (int fd = 0; fd < count && fd < FD_SETSIZE; ++fd) {
    const int events = (has(fd, readers) ? POLLIN : 0) | (has(fd, writers) ? POLLOUT : 0) |
                       (has(fd, exceptions) ? POLLPRI : 0);
    if (events != 0) interests[asked++] = {fd, static_cast<short>(events), 0};
  }
  if (wait(interests, asked, after(timeout), mask) < 0) return -1;
  for (fd_set* set : {readers, writers, exceptions}) {
    if (set != nullptr) FD_ZERO(set);
  }
  int ready = 0;
  const auto answer = [&ready](const pollfd& interest, short asked_for, int is, fd_set* set) {
    if ((interest.events & asked_for) == 0 || (interest.revents & is) == 0) return;
    FD_SET(interest.fd, set);
    ++ready;
  };
  for (nfds_t i = 0; i < asked; ++i) {
    answer(interests[i], POLLIN, POLLIN | POLLHUP | POLLERR, readers);
    answer(interests[i], POLLOUT, POLLOUT | POLLERR, writers);
    answer(interests[i], POLLPRI, POLLPRI, exceptions);
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

namespace {

// The descriptors that an epoll descriptor watches; few programs have more than one.
struct Watched {
  int epoll = -1;
  int fd = -1;
  epoll_event event{};
};
Watched watched[kMostInterests];

Watched* find_watched(int epoll, int fd) {
  for (Watched& each : watched) {
    if (each.epoll == epoll && each.fd == fd) return &each;
  }
  return nullptr;
}

}  // namespace

SIMBENCH_CALL int epoll_create1(int flags) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_create1)(flags);
  const int fd = open_descriptor(Kind::kEpoll, false, (flags & EPOLL_CLOEXEC) != 0);
  for (Watched& each : watched) {
    if (each.epoll == fd) each = {};  // of a descriptor of this number that was closed
  }
  return fd;
}

SIMBENCH_CALL int epoll_create(int size) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_create)(size);
  return epoll_create1(0);
}

SIMBENCH_CALL int epoll_ctl(int epoll, int operation, int fd, epoll_event* event) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_ctl)(epoll, operation, fd, event);
  Watched* found = find_watched(epoll, fd);
  if ((operation == EPOLL_CTL_ADD) == (found != nullptr)) {
    return refuse(found != nullptr ? EEXIST : ENOENT);
  }
  if (operation == EPOLL_CTL_DEL) {
    *found = {};
    return 0;
  }
  if ((event->events & (EPOLLET | EPOLLONESHOT)) != 0) {
    give_up("epoll with EPOLLET or EPOLLONESHOT");
  }
  if (found == nullptr) found = find_watched(-1, -1);
  if (found == nullptr) return refuse(ENOSPC);
  *found = {.epoll = epoll, .fd = fd, .event = *event};
  return 0;
}

SIMBENCH_CALL int epoll_pwait(int epoll, epoll_event* events, int most, int timeout_ms,
                              const sigset_t* mask) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_pwait)(epoll, events, most, timeout_ms, mask);
  pollfd interests[kMostInterests];
  nfds_t asked = 0;
  for (const Watched& each : watched) {
    if (each.epoll != epoll) continue;
    interests[asked++] = {each.fd, static_cast<short>(each.event.events), 0};
  }
  if (wait(interests, asked, after_ms(timeout_ms), mask) < 0) return -1;
  int ready = 0;
  for (nfds_t i = 0; i < asked && ready < most; ++i) {
    if (interests[i].revents == 0) continue;
    events[ready].events = static_cast<std::uint32_t>(interests[i].revents);
    events[ready++].data = find_watched(epoll, interests[i].fd)->event.data;
  }
  return ready;
}

SIMBENCH_CALL int epoll_wait(int epoll, epoll_event* events, int most, int timeout_ms) {
  if (!is_simulated()) return SIMBENCH_REAL(epoll_wait)(epoll, events, most, timeout_ms);
  return epoll_pwait(epoll, events, most, timeout_ms, nullptr);
}

namespace {

bool is_setting(const itimerspec& setting) {
  return is_time(setting.it_value) && is_time(setting.it_interval);
}

itimerspec from_setting(const TimerSetting& setting) {
  return {.it_interval = to_timespec(setting.interval), .it_value = to_timespec(setting.left)};
}

}  // namespace

int set_world_timer(const Request& request, const itimerspec& setting, itimerspec* before) {
  if (!is_setting(setting)) return refuse(EINVAL);
  const TimerSetting wanted{.left = nanoseconds(setting.it_value),
                            .interval = nanoseconds(setting.it_interval)};
  TimerSetting old{};
  if (ask_for(request, old, {&wanted, sizeof wanted}) < 0) return -1;
  if (before != nullptr) *before = from_setting(old);
  return 0;
}

int query_world_timer(const Request& request, itimerspec& setting) {
  TimerSetting now{};
  if (ask_for(request, now) < 0) return -1;
  setting = from_setting(now);
  return 0;
}

bool wait_for_input(int fd, std::int64_t timeout_ns) {
  const std::uint64_t before = handled_signals().interrupting;
  pollfd interest{.fd = fd, .events = POLLIN, .revents = 0};
  const Until until = timeout_ns < 0 ? Until{} : Until{Deadline::kAfter, timeout_ns};
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

std::int64_t read_timer(int fd, void* data, std::size_t size) {
  if (size < sizeof(std::uint64_t)) return refuse(EINVAL);
  for (;;) {
    const std::int64_t expirations = ask({.call = Call::kReadTimer, .fd = fd});
    if (expirations >= 0) {
      memcpy(data, &expirations, sizeof expirations);
      return sizeof expirations;
    }
    if (errno != EAGAIN || !is_blocking(fd) || !wait_for_input(fd, -1)) return -1;
  }
}

SIMBENCH_CALL int timerfd_create(int clock, int flags) {
  if (is_own_clock(clock)) {
    const int timer = SIMBENCH_REAL(timerfd_create)(CLOCK_MONOTONIC, flags);
    set_kind(timer, Kind::kOwnTimer);
    return timer;
  }
  if (!is_simulated()) return SIMBENCH_REAL(timerfd_create)(clock, flags);
  const int fd =
      open_descriptor(Kind::kTimer, (flags & TFD_NONBLOCK) != 0, (flags & TFD_CLOEXEC) != 0);
  if (fd >= 0 && ask({.call = Call::kOpenTimer, .fd = fd, .a = clock}) < 0) {
    discard_descriptor(fd);
    return -1;
  }
  return fd;
}

SIMBENCH_CALL int timerfd_settime(int fd, int flags, const itimerspec* setting,
                                  itimerspec* before) {
  if (kind_of(fd) == Kind::kOwnTimer && is_setting(*setting)) {
    itimerspec machine = *setting;
    const bool is_armed = setting->it_value.tv_sec != 0 || setting->it_value.tv_nsec != 0;
    const bool converts = is_armed && (flags & TFD_TIMER_ABSTIME) != 0;
    if (converts) machine.it_value = machine_time_of(setting->it_value);
    return SIMBENCH_REAL(timerfd_settime)(fd, flags & TFD_TIMER_ABSTIME, &machine, before);
  }
  if (!is_simulated()) return SIMBENCH_REAL(timerfd_settime)(fd, flags, setting, before);
  if (kind_of(fd) != Kind::kTimer) return refuse_descriptor(fd, EINVAL);
  const bool is_absolute = (flags & TFD_TIMER_ABSTIME) != 0;
  return set_world_timer({.call = Call::kSetTimer, .fd = fd, .a = is_absolute ? 1 : 0}, *setting,
                         before);
}

SIMBENCH_CALL int timerfd_gettime(int fd, itimerspec* setting) {
  if (!is_simulated()) return SIMBENCH_REAL(timerfd_gettime)(fd, setting);
  if (kind_of(fd) != Kind::kTimer) return refuse_descriptor(fd, EINVAL);
  return query_world_timer({.call = Call::kQueryTimer, .fd = fd}, *setting);
}

}  // namespace simbench::shim

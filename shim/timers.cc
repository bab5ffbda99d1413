// Timers that are descriptors: timerfd_create() and its kin. Those that make signals are in
// shim/signals.cc.
#include <errno.h>
#include <string.h>
#include <sys/timerfd.h>
#include <time.h>

#include "shim/descriptor_errors.h"
#include "shim/link.h"
#include "shim/own_clock.h"

namespace simbench::shim {

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

// The clocks: readings, settings and the kernel's adjustments.
#include <errno.h>
#include <sys/time.h>
#include <sys/timex.h>
#include <time.h>

#include "shim/card.h"
#include "shim/link.h"
#include "shim/own_clock.h"

namespace simbench::shim {
namespace {

std::int64_t set_clock(clockid_t clock, std::int64_t sec, std::int64_t ns) {
  if (ns < 0 || ns >= kSecond || sec < 0) return refuse(EINVAL);
  std::int64_t known = 0;
  if (!world_clock(clock, known)) return -1;
  return ask({.call = Call::kSetClock, .a = known, .b = sec * kSecond + ns});
}

int adjust(clockid_t clock, timex* setting) {
  std::int64_t known = 0;
  if (!world_clock(clock, known)) return -1;
  return static_cast<int>(
      ask_for({.call = Call::kAdjustClock, .a = known}, *setting, {setting, sizeof *setting}));
}

}  // namespace

SIMBENCH_CALL int clock_gettime(clockid_t clock, timespec* time) {
  if (is_own_clock(clock)) {
    *time = to_timespec(own_time());
    return 0;
  }
  if (!is_simulated()) return read_machine_clock(clock, time);
  std::int64_t known = 0;
  if (!world_clock(clock, known)) return -1;
  const int before = errno;
  errno = 0;
  const std::int64_t ns = ask({.call = Call::kReadClock, .a = known});
  if (ns == -1 && errno != 0) return -1;
  errno = before;
  *time = to_timespec(ns);
  return 0;
}

SIMBENCH_CALL int gettimeofday(timeval* time, void* zone) {
  if (!has_world()) return SIMBENCH_REAL(gettimeofday)(time, zone);
  timespec now{};
  if (clock_gettime(CLOCK_REALTIME, &now) < 0) return -1;
  *time = {.tv_sec = now.tv_sec, .tv_usec = now.tv_nsec / 1000};
  return 0;
}

SIMBENCH_CALL time_t time(time_t* result) {
  if (!has_world()) return SIMBENCH_REAL(time)(result);
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (result != nullptr) *result = now.tv_sec;
  return now.tv_sec;
}

SIMBENCH_CALL int clock_settime(clockid_t clock, const timespec* time) {
  if (!has_world()) return SIMBENCH_REAL(clock_settime)(clock, time);
  return static_cast<int>(set_clock(clock, time->tv_sec, time->tv_nsec));
}

SIMBENCH_CALL int settimeofday(const timeval* time, const struct timezone* zone) {
  if (!has_world()) return SIMBENCH_REAL(settimeofday)(time, zone);
  if (time == nullptr) return 0;  // the kernel's time zone, which moves no clock
  return static_cast<int>(set_clock(CLOCK_REALTIME, time->tv_sec, time->tv_usec * 1000));
}

SIMBENCH_CALL int clock_adjtime(clockid_t clock, timex* setting) {
  if (!has_world()) return SIMBENCH_REAL(clock_adjtime)(clock, setting);
  return adjust(clock, setting);
}

SIMBENCH_CALL int adjtimex(timex* setting) {
  if (!has_world()) return SIMBENCH_REAL(adjtimex)(setting);
  return adjust(CLOCK_REALTIME, setting);
}

SIMBENCH_CALL int ntp_adjtime(timex* setting) {
  if (!has_world()) return SIMBENCH_REAL(ntp_adjtime)(setting);
  return adjust(CLOCK_REALTIME, setting);
}

// What programs that are compiled today call for ntp_gettime().
SIMBENCH_CALL int ntp_gettimex(ntptimeval* result) {
  if (!has_world()) return real(&::ntp_gettime, "ntp_gettimex")(result);
  timex now{};
  const int state = adjust(CLOCK_REALTIME, &now);
  if (state < 0) return -1;
  *result = {};
  result->time = now.time;
  result->maxerror = now.maxerror;
  result->esterror = now.esterror;
  result->tai = now.tai;
  return state;
}

// Older programs call this one. The header gives ntp_gettime() the name above.
SIMBENCH_CALL int ntp_gettime_by_its_name(ntptimeval* result) __asm__("ntp_gettime");
int ntp_gettime_by_its_name(ntptimeval* result) { return ntp_gettimex(result); }

SIMBENCH_CALL int adjtime(const timeval* offset, timeval* left) {
  if (!has_world()) return SIMBENCH_REAL(adjtime)(offset, left);
  timex slew{};
  slew.modes = offset != nullptr ? ADJ_OFFSET_SINGLESHOT : ADJ_OFFSET_SS_READ;
  if (offset != nullptr) slew.offset = offset->tv_sec * 1'000'000 + offset->tv_usec;
  if (adjust(CLOCK_REALTIME, &slew) < 0) return -1;
  if (left != nullptr) {
    *left = {.tv_sec = slew.offset / 1'000'000, .tv_usec = slew.offset % 1'000'000};
  }
  return 0;
}

}  // namespace simbench::shim

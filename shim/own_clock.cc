#include "shim/own_clock.h"

#include <dlfcn.h>
#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>

#include "shim/clock_page.h"
#include "shim/link.h"

namespace simbench::shim {
namespace {

const ClockPage* page = nullptr;
decltype(&clock_gettime) machine_clock = nullptr;

std::int64_t machine_time(clockid_t clock) {
  timespec now{};
  machine_clock(clock, &now);
  return nanoseconds(now);
}

// CLOCK_REALTIME minus CLOCK_MONOTONIC, of the closest of some readings.
std::int64_t machine_offset() {
  constexpr int kTries = 4;
  std::int64_t closest = INT64_MAX;
  std::int64_t offset = 0;
  for (int i = 0; i < kTries; ++i) {
    const std::int64_t before = machine_time(CLOCK_MONOTONIC);
    const std::int64_t real = machine_time(CLOCK_REALTIME);
    const std::int64_t took = machine_time(CLOCK_MONOTONIC) - before;
    if (took >= closest) continue;
    closest = took;
    offset = real - (before + took / 2);
  }
  return offset;
}

// A stamp of zero is none.
void convert(timespec& stamp) {
  if (stamp.tv_sec == 0 && stamp.tv_nsec == 0) return;
  stamp = to_timespec(own_time_at(stamp));
}

void convert(timeval& stamp) {
  timespec exact{.tv_sec = stamp.tv_sec, .tv_nsec = stamp.tv_usec * 1000};
  convert(exact);
  stamp = {.tv_sec = exact.tv_sec, .tv_usec = exact.tv_nsec / 1000};
}

// The first one in the data: of SCM_TIMESTAMPING's three, the one by software.
template <class Stamp>
void convert_at(void* data) {
  Stamp stamp{};
  memcpy(&stamp, data, sizeof stamp);
  convert(stamp);
  memcpy(data, &stamp, sizeof stamp);
}

}  // namespace

void open_own_clock() {
  machine_clock = reinterpret_cast<decltype(machine_clock)>(dlsym(RTLD_NEXT, "clock_gettime"));
  void* mapped = mmap(nullptr, sizeof(ClockPage), PROT_READ, MAP_SHARED, kClockPage, 0);
  if (machine_clock == nullptr || mapped == MAP_FAILED) give_up("the host's clock cannot be read");
  page = static_cast<const ClockPage*>(mapped);
}

bool is_own_clock(clockid_t clock) {
  return page != nullptr && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE ||
                             clock == CLOCK_REALTIME_ALARM || clock == CLOCK_TAI);
}

std::int64_t own_time() { return reading_at(*page, machine_time(CLOCK_MONOTONIC)); }

std::int64_t own_time_at(const timespec& machine) {
  return reading_at(*page, nanoseconds(machine) - machine_offset());
}

int read_machine_clock(clockid_t clock, timespec* time) {
  if (machine_clock != nullptr) return machine_clock(clock, time);
  return SIMBENCH_REAL(clock_gettime)(clock, time);
}

int sleep_until_own_time(std::int64_t reading) {
  // It may be set meanwhile, so no part of the wait is long.
  constexpr std::int64_t kLongest = 100'000'000;
  for (;;) {
    const std::int64_t left = reading - own_time();
    if (left <= 0) return 0;
    const timespec part = to_timespec(left < kLongest ? left : kLongest);
    if (nanosleep(&part, nullptr) < 0) return errno;
  }
}

timespec machine_time_of(const timespec& reading) {
  const std::int64_t left = nanoseconds(reading) - own_time();
  // A timer that is set to 0 would be disarmed.
  const std::int64_t at = machine_time(CLOCK_MONOTONIC) + left;
  return to_timespec(at > 1 ? at : 1);
}

void convert_stamps(msghdr& message) {
  if (page == nullptr || message.msg_controllen == 0) return;
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr;
       head = CMSG_NXTHDR(&message, head)) {
    if (head->cmsg_level != SOL_SOCKET) continue;
    switch (head->cmsg_type) {
      case SO_TIMESTAMP_OLD:
      case SO_TIMESTAMP_NEW:
        convert_at<timeval>(CMSG_DATA(head));
        break;
      case SO_TIMESTAMPNS_OLD:
      case SO_TIMESTAMPNS_NEW:
      case SO_TIMESTAMPING_OLD:
      case SO_TIMESTAMPING_NEW:
        convert_at<timespec>(CMSG_DATA(head));
        break;
      default:
        break;
    }
  }
}

}  // namespace simbench::shim

#include "hardware/clock/os_clock_calls.h"

#include <cerrno>
#include <ctime>

#include "hardware/clock/software_clock.h"

namespace simbench::hardware {
namespace {

class KernelClockCalls final : public ClockCalls {
 public:
  MonotonicTime monotonic() override { return monotonic_now(); }
  HostTime system() override { return read_system_clock(); }
  int set_system(HostTime value) override {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(value.time_since_epoch());
    timespec time{};
    time.tv_sec = static_cast<std::time_t>(seconds.count());
    time.tv_nsec = static_cast<long>((value.time_since_epoch() - seconds).count());
    return clock_settime(CLOCK_REALTIME, &time) == 0 ? 0 : errno;
  }
  int adjust(timex& request) override {
    return clock_adjtime(CLOCK_REALTIME, &request) >= 0 ? 0 : errno;
  }
};

}  // namespace

ClockCalls& kernel_clock_calls() {
  static KernelClockCalls calls;
  return calls;
}

}  // namespace simbench::hardware

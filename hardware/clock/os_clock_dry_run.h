// What an OsClock would do, without doing it: all is checked against the same limits and told, and
// the node goes by a software clock.
//
//   DryRunClock clock(context, kernel_clock_calls(), {.dry_run = true, .log = log_line});
#ifndef SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_DRY_RUN_H_
#define SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_DRY_RUN_H_

#include <utility>

#include "hardware/clock/os_clock.h"
#include "hardware/clock/software_clock.h"

namespace simbench::hardware {

class DryRunClock final : public NodeClock {
 public:
  DryRunClock(boost::asio::io_context& context, ClockCalls& calls, OsClockSettings settings);

  Task<HostTime> now() override { return clock_.now(); }
  Task<void> set(HostTime value) override;
  Task<void> adjust_frequency(double ppb) override;
  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override;

  const NodeOscillator& oscillator() const override { return clock_.oscillator(); }
  HostTime system_at(MonotonicTime at) const override { return clock_.system_at(at); }
  MonotonicTime when(HostTime at, MonotonicTime now) const override { return clock_.when(at, now); }
  ClockAdjustment present(MonotonicTime now) const override { return clock_.present(now); }
  void observe(Observer observer) override { clock_.observe(std::move(observer)); }
  // As of the operating system's clock: nothing, what would have been set stays.
  void restart() override {}

 private:
  OsClockSettings options_;
  OsClockLimits limits_;
  double frequency_ppb_ = 0;
  SoftwareClock clock_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_DRY_RUN_H_

#include "hardware/clock/os_clock_dry_run.h"

#include <fmt/format.h>

namespace simbench::hardware {

DryRunClock::DryRunClock(boost::asio::io_context& context, ClockCalls& calls,
                         OsClockSettings settings)
    : options_(std::move(settings)),
      limits_(options_.max_step, read_kernel_clock(calls).freq),
      clock_(context,
             {.host = options_.host, .oscillator = {}, .offset = {}, .system_clock = [&calls] {
                return calls.system();
              }}) {
  if (!options_.log) options_.log = [](const std::string&) {};
  if (const std::string line = other_keeper(read_kernel_clock(calls)); !line.empty()) {
    options_.log(line);
  }
}

Task<void> DryRunClock::set(HostTime value) {
  const Nanoseconds step = limits_.check_step(clock_.system_at(monotonic_now()), value);
  options_.log(fmt::format("dry run: would step the system clock by {:+.6f} s", to_seconds(step)));
  co_await clock_.set(value);
}

Task<void> DryRunClock::adjust_frequency(double ppb) {
  limits_.kernel_frequency(ppb);
  options_.log(fmt::format("dry run: would run the system clock at {:+.3f} ppm", ppb * 1e-3));
  frequency_ppb_ = ppb;
  co_await clock_.adjust_frequency(ppb);
}

Task<void> DryRunClock::slew(Nanoseconds offset, double max_rate_ppb) {
  double rate_ppb = 0;
  if (offset.count() != 0) {
    rate_ppb = limits_.slew_rate_ppb(offset, max_rate_ppb, frequency_ppb_);
    options_.log(fmt::format("dry run: would slew the system clock by {:+.6f} s at {:.3f} ppm",
                             to_seconds(offset), rate_ppb * 1e-3));
  }
  co_await clock_.slew(offset, rate_ppb);
}

}  // namespace simbench::hardware

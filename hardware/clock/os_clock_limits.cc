#include "hardware/clock/os_clock_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace simbench::hardware {
namespace {

constexpr double kMaxPpm = 500;
constexpr double kUnitsPerPpm = 65536;

double fraction(long kernel_frequency) {
  return static_cast<double>(kernel_frequency) / kUnitsPerPpm * 1e-6;
}

}  // namespace

Nanoseconds OsClockLimits::check_step(HostTime from, HostTime to) const {
  // As a number that cannot overflow, whatever somebody wants the clock set to.
  const double step_s =
      (static_cast<double>(nanoseconds_of(to)) - static_cast<double>(nanoseconds_of(from))) * 1e-9;
  constexpr double kCenturies = 9e9;
  if (std::abs(step_s) < kCenturies) {
    const Nanoseconds step = to - from;
    if (step <= max_step_ && step >= -max_step_) return step;
  }
  throw ClockError(
      fmt::format("system clock: found a step of {:+.6f} s, allowed at most {:.6f} s "
                  "(--max-step-ms); set the clock roughly by hand, or allow more",
                  step_s, to_seconds(max_step_)));
}

long OsClockLimits::kernel_frequency(double ppb) const {
  const double original = fraction(original_frequency_);
  const double ppm = (original + ppb * 1e-9 * (1 + original)) * 1e6;
  if (std::isfinite(ppm) && std::abs(ppm) <= kMaxPpm) return std::lround(ppm * kUnitsPerPpm);
  throw ClockError(fmt::format(
      "system clock: found a rate of {:+.3f} ppm, allowed {:+.3f} to {:+.3f} ppm: the kernel has "
      "{:.0f} ppm in either direction, and was found at {:+.3f} ppm",
      ppb * 1e-3, -kMaxPpm - original * 1e6, kMaxPpm - original * 1e6, kMaxPpm, original * 1e6));
}

double OsClockLimits::rate_ppb(long kernel_frequency) const {
  const double original = fraction(original_frequency_);
  return (fraction(kernel_frequency) - original) / (1 + original) * 1e9;
}

double OsClockLimits::slew_rate_ppb(Nanoseconds offset, double max_rate_ppb,
                                    double frequency_ppb) const {
  if (!(max_rate_ppb > 0)) {
    throw ClockError(
        fmt::format("system clock: found a slew at {} ppb, allowed a rate above 0", max_rate_ppb));
  }
  const double sign = offset.count() < 0 ? -1 : 1;
  const double furthest_ppb = rate_ppb(static_cast<long>(sign * kMaxPpm * kUnitsPerPpm));
  const double left_ppb = sign * (furthest_ppb - frequency_ppb);
  constexpr double kLeast = 1;  // ppb
  if (left_ppb < kLeast) {
    throw ClockError(fmt::format(
        "system clock: found a slew of {:+.6f} s at a rate of {:+.3f} ppm, which leaves "
        "nothing of the kernel's {:.0f} ppm to slew with",
        to_seconds(offset), frequency_ppb * 1e-3, kMaxPpm));
  }
  return std::min(max_rate_ppb, left_ppb);
}

timex read_kernel_clock(ClockCalls& calls) {
  timex kernel{};
  if (const int error = calls.adjust(kernel); error != 0) {
    throw ClockError(
        fmt::format("system clock: its state cannot be read: {}", std::strerror(error)));
  }
  return kernel;
}

std::string other_keeper(const timex& kernel) {
  const bool has_loop = (kernel.status & (STA_PLL | STA_FLL | STA_PPSFREQ | STA_PPSTIME)) != 0;
  const bool is_synchronised = (kernel.status & STA_UNSYNC) == 0;
  if (!has_loop && !is_synchronised) return "";
  return fmt::format(
      "system clock: another program seems to keep it ({}); two keepers fight: stop that one while "
      "the rig runs (systemctl stop systemd-timesyncd chronyd ntpd)",
      has_loop ? "the kernel's own control loop is on" : "it is marked as synchronised");
}

}  // namespace simbench::hardware

#include "hardware/clock/os_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

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

constexpr double kMaxPpm = 500;
constexpr double kUnitsPerPpm = 65536;

double fraction(long kernel_frequency) {
  return static_cast<double>(kernel_frequency) / kUnitsPerPpm * 1e-6;
}

}  // namespace

ClockCalls& kernel_clock_calls() {
  static KernelClockCalls calls;
  return calls;
}

Nanoseconds OsClockLimits::check_step(HostTime from, HostTime to) const {
  // As a floating-point number, which cannot overflow.
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

double OsClockLimits::max_frequency_ppb() const {
  const long furthest = static_cast<long>(kMaxPpm * kUnitsPerPpm);
  return std::min(rate_ppb(furthest), -rate_ppb(-furthest));
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

namespace {

constexpr const char* kStopOtherKeeper =
    "two keepers fight: stop that one while the rig runs (systemctl stop systemd-timesyncd chronyd "
    "ntpd)";

}  // namespace

std::string other_keeper(const timex& kernel) {
  const bool has_loop = (kernel.status & (STA_PLL | STA_FLL | STA_PPSFREQ | STA_PPSTIME)) != 0;
  const bool is_synchronised = (kernel.status & STA_UNSYNC) == 0;
  if (!has_loop && !is_synchronised) return "";
  return fmt::format(
      "system clock: another program seems to keep it ({}); {}",
      has_loop ? "the kernel's own control loop is on" : "it is marked as synchronised",
      kStopOtherKeeper);
}

namespace {

// Two measured distances between the clocks that differ by less are the same.
constexpr Nanoseconds kSame = std::chrono::microseconds(20);

[[noreturn]] void fail_to_adjust(const char* what, int error) {
  if (error != EPERM) {
    throw ClockError(fmt::format("system clock: {}: {}", what, std::strerror(error)));
  }
  throw ClockError(fmt::format(
      "system clock: {}: not permitted; --set-system-clock needs CAP_SYS_TIME: "
      "AmbientCapabilities=CAP_SYS_TIME in the systemd unit, or setcap cap_sys_time+ep on the "
      "program",
      what));
}

// Gives the options a log if they have none, and logs a program that already keeps the clock.
void log_other_keeper(OsClockSettings& options, ClockCalls& calls) {
  if (!options.log) options.log = [](const std::string&) {};
  if (const std::string line = other_keeper(read_kernel_clock(calls)); !line.empty()) {
    options.log(line);
  }
}

// A dry run: checks all calls against the limits of an OsClock and logs them; the node runs on this
// software clock.
class DryRunClock final : public SoftwareClock {
 public:
  DryRunClock(boost::asio::io_context& context, ClockCalls& calls, OsClockSettings settings)
      : SoftwareClock(context, {.host = settings.host,
                                .oscillator = {},
                                .offset = {},
                                .system_clock = [&calls] { return calls.system(); }}),
        options_(std::move(settings)),
        limits_(options_.max_step, read_kernel_clock(calls).freq) {
    log_other_keeper(options_, calls);
  }

  Task<void> set(HostTime value) override {
    const Nanoseconds step = limits_.check_step(system_at(monotonic_now()), value);
    options_.log(
        fmt::format("dry run: would step the system clock by {:+.6f} s", to_seconds(step)));
    co_await SoftwareClock::set(value);
  }

  Task<void> adjust_frequency(double ppb) override {
    limits_.kernel_frequency(ppb);
    options_.log(fmt::format("dry run: would run the system clock at {:+.3f} ppm", ppb * 1e-3));
    frequency_ppb_ = ppb;
    co_await SoftwareClock::adjust_frequency(ppb);
  }
  double max_frequency_ppb() const override { return limits_.max_frequency_ppb(); }

  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override {
    double rate_ppb = 0;
    if (offset.count() != 0) {
      rate_ppb = limits_.slew_rate_ppb(offset, max_rate_ppb, frequency_ppb_);
      options_.log(fmt::format("dry run: would slew the system clock by {:+.6f} s at {:.3f} ppm",
                               to_seconds(offset), rate_ppb * 1e-3));
    }
    co_await SoftwareClock::slew(offset, rate_ppb);
  }

  // Does nothing, as for the operating system's clock.
  void restart() override {}

 private:
  OsClockSettings options_;
  OsClockLimits limits_;
  double frequency_ppb_ = 0;
};

}  // namespace

std::unique_ptr<NodeClock> make_os_clock(boost::asio::io_context& context, ClockCalls& calls,
                                         OsClockSettings settings) {
  if (settings.dry_run) return std::make_unique<DryRunClock>(context, calls, std::move(settings));
  return std::make_unique<OsClock>(context, calls, std::move(settings));
}

OsClock::OsClock(boost::asio::io_context& context, ClockCalls& calls, OsClockSettings settings)
    : calls_(calls),
      options_(std::move(settings)),
      limits_(options_.max_step, read_kernel_clock(calls).freq),
      kernel_frequency_(limits_.original_frequency()),
      slew_timer_(context) {
  log_other_keeper(options_, calls);
  // Changes nothing, and shows at once whether it is permitted.
  set_kernel_frequency(kernel_frequency_);
  const MonotonicTime now = calls_.monotonic();
  settings_.push_back({.since = now, .ahead = measured_ahead(), .oscillator = {}, .rate_ppb = 0});
}

OsClock::~OsClock() {
  if (kernel_frequency_ == limits_.original_frequency()) return;
  timex request{};
  request.modes = ADJ_FREQUENCY;
  request.freq = limits_.original_frequency();
  calls_.adjust(request);
}

Task<HostTime> OsClock::now() { co_return calls_.system(); }

Task<void> OsClock::set(HostTime value) {
  look_for_others();
  const Nanoseconds step = limits_.check_step(system_at(calls_.monotonic()), value);
  if (const int error = calls_.set_system(value); error != 0)
    fail_to_adjust("cannot be set", error);
  options_.log(fmt::format("system clock: stepped by {:+.6f} s", to_seconds(step)));
  run(frequency_ppb_, 0, 0, measured_ahead());
  co_return;
}

Task<void> OsClock::adjust_frequency(double ppb) {
  look_for_others();
  run(ppb, slew_left_ns(), max_slew_ppb_, settings_.back().ahead);
  co_return;
}

Task<void> OsClock::slew(Nanoseconds offset, double max_rate_ppb) {
  look_for_others();
  run(frequency_ppb_, static_cast<double>(offset.count()), max_rate_ppb, settings_.back().ahead);
  co_return;
}

const OsClock::Setting& OsClock::setting_at(MonotonicTime at) const {
  const auto later =
      std::upper_bound(settings_.begin(), settings_.end(), at,
                       [](MonotonicTime t, const Setting& setting) { return t < setting.since; });
  return later == settings_.begin() ? settings_.front() : *std::prev(later);
}

SteadyTime OsClock::steady_at(MonotonicTime at) const {
  return setting_at(at).oscillator.steady(at);
}

HostTime OsClock::system_at(MonotonicTime at) const {
  return HostTime(at.time_since_epoch() + setting_at(at).ahead);
}

MonotonicTime OsClock::when(HostTime at, MonotonicTime now) const {
  const Nanoseconds ahead = settings_.back().ahead;
  constexpr double kFar = 9.2e18;  // what 64 bits hold
  const double about_ns =
      static_cast<double>(nanoseconds_of(at)) - static_cast<double>(ahead.count());
  if (about_ns > kFar) return MonotonicTime::max();
  if (about_ns < -kFar) return now;
  return std::max(now, MonotonicTime(at.time_since_epoch() - ahead));
}

ClockAdjustment OsClock::present(MonotonicTime now) const {
  const HostTime reads = system_at(now);
  return {.host = options_.host,
          .at = steady_at(now),
          .before = reads,
          .after = reads,
          .rate_ppb = setting_at(now).rate_ppb};
}

void OsClock::observe(Observer observer) {
  observer_ = std::move(observer);
  if (!observer_ && slew_rate_ppb_ != 0) end_slew();
}

void OsClock::end_slew() {
  try {
    run(frequency_ppb_, 0, 0, settings_.back().ahead);
  } catch (const ClockError& refused) {
    options_.log(refused.what());
  }
}

Nanoseconds OsClock::measured_ahead() const {
  const PairedReading reading =
      paired_reading([this] { return calls_.system(); }, [this] { return calls_.monotonic(); });
  return offset_between(reading.reads, reading.at);
}

double OsClock::slew_left_ns() const {
  if (slew_rate_ppb_ == 0) return 0;
  const auto counted_ns =
      static_cast<double>((steady_at(calls_.monotonic()) - slew_since_).count());
  const double left_ns = slew_ns_ - slew_rate_ppb_ * 1e-9 * counted_ns;
  return std::signbit(left_ns) == std::signbit(slew_ns_) ? left_ns : 0;
}

void OsClock::run(double frequency_ppb, double slew_ns, double max_slew_ppb, Nanoseconds ahead) {
  double slew_ppb = 0;
  if (std::abs(slew_ns) >= 0.5) {
    const Nanoseconds offset(static_cast<std::int64_t>(std::llround(slew_ns)));
    slew_ppb = std::copysign(limits_.slew_rate_ppb(offset, max_slew_ppb, frequency_ppb), slew_ns);
  }
  set_kernel_frequency(limits_.kernel_frequency(frequency_ppb + slew_ppb));
  frequency_ppb_ = frequency_ppb;
  slew_rate_ppb_ = slew_ppb;
  max_slew_ppb_ = max_slew_ppb;
  slew_ns_ = slew_ns;
  begin(ahead);
  slew_since_ = settings_.back().oscillator.steady_zero;
  end_slew_in_time();
}

void OsClock::end_slew_in_time() {
  slew_timer_.cancel();
  if (slew_rate_ppb_ == 0) return;
  constexpr double kNever = 2e18;
  const double counted_ns = std::min(kNever, slew_ns_ / slew_rate_ppb_ * 1e9);
  slew_end_ = slew_since_ + Nanoseconds(std::llround(counted_ns));
  slew_timer_.expires_at(for_timer(oscillator().when(slew_end_)));
  slew_timer_.async_wait([this, end = slew_end_](const boost::system::error_code& error) {
    // The timer of an earlier slew may have been too late to be stopped.
    if (!error && slew_rate_ppb_ != 0 && end == slew_end_) end_slew();
  });
}

void OsClock::set_kernel_frequency(long frequency) {
  timex request{};
  request.modes = ADJ_FREQUENCY;
  request.freq = frequency;
  if (const int error = calls_.adjust(request); error != 0)
    fail_to_adjust("its rate cannot be set", error);
  kernel_frequency_ = frequency;
}

void OsClock::begin(Nanoseconds ahead) {
  const MonotonicTime now = calls_.monotonic();
  const HostTime before = system_at(now);
  const SteadyTime steady = steady_at(now);
  const double rate_ppb = limits_.rate_ppb(kernel_frequency_);
  const double skew_ppm = (1 / (1 + rate_ppb * 1e-9) - 1) * 1e6;
  settings_.push_back(
      {.since = now, .ahead = ahead, .oscillator = {now, steady, skew_ppm}, .rate_ppb = rate_ppb});
  if (settings_.size() > kHistory + 1) settings_.pop_front();
  if (!observer_) return;
  observer_({.host = options_.host,
             .at = steady,
             .before = before,
             .after = system_at(now),
             .rate_ppb = rate_ppb});
}

void OsClock::look_for_others() {
  if (read_kernel_clock(calls_).freq != kernel_frequency_ && !std::exchange(logged_others_, true)) {
    options_.log(
        fmt::format("system clock: another program has changed its rate; {}", kStopOtherKeeper));
  }
  const Nanoseconds ahead = measured_ahead();
  const Nanoseconds moved = ahead - settings_.back().ahead;
  if (moved < kSame && moved > -kSame) return;
  options_.log(
      fmt::format("system clock: another program has stepped it by {:+.6f} s", to_seconds(moved)));
  begin(ahead);
}

}  // namespace simbench::hardware

#include "algorithms/host_sync/clock_steering.h"

#include <algorithm>
#include <cmath>

#include "algorithms/parameters.h"

namespace simbench {
namespace {

// A frequency this near to the wanted one is left alone.
constexpr double kIgnoredRate = 1e-11;

}  // namespace

double SteeredClock::Prediction::gained_ns(SteadyTime when) const {
  const double since_ns = to_ns(when - since);
  const double slewed_ns =
      std::min(std::abs(slew_ns), std::abs(slew_rate * std::max(since_ns, 0.0)));
  return part_ns + rate * since_ns + std::copysign(slewed_ns, slew_ns);
}

HostTime SteeredClock::predicted(SteadyTime when) const {
  const auto gained = static_cast<std::int64_t>(std::floor(prediction_.gained_ns(when)));
  return prediction_.value + (when - prediction_.since) + Nanoseconds(gained);
}

HostTime SteeredClock::at(SteadyTime when) const { return predicted(when) + highest(); }

SteadyTime SteeredClock::when(HostTime reading) const {
  SteadyTime guess = prediction_.since + (reading - prediction_.value);
  // Each pass multiplies the error by the rate, which is far below 1e-2.
  for (int pass = 0; pass < 4; ++pass) guess += reading - at(guess);
  return guess;
}

void SteeredClock::forget() {
  is_known_ = false;
  highest_ = highest_before_ = Nanoseconds(0);
}

Nanoseconds SteeredClock::largest_plausible_fall() const {
  return readings_ < kFirstReadings ? kLargestGranularity : 2 * largest_fall_ + kSmallestFall;
}

void SteeredClock::observe(HostTime reading, SteadyTime at) {
  const Nanoseconds above = reading - predicted(at);
  const Nanoseconds fall = highest() - above;
  if (is_known_ && fall > largest_plausible_fall()) forget();
  if (!is_known_) {
    prediction_.value += above;
    is_known_ = true;
    period_begin_ = at;
    return;
  }
  ++readings_;
  largest_fall_ = std::max(largest_fall_, fall);
  if (at - period_begin_ >= kMemory) {
    highest_before_ = highest_;
    highest_ = above;
    period_begin_ = at;
  }
  highest_ = std::max(highest_, above);
}

Task<void> SteeredClock::look() {
  const HostTime reading = co_await host_.clock().now();
  observe(reading, host_.steady_clock().now());
}

void SteeredClock::go_on_from(SteadyTime when) {
  const double gained_ns = prediction_.gained_ns(when);
  const double whole_ns = std::floor(gained_ns);
  prediction_.value +=
      (when - prediction_.since) + Nanoseconds(static_cast<std::int64_t>(whole_ns));
  prediction_.part_ns = gained_ns - whole_ns;
  const double slewed_ns = std::abs(prediction_.slew_rate) * to_ns(when - prediction_.since);
  const double left_ns = std::max(0.0, std::abs(prediction_.slew_ns) - slewed_ns);
  prediction_.slew_ns = std::copysign(left_ns, prediction_.slew_ns);
  prediction_.since = when;
}

Nanoseconds SteeredClock::lead_over(const ClockLine& line) const {
  const SteadyTime now = host_.steady_clock().now();
  return at(now) - line.read(now);
}

Task<void> SteeredClock::steer(ClockLine line) {
  if (!is_known_) co_await look();
  const Nanoseconds lead = lead_over(line);
  if (lead > settings_.step_threshold || -lead > settings_.step_threshold) {
    co_await step_to(line);
  }
  const double rate = line.rate_ppb * 1e-9;
  if (std::abs(rate - prediction_.rate) > kIgnoredRate) {
    const SteadyTime before = host_.steady_clock().now();
    co_await host_.clock().adjust_frequency(line.rate_ppb);
    go_on_from(before + (host_.steady_clock().now() - before) / 2);
    prediction_.rate = rate;
  }
  const Nanoseconds rest = -lead_over(line);
  if (rest <= kIgnored && rest >= -kIgnored) co_return;
  const double needed_ppb = std::abs(to_ns(rest)) / to_ns(settings_.settle) * 1e9;
  const double slew_ppb = std::min(settings_.max_slew_ppm * 1e3, needed_ppb);
  const SteadyTime before = host_.steady_clock().now();
  co_await host_.clock().slew(rest, slew_ppb);
  go_on_from(before + (host_.steady_clock().now() - before) / 2);
  prediction_.slew_ns = to_ns(rest);
  prediction_.slew_rate = std::copysign(slew_ppb * 1e-9, to_ns(rest));
}

Task<void> SteeredClock::step_to(ClockLine line) {
  const SteadyTime begin = host_.steady_clock().now();
  co_await host_.clock().set(line.read(begin + set_delay_));
  const SteadyTime end = host_.steady_clock().now();
  set_delay_ = (end - begin) / 2;
  prediction_.slew_ns = 0;
  prediction_.slew_rate = 0;
  prediction_.part_ns = 0;
  prediction_.value = line.read(end);
  prediction_.since = end;
  forget();
  co_await look();
}

void SteeringSettings::bind(ParameterBinder& parameters) {
  parameters.number("step_threshold_ms", step_threshold, 0, 1e9,
                    "the clock is stepped if it is further off than this, else slewed",
                    "assumption: what takes 10 s to slew at 500 ppm");
  parameters.number("max_slew_ppm", max_slew_ppm, 1, 1e5, "fastest slew",
                    "adjtime(3) on Linux: 500 ppm");
  parameters.number("steer_interval_ms", settle, 1, 1e7,
                    "time between two corrections of the clock, each slewed within that time",
                    "assumption: short against the wander, long against a call");
}

}  // namespace simbench

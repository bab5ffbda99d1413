#include "sim/clock/temperature.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

#include "algorithms/ports/time.h"
#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

double drawn_phase(std::uint64_t run_seed, std::string_view component, const char* part) {
  return RandomStream(run_seed, std::string(component).append(part)).uniform();
}

// A lagged square wave of amplitude 1 in its steady state: 1 - c exp(-s / lag) in the first half of
// the period, the negative of that in the second. It is continuous, hence c.
class LaggedSquare {
 public:
  LaggedSquare(double period_s, double lag_s)
      : half_s_(period_s / 2),
        lag_s_(lag_s),
        c_(lag_s == 0 ? 0 : 2 / (1 + std::exp(-half_s_ / lag_s))) {}

  double value(double s) const { return s < half_s_ ? of_half(s) : -of_half(s - half_s_); }
  double integral(double s) const {
    return s < half_s_ ? integral_of_half(s)
                       : integral_of_half(half_s_) - integral_of_half(s - half_s_);
  }

 private:
  double of_half(double s) const { return lag_s_ == 0 ? 1 : 1 - c_ * std::exp(-s / lag_s_); }
  double integral_of_half(double s) const {
    return lag_s_ == 0 ? s : s + c_ * lag_s_ * std::expm1(-s / lag_s_);
  }

  double half_s_;
  double lag_s_;
  double c_;
};

// A triangle of amplitude 1: from -1 up to 1 in the first half of the period, and down again.
double triangle(double s, double period_s) {
  const double half_s = period_s / 2;
  return s < half_s ? 2 * s / half_s - 1 : 3 - 2 * s / half_s;
}

double integral_of_triangle(double s, double period_s) {
  const double half_s = period_s / 2;
  const double part_s = s < half_s ? s : s - half_s;
  const double rising = part_s * (part_s / half_s - 1);
  return s < half_s ? rising : -rising;
}

}  // namespace

Cycle::Cycle(double period_s, double phase)
    : period_ns_(std::max<std::int64_t>(2, from_seconds(period_s).count())),
      phase_ns_(static_cast<std::int64_t>(phase * static_cast<double>(period_ns_))) {}

double Cycle::seconds_at(TrueTime t) const {
  const std::int64_t since_ns = t.time_since_epoch().count();
  const std::int64_t within_ns = since_ns - floor_div(since_ns, period_ns_) * period_ns_;
  // Both are below the period.
  const std::int64_t sum_ns = within_ns + phase_ns_;
  return static_cast<double>(sum_ns < period_ns_ ? sum_ns : sum_ns - period_ns_) * 1e-9;
}

TemperatureCourse::TemperatureCourse(const scenarios::Temperature& parameters,
                                     std::uint64_t run_seed, std::string_view component)
    : day_k_(parameters.day_amplitude_k),
      load_k_(parameters.load_amplitude_k),
      fan_k_(parameters.fan_amplitude_k),
      lag_s_(parameters.load_time_constant_s),
      day_(parameters.day_period_h * to_seconds(std::chrono::hours(1)),
           drawn_phase(run_seed, component, ": day")),
      load_(parameters.load_period_s, drawn_phase(run_seed, component, ": load")),
      fan_(parameters.fan_period_s, drawn_phase(run_seed, component, ": fan")),
      at_zero_ks_(since_begin_ks(TrueTime{})) {}

double TemperatureCourse::kelvin(TrueTime t) const {
  const double turns = day_.seconds_at(t) / day_.period_s();
  return day_k_ * std::sin(2 * std::numbers::pi * turns) +
         load_k_ * LaggedSquare(load_.period_s(), lag_s_).value(load_.seconds_at(t)) +
         fan_k_ * triangle(fan_.seconds_at(t), fan_.period_s());
}

double TemperatureCourse::since_begin_ks(TrueTime t) const {
  double ks = 0;
  if (day_k_ != 0) {
    const double half_turns = day_.seconds_at(t) / day_.period_s() * std::numbers::pi;
    // 1 - cos(2 x) = 2 sin(x)^2, which does not cancel.
    ks += day_k_ * day_.period_s() / std::numbers::pi * std::sin(half_turns) * std::sin(half_turns);
  }
  if (load_k_ != 0) {
    ks += load_k_ * LaggedSquare(load_.period_s(), lag_s_).integral(load_.seconds_at(t));
  }
  if (fan_k_ != 0) {
    ks += fan_k_ * integral_of_triangle(fan_.seconds_at(t), fan_.period_s());
  }
  return ks;
}

}  // namespace simbench::sim

#include "sim/clock/oscillator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "algorithms/ports/assert.h"
#include "algorithms/ports/time.h"
#include "scenarios/frequency_limit.h"

namespace simbench::sim {
namespace {

constexpr double kShortestTimeConstantS = 0.01;
constexpr double kSpacing = 4.0;
constexpr double kCoarsestStepMs = 100.0;

}  // namespace

FlickerNoise::FlickerNoise(double floor_ppb, double step_ms, std::uint64_t run_seed,
                           std::string_view component, std::size_t kept_blocks)
    : steps_(run_seed, ComponentKey(std::string(component) + ": flicker")) {
  const std::int64_t step_ns = from_ms(std::min(step_ms, kCoarsestStepMs)).count();
  const double step_s = static_cast<double>(step_ns) * 1e-9;
  const double variance = floor_ppb * floor_ppb;
  double time_constant_s = kShortestTimeConstantS;
  double phase_variance = 0;
  for (Transition& transition : transitions_) {
    const double half = step_s / (2 * time_constant_s);
    const double tanh_half = std::tanh(half);
    transition.kept = std::exp(-2 * half);
    transition.sigma_ppb = std::sqrt(-variance * std::expm1(-4 * half));
    transition.weight_s = time_constant_s * tanh_half;
    // The variance of the integral between two known ends is negative by rounding alone.
    phase_variance +=
        variance * std::max(0.0, 4 * time_constant_s * time_constant_s * (half - tanh_half));
    time_constant_s *= kSpacing;
  }
  phase_sigma_ns_ = std::sqrt(phase_variance);

  RandomStream draw(run_seed, std::string(component) + ": flicker at zero");
  Frequencies at_zero{};
  for (double& frequency : at_zero) frequency = draw.normal(floor_ppb);
  walk_ = GridWalk<Frequencies>(step_ns, at_zero, kept_blocks);
}

double FlickerNoise::phase_ns(std::int64_t since_zero_ns) const {
  return walk_.phase_ns(since_zero_ns,
                        [this](Frequencies& frequencies, std::int64_t index, double sign) {
                          return step(frequencies, index, sign);
                        });
}

// The processes are reversible in time, so a step is the same forwards and backwards.
double FlickerNoise::step(Frequencies& frequencies, std::int64_t index, double /*sign*/) const {
  RandomStream draw = steps_.of(static_cast<std::uint64_t>(index)).stream(0);
  double change_ns = draw.normal(phase_sigma_ns_);
  for (std::size_t i = 0; i < kProcesses; ++i) {
    const Transition& transition = transitions_[i];
    const double before_ppb = frequencies[i];
    frequencies[i] = transition.kept * before_ppb + draw.normal(transition.sigma_ppb);
    change_ns += transition.weight_s * (before_ppb + frequencies[i]);
  }
  return change_ns;
}

namespace {

constexpr double kPerPpmPerHour = 1e-6 / 3600;  // as a fraction per second
constexpr double kMostWalkPpb = scenarios::kMostFrequencyError * 1e9;

}  // namespace

OscillatorModel::OscillatorModel(const scenarios::Oscillator& parameters, std::uint64_t run_seed,
                                 std::string_view component, TrueTime switched_on,
                                 std::size_t kept_blocks)
    : skew_(RandomStream(run_seed, std::string(component) + ": skew")
                .normal(parameters.skew_sigma_ppm * 1e-6)),
      ramp_per_s_(parameters.ramp_ppm_per_hour * kPerPpmPerHour),
      heating_(parameters.self_heating_ppm * 1e-6),
      wander_(run_seed, ComponentKey(std::string(component) + ": wander")),
      heating_time_constant_s_(parameters.self_heating_time_constant_s),
      switched_on_(switched_on) {
  SIMBENCH_ASSERT(heating_ == 0 || heating_time_constant_s_ > 0, "heating takes time");
  if (parameters.flicker_floor_ppb > 0) {
    SIMBENCH_ASSERT(parameters.wander_step_ms > 0, "noise needs a grid to be sampled on");
    flicker_ = std::make_shared<const FlickerNoise>(
        parameters.flicker_floor_ppb, parameters.wander_step_ms, run_seed, component, kept_blocks);
  }
  const double white_ppb = parameters.white_frequency_ppb;
  const double walk_ppb = parameters.random_walk_ppb_per_sqrt_s;
  if (white_ppb != 0 || walk_ppb != 0) {
    SIMBENCH_ASSERT(parameters.wander_step_ms > 0, "noise needs a grid to be sampled on");
    walk_ = GridWalk<double>(from_ms(parameters.wander_step_ms).count(), 0.0, kept_blocks);
    first_cut_ = std::make_shared<std::int64_t>(std::numeric_limits<std::int64_t>::max());
    step_s_ = static_cast<double>(walk_.step_ns()) * 1e-9;
    walk_sigma_ppb_ = walk_ppb * std::sqrt(step_s_);
    // Given the frequency at both ends of a step, the integral of a random walk is normal around
    // the trapezium with variance K^2 step^3 / 12 (a Brownian bridge).
    phase_sigma_ns_ = std::sqrt(white_ppb * white_ppb * step_s_ +
                                walk_ppb * walk_ppb * step_s_ * step_s_ * step_s_ / 12);
  }
  is_steady_ = walk_.step_ns() == 0 && !flicker_ && ramp_per_s_ == 0 && heating_ == 0;
}

void OscillatorModel::set_temperature(const TemperatureCourse& course,
                                      double coefficient_ppb_per_k) {
  temperature_ = std::make_shared<const TemperatureCourse>(course);
  coefficient_ppb_per_k_ = coefficient_ppb_per_k;
  is_steady_ = false;
}

double OscillatorModel::mean_frequency(TrueTime from, TrueTime to) const {
  return (deviation_ns(to) - deviation_ns(from)) / static_cast<double>((to - from).count());
}

double OscillatorModel::mean_frequency_by_temperature(TrueTime from, TrueTime to) const {
  return (temperature_ns(to) - temperature_ns(from)) / static_cast<double>((to - from).count());
}

// 1 ppb for 1 s is 1 ns.
double OscillatorModel::temperature_ns(TrueTime t) const {
  return temperature_ ? coefficient_ppb_per_k_ * temperature_->integral_ks(t) : 0;
}

double OscillatorModel::unsteady_ns(TrueTime t) const {
  const std::int64_t since_zero_ns = t.time_since_epoch().count();
  double ns = 0;
  if (walk_.step_ns() != 0) {
    ns += walk_.phase_ns(since_zero_ns, [this](double& ppb, std::int64_t index, double sign) {
      return step(ppb, index, sign);
    });
  }
  if (flicker_) ns += flicker_->phase_ns(since_zero_ns);
  if (ramp_per_s_ != 0 && since_zero_ns > 0) {
    ns += ramp_ns(static_cast<double>(since_zero_ns) * 1e-9);
  }
  if (heating_ != 0 && t > switched_on_) {
    const double s = static_cast<double>((t - switched_on_).count()) * 1e-9;
    // expm1: soon after switching on the two terms nearly cancel.
    ns +=
        heating_ * (s + heating_time_constant_s_ * std::expm1(-s / heating_time_constant_s_)) * 1e9;
  }
  return ns + temperature_ns(t);
}

double OscillatorModel::ramp_end_s() const {
  return scenarios::kMostFrequencyError / std::abs(ramp_per_s_);
}

bool OscillatorModel::reached_limit(TrueTime end) const {
  const std::int64_t end_ns = end.time_since_epoch().count();
  if (ramp_per_s_ != 0 && static_cast<double>(end_ns) * 1e-9 >= ramp_end_s()) return true;
  return walk_.step_ns() != 0 && *first_cut_ < floor_div(end_ns, walk_.step_ns());
}

double OscillatorModel::ramp_ns(double since_zero_s) const {
  const double end_s = ramp_end_s();
  const double s = std::min(since_zero_s, end_s);
  return (ramp_per_s_ * s * s / 2 + ramp_per_s_ * s * (since_zero_s - s)) * 1e9;
}

double OscillatorModel::step(double& frequency_ppb, std::int64_t index, double sign) const {
  RandomStream draw = wander_.of(static_cast<std::uint64_t>(index)).stream(0);
  const double before_ppb = frequency_ppb;
  const double free_ppb = before_ppb + sign * draw.normal(walk_sigma_ppb_);
  frequency_ppb = std::clamp(free_ppb, -kMostWalkPpb, kMostWalkPpb);
  if (frequency_ppb != free_ppb) *first_cut_ = std::min(*first_cut_, index);
  return (before_ppb + frequency_ppb) / 2 * step_s_ + draw.normal(phase_sigma_ns_);
}

}  // namespace simbench::sim

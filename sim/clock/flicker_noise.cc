#include "sim/clock/flicker_noise.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "algorithms/ports/time.h"

namespace simbench::sim {
namespace {

constexpr double kShortestTimeConstantS = 0.01;
constexpr double kSpacing = 4.0;
constexpr double kCoarsestStepMs = 100.0;

}  // namespace

FlickerNoise::FlickerNoise(double floor_ppb, double step_ms, std::uint64_t run_seed,
                           std::string_view component)
    : run_seed_(run_seed), key_(std::string(component) + ": flicker") {
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
    // Of the integral between two known ends: never negative but for rounding.
    phase_variance +=
        variance * std::max(0.0, 4 * time_constant_s * time_constant_s * (half - tanh_half));
    time_constant_s *= kSpacing;
  }
  phase_sigma_ns_ = std::sqrt(phase_variance);

  RandomStream draw(run_seed, std::string(component) + ": flicker at zero");
  Frequencies at_zero{};
  for (double& frequency : at_zero) frequency = draw.normal(floor_ppb);
  walk_ = GridWalk<Frequencies>(step_ns, at_zero);
}

double FlickerNoise::phase_ns(std::int64_t since_zero_ns) const {
  return walk_.phase_ns(since_zero_ns,
                        [this](Frequencies& frequencies, std::int64_t index, double sign) {
                          return step(frequencies, index, sign);
                        });
}

// The processes are reversible in time, so a step is the same forwards and backwards.
double FlickerNoise::step(Frequencies& frequencies, std::int64_t index, double /*sign*/) const {
  RandomStream draw(run_seed_, key_, static_cast<std::uint64_t>(index));
  double change_ns = draw.normal(phase_sigma_ns_);
  for (std::size_t i = 0; i < kProcesses; ++i) {
    const Transition& transition = transitions_[i];
    const double before_ppb = frequencies[i];
    frequencies[i] = transition.kept * before_ppb + draw.normal(transition.sigma_ppb);
    change_ns += transition.weight_s * (before_ppb + frequencies[i]);
  }
  return change_ns;
}

}  // namespace simbench::sim

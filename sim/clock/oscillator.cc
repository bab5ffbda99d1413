#include "sim/clock/oscillator.h"

#include <cmath>
#include <string>

#include "algorithms/ports/assert.h"

namespace simbench::sim {

OscillatorModel::OscillatorModel(const scenarios::Oscillator& parameters, std::uint64_t run_seed,
                                 std::string_view component)
    : skew_(RandomStream(run_seed, std::string(component) + ": skew")
                .normal(parameters.skew_sigma_ppm * 1e-6)),
      run_seed_(run_seed),
      wander_key_(std::string(component) + ": wander") {
  const double white_ppb = parameters.white_frequency_ppb;
  const double walk_ppb = parameters.random_walk_ppb_per_sqrt_s;
  if (white_ppb == 0 && walk_ppb == 0) return;
  SIMBENCH_ASSERT(parameters.wander_step_ms > 0, "noise needs a grid to be sampled on");
  step_ns_ = from_ms(parameters.wander_step_ms).count();
  step_s_ = static_cast<double>(step_ns_) * 1e-9;
  walk_sigma_ppb_ = walk_ppb * std::sqrt(step_s_);
  // Given the frequency at both ends of a step, the integral of a random walk is normal around the
  // trapezium with variance K^2 step^3 / 12 (a Brownian bridge).
  phase_sigma_ns_ = std::sqrt(white_ppb * white_ppb * step_s_ +
                              walk_ppb * walk_ppb * step_s_ * step_s_ * step_s_ / 12);
}

double OscillatorModel::noise_ns(std::int64_t since_zero_ns) const {
  std::int64_t index = since_zero_ns / step_ns_;
  if (since_zero_ns % step_ns_ < 0) --index;
  const double part =
      static_cast<double>(since_zero_ns - index * step_ns_) / static_cast<double>(step_ns_);
  const double before_ns = grid_phase_ns(index);
  return before_ns + part * (grid_phase_ns(index + 1) - before_ns);
}

double OscillatorModel::grid_phase_ns(std::int64_t index) const {
  const bool forward = index >= 0;
  Walk& walk = forward ? forward_ : backward_;
  const auto place = static_cast<std::size_t>(forward ? index : -index);
  while (walk.phases_ns.size() <= place) {
    const auto last = static_cast<std::int64_t>(walk.phases_ns.size()) - 1;
    extend(walk, forward ? last : -last - 1, forward);
  }
  return walk.phases_ns[place];
}

void OscillatorModel::extend(Walk& walk, std::int64_t index, bool forward) const {
  RandomStream draw(run_seed_, wander_key_, static_cast<std::uint64_t>(index));
  const double sign = forward ? 1.0 : -1.0;
  const double before_ppb = walk.frequency_ppb;
  walk.frequency_ppb += sign * draw.normal(walk_sigma_ppb_);
  const double change_ns =
      (before_ppb + walk.frequency_ppb) / 2 * step_s_ + draw.normal(phase_sigma_ns_);
  walk.phases_ns.push_back(walk.phases_ns.back() + sign * change_ns);
}

}  // namespace simbench::sim

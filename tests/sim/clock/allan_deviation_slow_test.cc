// The Allan deviation of simulated oscillators against the configured one, from 0.1 s to 1000 s.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/clock/oscillator.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kSeed = 20210918;
constexpr double kGridS = 0.1;
constexpr int kOscillators = 8;
constexpr int kPoints = 300'000;  // 30,000 s
constexpr double kStandardDeviations = 4;

// Phases on a grid of 0.1 s, half of them before true zero.
template <class Phase>
std::vector<double> sampled(const Phase& phase_ns) {
  std::vector<double> phases;
  phases.reserve(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    phases.push_back(phase_ns(static_cast<std::int64_t>(i - kPoints / 2) * 100'000'000));
  }
  return phases;
}

// Overlapping Allan variance in ppb^2 at tau = m grid steps (Riley, NIST SP 1065, 5.2.4).
double allan_variance(const std::vector<double>& phases_ns, std::size_t m) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 * m < phases_ns.size(); ++i) {
    const double difference = phases_ns[i + 2 * m] - 2 * phases_ns[i + m] + phases_ns[i];
    sum += difference * difference;
  }
  const double tau_s = kGridS * static_cast<double>(m);
  return sum / (2 * tau_s * tau_s * static_cast<double>(phases_ns.size() - 2 * m));
}

// The estimate from one sample path at tau = m steps of N has at least N / m degrees of freedom
// (the worst of the three kinds of noise, a random walk), so the root of the mean over the paths
// has a relative standard deviation of at most sqrt(m / (2 N paths)).
double relative_sigma(std::size_t m) {
  return std::sqrt(static_cast<double>(m) / (2.0 * kPoints * kOscillators));
}

// Variance of the mean over u time constants of an Ornstein-Uhlenbeck process of variance 1.
double mean_variance(double u) { return 2 * (u + std::expm1(-u)) / (u * u); }

// The Allan variance of FlickerNoise of floor 1 in closed form.
double flicker_variance(double tau_s) {
  double sum = 0;
  for (int k = 0; k < 10; ++k) {
    const double u = tau_s / (0.01 * std::pow(4.0, k));
    sum += 2 * (mean_variance(u) - mean_variance(2 * u));
  }
  return sum;
}

template <class PhaseOf, class Expected>
void expect_allan_deviation(const PhaseOf& phase_of, const Expected& expected_ppb) {
  const std::vector<std::size_t> all_m = {1, 2, 5, 10, 30, 100, 300, 1000, 3000, 10'000};
  std::vector<double> variances(all_m.size());
  for (int i = 0; i < kOscillators; ++i) {
    const std::vector<double> phases = sampled(phase_of(i));
    for (std::size_t k = 0; k < all_m.size(); ++k) {
      variances[k] += allan_variance(phases, all_m[k]) / kOscillators;
    }
  }
  for (std::size_t k = 0; k < all_m.size(); ++k) {
    const double tau_s = kGridS * static_cast<double>(all_m[k]);
    const double ratio = std::sqrt(variances[k]) / expected_ppb(tau_s);
    EXPECT_NEAR(ratio, 1, kStandardDeviations * relative_sigma(all_m[k]) + 1e-3)
        << "tau " << tau_s << " s, seed " << kSeed;
  }
}

TEST(FlickerNoise, FloorIsFlatWithinFivePercentInClosedForm) {
  for (double tau_s = 0.1; tau_s < 1000.1; tau_s *= 1.2) {
    EXPECT_NEAR(std::sqrt(flicker_variance(tau_s)), 1, 0.05) << tau_s;
  }
}

FlickerNoise noise_of(double floor_ppb, double step_ms, int host) {
  return FlickerNoise(floor_ppb, step_ms, kSeed, "host" + std::to_string(host),
                      GridWalk<double>::kFewestBlocks);
}

TEST(FlickerNoise, HasTheAllanDeviationOfItsClosedForm) {
  constexpr double kFloorPpb = 0.7;
  expect_allan_deviation(
      [](int i) {
        return
            [noise = noise_of(kFloorPpb, 1000, i)](std::int64_t ns) { return noise.phase_ns(ns); };
      },
      [](double tau_s) { return kFloorPpb * std::sqrt(flicker_variance(tau_s)); });
}

TEST(FlickerNoise, AFinerGridMakesNoDifference) {
  expect_allan_deviation(
      [](int i) {
        return [noise = noise_of(0.7, 50, i)](std::int64_t ns) { return noise.phase_ns(ns); };
      },
      [](double tau_s) { return 0.7 * std::sqrt(flicker_variance(tau_s)); });
}

TEST(Oscillator, AllanDeviationIsThatOfWhiteNoiseFlickerAndRandomWalk) {
  const scenarios::Oscillator parameters{.skew_sigma_ppm = 10,
                                         .white_frequency_ppb = 1,
                                         .random_walk_ppb_per_sqrt_s = 0.03,
                                         .wander_step_ms = 100,
                                         .flicker_floor_ppb = 0.5};
  expect_allan_deviation(
      [&parameters](int i) {
        return [oscillator = OscillatorModel(parameters, kSeed, "host" + std::to_string(i))](
                   std::int64_t ns) { return oscillator.deviation_ns(TrueTime(Nanoseconds(ns))); };
      },
      [](double tau_s) {
        return std::sqrt(1 / tau_s + 0.25 * flicker_variance(tau_s) + 0.0009 * tau_s / 3);
      });
}

}  // namespace
}  // namespace simbench::sim

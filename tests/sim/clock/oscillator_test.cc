#include "sim/clock/oscillator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kRunSeed = 20210607;

scenarios::Oscillator noisy(double white_ppb, double walk_ppb) {
  return {.skew_sigma_ppm = 10,
          .white_frequency_ppb = white_ppb,
          .random_walk_ppb_per_sqrt_s = walk_ppb,
          .wander_step_ms = 100};
}

TrueTime at_seconds(double s) { return TrueTime(from_ms(s * 1e3)); }

// Allan deviation in ppb from phases tau apart, by the second differences of all of them.
double allan_deviation_ppb(const OscillatorModel& oscillator, double tau_s, int samples) {
  std::vector<double> phase_ns;
  for (int i = 0; i < samples + 2; ++i) {
    const TrueTime t = at_seconds(tau_s * i);
    phase_ns.push_back(oscillator.deviation_ns(t) -
                       oscillator.skew() * static_cast<double>(t.time_since_epoch().count()));
  }
  double sum = 0;
  for (std::size_t i = 0; i + 2 < phase_ns.size(); ++i) {
    const double difference = phase_ns[i + 2] - 2 * phase_ns[i + 1] + phase_ns[i];
    sum += difference * difference;
  }
  return std::sqrt(sum / (2 * samples)) / tau_s;
}

TEST(OscillatorTest, RateOfOneInABillionSurvivesHours) {
  const OscillatorModel oscillator(1e-9);
  for (const int hours : {-24, -1, 0, 1, 7, 24}) {
    const TrueTime t{std::chrono::hours(hours)};
    EXPECT_NEAR(oscillator.deviation_ns(t), hours * 3600.0, 1e-6) << hours << " h";
    EXPECT_NEAR(oscillator.deviation_ns(t + from_ms(1000)) - oscillator.deviation_ns(t), 1, 1e-6);
  }
}

TEST(OscillatorTest, SkewIsNormalWithTheConfiguredSigma) {
  constexpr int kDraws = 20'000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double ppm =
        OscillatorModel(noisy(0, 0), kRunSeed, "host" + std::to_string(i)).skew() * 1e6;
    sum += ppm;
    squares += ppm * ppm;
  }
  EXPECT_NEAR(sum / kDraws, 0, 5 * 10 / std::sqrt(kDraws)) << "seed " << kRunSeed;
  EXPECT_NEAR(std::sqrt(squares / kDraws), 10, 5 * 10 / std::sqrt(2.0 * kDraws))
      << "seed " << kRunSeed;
}

TEST(OscillatorTest, WithoutNoiseThePhaseIsTheSkewTimesTime) {
  const OscillatorModel oscillator(noisy(0, 0), kRunSeed, "host1");
  EXPECT_NE(oscillator.skew(), 0);
  EXPECT_DOUBLE_EQ(oscillator.deviation_ns(at_seconds(100)), oscillator.skew() * 1e11);
}

// Relative standard deviation of the estimate is below 1 / sqrt(samples) for both kinds of noise
// (the second differences are correlated with their neighbours only); five of them are allowed.
TEST(OscillatorTest, WhiteNoiseHasTheConfiguredAllanDeviation) {
  constexpr int kSamples = 10'000;
  const OscillatorModel oscillator(noisy(3, 0), kRunSeed, "host1");
  for (const double tau_s : {0.1, 1.0, 4.0}) {
    const double expected_ppb = 3 / std::sqrt(tau_s);
    EXPECT_NEAR(allan_deviation_ppb(oscillator, tau_s, kSamples), expected_ppb,
                expected_ppb * 5 / std::sqrt(kSamples))
        << "tau " << tau_s << " s, seed " << kRunSeed;
  }
}

TEST(OscillatorTest, RandomWalkHasTheConfiguredAllanDeviation) {
  constexpr int kSamples = 10'000;
  const OscillatorModel oscillator(noisy(0, 2), kRunSeed, "host1");
  for (const double tau_s : {0.1, 1.0, 4.0}) {
    const double expected_ppb = 2 * std::sqrt(tau_s / 3);
    EXPECT_NEAR(allan_deviation_ppb(oscillator, tau_s, kSamples), expected_ppb,
                expected_ppb * 5 / std::sqrt(kSamples))
        << "tau " << tau_s << " s, seed " << kRunSeed;
  }
}

TEST(OscillatorTest, ValuesDoNotDependOnTheOrderOfQueries) {
  const OscillatorModel forwards(noisy(1, 1), kRunSeed, "host1");
  const OscillatorModel backwards(noisy(1, 1), kRunSeed, "host1");
  const OscillatorModel once(noisy(1, 1), kRunSeed, "host1");
  const double first_ns = once.deviation_ns(at_seconds(-300.05));
  std::vector<double> seen;
  for (int i = -3001; i <= 3001; ++i) seen.push_back(forwards.deviation_ns(at_seconds(i / 10.0)));
  for (int i = 3001; i >= -3001; --i) {
    ASSERT_EQ(backwards.deviation_ns(at_seconds(i / 10.0)), seen.at(i + 3001)) << i;
  }
  EXPECT_EQ(forwards.deviation_ns(at_seconds(-300.05)), first_ns);
}

TEST(OscillatorTest, PhaseIsZeroAtZeroAndContinuousThroughIt) {
  const OscillatorModel oscillator(noisy(5, 5), kRunSeed, "host1");
  EXPECT_EQ(oscillator.deviation_ns(TrueTime{}), 0);
  for (int ns = -200; ns < 200; ++ns) {
    const TrueTime t{Nanoseconds(ns)};
    EXPECT_NEAR(oscillator.deviation_ns(t + Nanoseconds(1)), oscillator.deviation_ns(t), 1e-3);
  }
}

TEST(OscillatorTest, BetweenGridPointsThePhaseIsLinear) {
  const OscillatorModel oscillator(noisy(100, 100), kRunSeed, "host1");
  for (const double s : {-7.3, -0.1, 0.0, 12.5}) {
    const double a = oscillator.deviation_ns(at_seconds(s));
    const double middle = oscillator.deviation_ns(at_seconds(s + 0.05));
    const double b = oscillator.deviation_ns(at_seconds(s + 0.1));
    EXPECT_NEAR(middle, (a + b) / 2, 1e-6) << s;
  }
}

TEST(OscillatorTest, NoiseBeforeZeroIsNotTheMirrorImageOfThatAfter) {
  const OscillatorModel oscillator(noisy(10, 0), kRunSeed, "host1");
  const auto noise_ns = [&](double s) {
    return oscillator.deviation_ns(at_seconds(s)) - oscillator.skew() * s * 1e9;
  };
  EXPECT_GT(std::abs(noise_ns(1) - noise_ns(-1)), 1e-3);
  EXPECT_GT(std::abs(noise_ns(1) + noise_ns(-1)), 1e-3);
}

// With everything on, for what must hold of the sum.
scenarios::Oscillator unsteady() {
  scenarios::Oscillator parameters = noisy(1, 1);
  parameters.flicker_floor_ppb = 2;
  parameters.ramp_ppm_per_hour = 0.5;
  parameters.self_heating_ppm = 3;
  parameters.self_heating_time_constant_s = 100;
  return parameters;
}

TEST(OscillatorTest, FlickerDoesNotDependOnTheOrderOfQueries) {
  const OscillatorModel forwards(unsteady(), kRunSeed, "host1");
  const OscillatorModel backwards(unsteady(), kRunSeed, "host1");
  std::vector<double> seen;
  for (int i = -3001; i <= 3001; ++i) seen.push_back(forwards.deviation_ns(at_seconds(i / 7.0)));
  for (int i = 3001; i >= -3001; --i) {
    ASSERT_EQ(backwards.deviation_ns(at_seconds(i / 7.0)), seen.at(i + 3001)) << i;
  }
  EXPECT_EQ(forwards.deviation_ns(TrueTime{}), 0);
}

TEST(OscillatorTest, FlickerGoesOnSmoothlyThroughZero) {
  // Its slow part is nearly constant over a second, on either side of zero.
  scenarios::Oscillator parameters = noisy(0, 0);
  parameters.skew_sigma_ppm = 0;
  parameters.flicker_floor_ppb = 100;
  double products = 0;
  double squares = 0;
  for (int i = 0; i < 1000; ++i) {
    const OscillatorModel oscillator(parameters, kRunSeed, "host" + std::to_string(i));
    const double before_ns = -oscillator.deviation_ns(at_seconds(-1));
    const double after_ns = oscillator.deviation_ns(at_seconds(1));
    products += before_ns * after_ns;
    squares += (before_ns * before_ns + after_ns * after_ns) / 2;
  }
  // Allan variance at 1 s is squares - products per draw: 100^2 ppb^2 within the 4.5 % of 1000
  // draws, five times; the correlation is high since most of the power is slower than 1 s.
  EXPECT_NEAR((squares - products) / 1000 / 1e4, 1, 5 * 0.045) << "seed " << kRunSeed;
  EXPECT_GT(products / squares, 0.75) << "seed " << kRunSeed;
}

TEST(OscillatorTest, WhatIsNewMovesNoOldNumber) {
  const OscillatorModel plain(noisy(1, 1), kRunSeed, "host1");
  scenarios::Oscillator parameters = noisy(1, 1);
  parameters.flicker_floor_ppb = 1e-9;
  const OscillatorModel flickering(parameters, kRunSeed, "host1");
  for (const double s : {-500.0, 0.3, 700.0}) {
    EXPECT_NEAR(flickering.deviation_ns(at_seconds(s)), plain.deviation_ns(at_seconds(s)), 1e-5);
  }
}

TEST(OscillatorTest, RampGrowsWithTheSquareOfTimeAfterZero) {
  scenarios::Oscillator parameters{};
  parameters.ramp_ppm_per_hour = 3.6;  // 1e-9 per second
  const OscillatorModel oscillator(parameters, kRunSeed, "host1");
  for (const double s : {1.0, 10.0, 3600.0}) {
    EXPECT_NEAR(oscillator.deviation_ns(at_seconds(s)), s * s / 2, 1e-6 * s) << s;
  }
  EXPECT_EQ(oscillator.deviation_ns(at_seconds(-3600)), 0);
}

TEST(OscillatorTest, SelfHeatingApproachesItsValueAfterSwitchingOn) {
  scenarios::Oscillator parameters{};
  parameters.self_heating_ppm = -2;
  parameters.self_heating_time_constant_s = 50;
  const TrueTime on = at_seconds(20);
  const OscillatorModel oscillator(parameters, kRunSeed, "camera1", on);
  EXPECT_EQ(oscillator.deviation_ns(at_seconds(-5)), 0);
  EXPECT_EQ(oscillator.deviation_ns(on), 0);
  // -2 ppm * (s - 50 s * (1 - exp(-s / 50 s))), in ns.
  EXPECT_NEAR(oscillator.deviation_ns(on + from_ms(50e3)), -2e3 * (50 - 50 * (1 - std::exp(-1))),
              1e-6);
  EXPECT_NEAR(oscillator.deviation_ns(on + from_ms(1e7)), -2e3 * (1e4 - 50), 1e-4);
  // At first it grows with the square of time: -2 ppm * s^2 / (2 * 50 s).
  EXPECT_NEAR(oscillator.deviation_ns(on + from_ms(1)), -2e3 * 1e-6 / 100, 1e-9);
}

TEST(OscillatorTest, ComponentsAndSeedsDiffer) {
  const double one = OscillatorModel(noisy(1, 1), kRunSeed, "host1").deviation_ns(at_seconds(5));
  EXPECT_NE(one, OscillatorModel(noisy(1, 1), kRunSeed, "host2").deviation_ns(at_seconds(5)));
  EXPECT_NE(one, OscillatorModel(noisy(1, 1), kRunSeed + 1, "host1").deviation_ns(at_seconds(5)));
}

TEST(OscillatorTest, KnowsWhetherItGotToItsLimit) {
  const OscillatorModel calm({.random_walk_ppb_per_sqrt_s = 1e3, .wander_step_ms = 1000}, 1, "a");
  calm.deviation_ns(at_ms(1e6));
  EXPECT_FALSE(calm.reached_limit(at_ms(1e6)));
  const OscillatorModel wild({.random_walk_ppb_per_sqrt_s = 1e6, .wander_step_ms = 1000}, 1, "a");
  wild.deviation_ns(at_ms(1e9));
  EXPECT_TRUE(wild.reached_limit(at_ms(1e9)));
  EXPECT_FALSE(wild.reached_limit(at_ms(1e3)));  // 1e6 ppb in the first second, of 5e7
  // 3600 ppm/h are 1 ppm/s: 5 % after 50 000 s.
  const OscillatorModel ramp({.ramp_ppm_per_hour = -3600}, 1, "a");
  EXPECT_FALSE(ramp.reached_limit(at_ms(49.9e6)));
  EXPECT_TRUE(ramp.reached_limit(at_ms(50.1e6)));
}

TEST(OscillatorTest, AClockRunsForwardHoweverItWanders) {
  scenarios::Oscillator parameters = noisy(0, 1e6);
  parameters.wander_step_ms = 1000;
  parameters.skew_sigma_ppm = 0;
  for (const double ramp_ppm_per_hour : {-1000.0, 0.0, 1000.0}) {
    parameters.ramp_ppm_per_hour = ramp_ppm_per_hour;
    const OscillatorModel oscillator(parameters, kRunSeed, "host1");
    double last_ns = oscillator.deviation_ns(at_seconds(-1e6));
    for (double s = -1e6 + 100; s < 1e6; s += 100) {
      const double ns = oscillator.deviation_ns(at_seconds(s));
      ASSERT_LT(std::abs(ns - last_ns), 0.11 * 100e9) << s;
      last_ns = ns;
    }
  }
}

}  // namespace
}  // namespace simbench::sim

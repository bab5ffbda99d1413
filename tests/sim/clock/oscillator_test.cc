#include "sim/clock/oscillator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace simbench::sim {
namespace {

constexpr std::uint64_t kSeed = 20210607;

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
    const double ppm = OscillatorModel(noisy(0, 0), kSeed, "host" + std::to_string(i)).skew() * 1e6;
    sum += ppm;
    squares += ppm * ppm;
  }
  EXPECT_NEAR(sum / kDraws, 0, 5 * 10 / std::sqrt(kDraws)) << "seed " << kSeed;
  EXPECT_NEAR(std::sqrt(squares / kDraws), 10, 5 * 10 / std::sqrt(2.0 * kDraws))
      << "seed " << kSeed;
}

TEST(OscillatorTest, WithoutNoiseThePhaseIsTheSkewTimesTime) {
  const OscillatorModel oscillator(noisy(0, 0), kSeed, "host1");
  EXPECT_NE(oscillator.skew(), 0);
  EXPECT_DOUBLE_EQ(oscillator.deviation_ns(at_seconds(100)), oscillator.skew() * 1e11);
}

// Relative standard deviation of the estimate is below 1 / sqrt(samples) for both kinds of noise
// (the second differences are correlated with their neighbours only); five of them are allowed.
TEST(OscillatorTest, WhiteNoiseHasTheConfiguredAllanDeviation) {
  constexpr int kSamples = 10'000;
  const OscillatorModel oscillator(noisy(3, 0), kSeed, "host1");
  for (const double tau_s : {0.1, 1.0, 4.0}) {
    const double expected_ppb = 3 / std::sqrt(tau_s);
    EXPECT_NEAR(allan_deviation_ppb(oscillator, tau_s, kSamples), expected_ppb,
                expected_ppb * 5 / std::sqrt(kSamples))
        << "tau " << tau_s << " s, seed " << kSeed;
  }
}

TEST(OscillatorTest, RandomWalkHasTheConfiguredAllanDeviation) {
  constexpr int kSamples = 10'000;
  const OscillatorModel oscillator(noisy(0, 2), kSeed, "host1");
  for (const double tau_s : {0.1, 1.0, 4.0}) {
    const double expected_ppb = 2 * std::sqrt(tau_s / 3);
    EXPECT_NEAR(allan_deviation_ppb(oscillator, tau_s, kSamples), expected_ppb,
                expected_ppb * 5 / std::sqrt(kSamples))
        << "tau " << tau_s << " s, seed " << kSeed;
  }
}

TEST(OscillatorTest, ValuesDoNotDependOnTheOrderOfQueries) {
  const OscillatorModel forwards(noisy(1, 1), kSeed, "host1");
  const OscillatorModel backwards(noisy(1, 1), kSeed, "host1");
  const OscillatorModel once(noisy(1, 1), kSeed, "host1");
  const double first_ns = once.deviation_ns(at_seconds(-300.05));
  std::vector<double> seen;
  for (int i = -3001; i <= 3001; ++i) seen.push_back(forwards.deviation_ns(at_seconds(i / 10.0)));
  for (int i = 3001; i >= -3001; --i) {
    ASSERT_EQ(backwards.deviation_ns(at_seconds(i / 10.0)), seen.at(i + 3001)) << i;
  }
  EXPECT_EQ(forwards.deviation_ns(at_seconds(-300.05)), first_ns);
}

TEST(OscillatorTest, PhaseIsZeroAtZeroAndContinuousThroughIt) {
  const OscillatorModel oscillator(noisy(5, 5), kSeed, "host1");
  EXPECT_EQ(oscillator.deviation_ns(TrueTime{}), 0);
  for (int ns = -200; ns < 200; ++ns) {
    const TrueTime t{Nanoseconds(ns)};
    EXPECT_NEAR(oscillator.deviation_ns(t + Nanoseconds(1)), oscillator.deviation_ns(t), 1e-3);
  }
}

TEST(OscillatorTest, BetweenGridPointsThePhaseIsLinear) {
  const OscillatorModel oscillator(noisy(100, 100), kSeed, "host1");
  for (const double s : {-7.3, -0.1, 0.0, 12.5}) {
    const double a = oscillator.deviation_ns(at_seconds(s));
    const double middle = oscillator.deviation_ns(at_seconds(s + 0.05));
    const double b = oscillator.deviation_ns(at_seconds(s + 0.1));
    EXPECT_NEAR(middle, (a + b) / 2, 1e-6) << s;
  }
}

TEST(OscillatorTest, NoiseBeforeZeroIsNotTheMirrorImageOfThatAfter) {
  const OscillatorModel oscillator(noisy(10, 0), kSeed, "host1");
  const auto noise_ns = [&](double s) {
    return oscillator.deviation_ns(at_seconds(s)) - oscillator.skew() * s * 1e9;
  };
  EXPECT_GT(std::abs(noise_ns(1) - noise_ns(-1)), 1e-3);
  EXPECT_GT(std::abs(noise_ns(1) + noise_ns(-1)), 1e-3);
}

TEST(OscillatorTest, ComponentsAndSeedsDiffer) {
  const double one = OscillatorModel(noisy(1, 1), kSeed, "host1").deviation_ns(at_seconds(5));
  EXPECT_NE(one, OscillatorModel(noisy(1, 1), kSeed, "host2").deviation_ns(at_seconds(5)));
  EXPECT_NE(one, OscillatorModel(noisy(1, 1), kSeed + 1, "host1").deviation_ns(at_seconds(5)));
}

}  // namespace
}  // namespace simbench::sim

#include <gtest/gtest.h>

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>

#include "algorithms/host_sync/pulses/pulse_observer.h"

namespace simbench {
namespace {

constexpr Nanoseconds kTrainPeriod{22'222'222};

SteadyTime train_pulse_at(std::int64_t number) {
  return SteadyTime(from_ms(1e6) + number * kTrainPeriod);
}

double error_us(const Sighting& sighting, std::int64_t number) {
  return to_ms(sighting.at - train_pulse_at(number)) * 1e3;
}

TEST(PulseTrainTest, WithoutDelayEveryPulseIsFoundExactly) {
  PulseTrain train({});
  EXPECT_FALSE(train.middle());
  EXPECT_FALSE(train.nearest(train_pulse_at(0)));
  for (std::int64_t i = 0; i < 400; ++i) train.add(kTrainPeriod, train_pulse_at(i));
  EXPECT_EQ(train.period(), kTrainPeriod);
  const Sighting middle = *train.middle();
  EXPECT_NEAR(error_us(middle, 200), 0, 0.002);
  EXPECT_EQ(middle.sigma_ns, 0);
  for (const std::int64_t number : {140, 200, 264}) {
    const SteadyTime near = train_pulse_at(number) + from_ms(10);
    EXPECT_NEAR(error_us(*train.nearest(near), number), 0, 0.002);
    EXPECT_NEAR(error_us(*train.nearest(train_pulse_at(number) - from_ms(10)), number), 0, 0.002);
  }
  // Blocks of 45 pulses: the fourth begins at 135, and the second group's last ends with 269.
  EXPECT_FALSE(train.nearest(train_pulse_at(130)));
  EXPECT_FALSE(train.nearest(train_pulse_at(275)));
  EXPECT_FALSE(train.nearest(train_pulse_at(-5)));
  EXPECT_FALSE(train.nearest(train_pulse_at(405)));
}

TEST(PulseTrainTest, DelaysLeaveTheirMinimumAndTheUncertaintyIsMeasured) {
  boost::random::mt19937_64 engine(2);
  boost::random::exponential_distribution<double> delay(1 / 0.6);  // ms
  double squares = 0;
  double variances = 0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    PulseTrain train({});
    for (std::int64_t i = 0; i < 400; ++i) {
      train.add(kTrainPeriod, train_pulse_at(i) + from_ms(8 + delay(engine)));
    }
    const Sighting found = *train.nearest(train_pulse_at(200) + from_ms(8));
    const double error = error_us(found, 200) - 8000;
    EXPECT_GE(error, 0) << "seed 2, run " << run;
    squares += error * error;
    variances += found.sigma_ns * found.sigma_ns * 1e-6;
  }
  const double error_rms = std::sqrt(squares / kRuns);
  EXPECT_LT(error_rms, 6);
  EXPECT_NEAR(std::sqrt(variances / kRuns), error_rms, error_rms / 2);
}

TEST(PulseTrainTest, DelaysThatGoTogetherAreSeenInTheUncertainty) {
  // Exponential delays that 10 pulses in a row share: as if there were a tenth of the pulses.
  boost::random::mt19937_64 engine(3);
  boost::random::exponential_distribution<double> delay(1 / 0.6);  // ms
  double squares = 0;
  double variances = 0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    PulseTrain train({});
    double shared_ms = 0;
    for (std::int64_t i = 0; i < 900; ++i) {
      if (i % 10 == 0) shared_ms = delay(engine);
      train.add(kTrainPeriod, train_pulse_at(i) + from_ms(8 + shared_ms));
    }
    const Sighting found = *train.nearest(train_pulse_at(450) + from_ms(8));
    const double error = error_us(found, 450) - 8000;
    squares += error * error;
    variances += found.sigma_ns * found.sigma_ns * 1e-6;
  }
  const double ratio = std::sqrt(variances / squares);
  EXPECT_GT(ratio, 0.7) << "seed 3";
  EXPECT_LT(ratio, 2) << "seed 3";
}

TEST(PulseTrainTest, LostPulsesAreCounted) {
  boost::random::mt19937_64 engine(6);
  PulseTrain train({});
  std::int64_t last = 0;
  for (std::int64_t i = 0; i < 400; ++i) {
    if (i % 7 == 3 || engine() % 3 == 0) continue;
    train.add(
        (i - last) * kTrainPeriod + Nanoseconds(static_cast<std::int64_t>(engine() % 100'000)),
        train_pulse_at(i));
    last = i;
  }
  EXPECT_NEAR(error_us(*train.nearest(train_pulse_at(200)), 200), 0, 0.01) << "seed 6";
}

TEST(PulseTrainTest, APeriodKnownToAPercentIsGoodEnough) {
  PulseTrain train({.window = from_ms(30e3), .period = Nanoseconds(22'000'000)});
  for (std::int64_t i = 0; i < 1000; ++i) train.add(kTrainPeriod, train_pulse_at(i));
  for (const std::int64_t number : {200, 500, 800}) {
    EXPECT_NEAR(error_us(*train.nearest(train_pulse_at(number) + from_ms(9)), number), 0, 0.01);
  }
}

TEST(PulseTrainTest, StampsThatStandStillOrGoBackAreIgnored) {
  PulseTrain train({});
  for (std::int64_t i = 0; i < 400; ++i) {
    train.add(kTrainPeriod, train_pulse_at(i));
    train.add(Nanoseconds(0), train_pulse_at(i) - from_ms(5));
    train.add(-kTrainPeriod, train_pulse_at(i) - from_ms(5));
  }
  EXPECT_NEAR(error_us(*train.nearest(train_pulse_at(200)), 200), 0, 0.01);
}

TEST(PulseTrainTest, AnotherRateStartsTheTrainAgain) {
  PulseTrain train({});
  for (std::int64_t i = 0; i < 100; ++i) train.add(kTrainPeriod, train_pulse_at(i));
  const Nanoseconds period{33'333'333};
  for (std::int64_t i = 1; i < 300; ++i) train.add(period, train_pulse_at(99) + i * period);
  EXPECT_EQ(train.period(), period);
  EXPECT_FALSE(train.nearest(train_pulse_at(50)));
  EXPECT_TRUE(train.nearest(train_pulse_at(99) + 150 * period));
}

}  // namespace
}  // namespace simbench

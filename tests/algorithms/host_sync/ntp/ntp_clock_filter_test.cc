#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <optional>

#include "algorithms/host_sync/ntp/ntp_discipline.h"

namespace simbench {
namespace {

constexpr double kPrecision = 1e-6;
constexpr double kPoll = 64;

NtpSample sample(double offset_s, double delay_s, double at_s) {
  return {offset_s, delay_s, kPrecision, at_s};
}

TEST(NtpClockFilter, UsesTheSampleOfTheLowestDelay) {
  NtpClockFilter filter(kPrecision);
  EXPECT_EQ(filter.add(sample(5e-3, 10e-3, 0), kPoll)->offset_s, 5e-3);
  EXPECT_EQ(filter.add(sample(1e-3, 2e-3, 64), kPoll)->offset_s, 1e-3);
  EXPECT_FALSE(filter.add(sample(4e-3, 8e-3, 128), kPoll)) << "the best one was used already";
  EXPECT_EQ(filter.add(sample(1.1e-3, 1.9e-3, 192), kPoll)->offset_s, 1.1e-3);
}

TEST(NtpClockFilter, NeverUsesASampleOlderThanTheLastUsed) {
  NtpClockFilter filter(kPrecision);
  filter.add(sample(1e-3, 1e-3, 0), kPoll);
  for (int i = 1; i < 8; ++i) {
    EXPECT_FALSE(filter.add(sample(1e-3, (2 + i) * 1e-3, i * 64), kPoll));
  }
  // The first has left the eight stages: the second is the best, and newer than the last used.
  const std::optional<NtpSample> best = filter.add(sample(1e-3, 20e-3, 512), kPoll);
  ASSERT_TRUE(best);
  EXPECT_EQ(best->at_s, 64);
}

TEST(NtpClockFilter, DispersionIsTheWeightedSumOfTheStages) {
  NtpClockFilter filter(kPrecision);
  filter.add({0, 1e-3, 0.01, 0}, kPoll);
  EXPECT_NEAR(filter.dispersion_s(), 0.01 / 2 + 16 * (0.5 - 1.0 / 256), 1e-12);
  filter.add({0, 2e-3, 0.02, 100}, kPoll);  // the first has grown by 100 * 15e-6
  EXPECT_NEAR(filter.dispersion_s(), 0.0115 / 2 + 0.02 / 4 + 16 * (0.25 - 1.0 / 256), 1e-12);
  EXPECT_NEAR(filter.distance_s(), 1e-3 / 2 + filter.dispersion_s() + filter.jitter_s(), 1e-15);
}

TEST(NtpClockFilter, JitterIsTheRmsDifferenceToTheBest) {
  NtpClockFilter filter(kPrecision);
  filter.add(sample(10e-3, 1e-3, 0), kPoll);
  EXPECT_EQ(filter.jitter_s(), kPrecision);
  filter.add(sample(13e-3, 2e-3, 64), kPoll);
  filter.add(sample(6e-3, 3e-3, 128), kPoll);
  EXPECT_NEAR(filter.jitter_s(), std::sqrt((9e-6 + 16e-6) / 2), 1e-12);
}

// Eight samples with a jitter of about 10 us.
NtpClockFilter settled_filter() {
  NtpClockFilter filter(kPrecision);
  for (int i = 0; i < 8; ++i) {
    filter.add(sample(i % 2 == 0 ? 0 : 10e-6, 1e-3 - i * 1e-6, i * 64), kPoll);
  }
  return filter;
}

TEST(NtpClockFilter, ALoneOutlierOfLowDelayPassesThePopcornGate) {
  NtpClockFilter filter = settled_filter();
  EXPECT_TRUE(filter.add(sample(500e-6, 0.5e-3, 512), kPoll)) << "the jitter is taken to it";
}

// The best sample is the oldest and the only one at 0; it leaves with the ninth.
NtpClockFilter filter_before_a_change() {
  NtpClockFilter filter(kPrecision);
  filter.add(sample(0, 0.5e-3, 0), kPoll);
  for (int i = 1; i < 8; ++i) {
    filter.add(sample(i % 2 == 0 ? 500e-6 : 510e-6, 1e-3 + i * 1e-6, i * 64), kPoll);
  }
  return filter;
}

TEST(NtpClockFilter, SuppressesAPopcornSpike) {
  NtpClockFilter filter = filter_before_a_change();
  EXPECT_FALSE(filter.add(sample(500e-6, 2e-3, 512), kPoll)) << "that of 64 s, within two polls";
  NtpClockFilter slow = filter_before_a_change();
  EXPECT_TRUE(slow.add(sample(500e-6, 2e-3, 512), kPoll / 2)) << "two polls after the last used";
}

TEST(NtpClockFilter, AChangeThatLastsIsNoSpike) {
  NtpClockFilter filter = filter_before_a_change();
  EXPECT_FALSE(filter.add(sample(500e-6, 2e-3, 512), kPoll));
  EXPECT_TRUE(filter.add(sample(500e-6, 2e-3, 576), kPoll)) << "the best before counts, unused";
}

TEST(NtpClockFilter, MissingSamplesMakeTheServerUnusable) {
  NtpClockFilter filter = settled_filter();
  EXPECT_LT(filter.distance_s(), NtpClockFilter::kMaxDistance);
  for (int i = 0; i < 8; ++i) filter.add_missing(512 + i * 64);
  EXPECT_GT(filter.distance_s(), NtpClockFilter::kMaxDistance);
  EXPECT_TRUE(filter.add(sample(1e-3, 1e-3, 1100), kPoll)) << "and it returns";
}

TEST(NtpClockFilter, BeyondTheAllanInterceptAgeCountsAsDelay) {
  NtpClockFilter filter(kPrecision);
  filter.add(sample(0, 1e-3, 0), 1024);
  // 3072 s later the first has a dispersion of 46 ms: slower than the 2 ms of the new one.
  EXPECT_TRUE(filter.add(sample(0, 2e-3, 3072), 1024));
  NtpClockFilter young(kPrecision);
  young.add(sample(0, 1e-3, 0), 1024);
  EXPECT_FALSE(young.add(sample(0, 2e-3, 2048), 1024));
}

TEST(NtpClockFilter, WhileStartingTheNewestIsUsed) {
  NtpClockFilter filter(kPrecision);
  filter.add(sample(1e-3, 1e-3, 0), kPoll, true);
  const std::optional<NtpSample> newest = filter.add(sample(2e-3, 5e-3, 64), kPoll, true);
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->offset_s, 2e-3);
  EXPECT_FALSE(filter.add(sample(2e-3, 6e-3, 128), kPoll)) << "started: the first is the best";
}

TEST(NtpClockFilter, ResetForgetsEverything) {
  NtpClockFilter filter = settled_filter();
  filter.reset();
  EXPECT_EQ(filter.dispersion_s(), NtpClockFilter::kMaxDispersion);
  EXPECT_TRUE(filter.add(sample(-3, 50e-3, 600), kPoll));
}

TEST(NtpClockFilter, IsFiniteForAnySamples) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    boost::random::mt19937 engine(seed);
    boost::random::uniform_01<double> uniform;
    NtpClockFilter filter(kPrecision);
    double at_s = 0;
    double last_used_s = -1;
    for (int i = 0; i < 500; ++i) {
      at_s += uniform(engine) < 0.1 ? 0 : std::exp(20 * uniform(engine) - 10);
      const double scale = std::exp(40 * uniform(engine) - 30);
      if (uniform(engine) < 0.2) {
        filter.add_missing(at_s);
        continue;
      }
      const auto used = filter.add({(uniform(engine) - 0.5) * scale,
                                    (uniform(engine) - 0.5) * scale, uniform(engine) * scale, at_s},
                                   kPoll);
      if (used) {
        EXPECT_GT(used->at_s, last_used_s) << "seed " << seed;
        last_used_s = used->at_s;
      }
      ASSERT_TRUE(std::isfinite(filter.distance_s())) << "seed " << seed;
      ASSERT_GE(filter.jitter_s(), kPrecision) << "seed " << seed;
      ASSERT_LE(filter.dispersion_s(), NtpClockFilter::kMaxDispersion) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace simbench

#include "algorithms/host_sync/chrony/chrony_source_stats.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

namespace simbench {
namespace {

// A client that lacks 10 ppm and is 1 ms behind at 0.
ChronySample chrony_sample(double at_s, double extra_delay_s = 0, double offset_error_s = 0) {
  return {at_s, 1e-3 + 10e-6 * at_s + offset_error_s, 300e-6 + extra_delay_s, 1e-7};
}

// With an error of 50 ns to alternating sides: the runs test has nothing to drop.
ChronySourceStats stats_with(int samples) {
  ChronySourceStats stats({});
  for (int i = 0; i < samples; ++i) {
    stats.add(chrony_sample(i * 64, (i * 7 % 5) * 1e-6, i % 2 == 0 ? 50e-9 : -50e-9));
  }
  return stats;
}

TEST(ChronySourceStats, NeedsThreeSamples) {
  EXPECT_FALSE(stats_with(2).estimate());
  EXPECT_EQ(ChronySourceStats({}).predict_s(1000), 0);
  EXPECT_EQ(stats_with(2).predict_s(1000), chrony_sample(64, 0, -50e-9).offset_s);
  EXPECT_EQ(stats_with(2).frequency_error(), 2e-3);
  EXPECT_LT(stats_with(10).frequency_error(), 1e-6);
  EXPECT_TRUE(stats_with(3).estimate());
}

TEST(ChronySourceStats, FindsOffsetAndFrequency) {
  const ChronySourceStats stats = stats_with(10);
  EXPECT_NEAR(stats.estimate()->frequency, 10e-6, 0.5e-9);
  EXPECT_NEAR(stats.estimate()->offset_s, 1e-3 + 10e-6 * 576, 100e-9);
  EXPECT_NEAR(stats.predict_s(1000), 11e-3, 0.3e-6);
  EXPECT_EQ(stats.samples(), 10U);
}

TEST(ChronySourceStats, SlowSamplesCountLittle) {
  ChronySourceStats stats({});
  for (int i = 0; i < 20; ++i) {
    const bool is_slow = i % 4 == 2;
    stats.add(chrony_sample(i * 64, is_slow ? 20e-3 : (i % 3) * 10e-6, is_slow ? 10e-3 : 0));
  }
  // Equal weights would be off by a quarter of 10 ms.
  EXPECT_NEAR(stats.predict_s(1216), 1e-3 + 10e-6 * 1216, 20e-6);
}

TEST(ChronySourceStats, ACorrectionMovesThePast) {
  ChronySourceStats stats = stats_with(10);
  stats.correct(600, 1e-3 + 10e-6 * 600, 10e-6);
  EXPECT_NEAR(stats.estimate()->frequency, 0, 0.5e-9);
  EXPECT_NEAR(stats.predict_s(600), 0, 100e-9);
  // Samples of the corrected clock go on along the same line.
  stats.add({640, 50e-9, 300e-6, 1e-7});
  EXPECT_EQ(stats.samples(), 11U);
  EXPECT_NEAR(stats.estimate()->offset_s, 0, 100e-9);
  EXPECT_NEAR(stats.estimate()->frequency, 0, 0.5e-9);
}

TEST(ChronySourceStats, ForgetsARateThatIsOver) {
  ChronySourceStats stats({});
  for (int i = 0; i < 30; ++i) {
    const double at_s = i * 64;
    const double after_s = std::max(at_s - 960, 0.0);
    stats.add({at_s, 30e-6 * after_s + (i * 7 % 5 - 2) * 1e-6, 300e-6, 1e-7});
  }
  EXPECT_LT(stats.samples(), 18U);
  EXPECT_NEAR(stats.estimate()->frequency, 30e-6, 1e-6);
}

TEST(ChronySourceStats, KeepsAtMostMaxSamples) { EXPECT_EQ(stats_with(200).samples(), 64U); }

TEST(ChronySourceStats, RefusesADelayThatTheSamplesDoNotExplain) {
  ChronySourceStats stats({});
  for (int i = 0; i < 10; ++i)
    stats.add(chrony_sample(i * 64, (i * 7 % 5) * 1e-6, (i % 2) * 10e-6));
  EXPECT_TRUE(stats.is_good(chrony_sample(640)));
  EXPECT_FALSE(stats.is_good(chrony_sample(640, 5e-3, 2.5e-3)));
  // Off by more than its delay: the clock has changed.
  EXPECT_TRUE(stats.is_good(chrony_sample(640, 5e-3, 100e-3)));
}

TEST(ChronySourceStats, CorrectsAnAsymmetryThatPersists) {
  ChronySourceStats stats({});
  for (int i = 0; i < 30; ++i) {
    const double extra_s = (i * 7 % 5) * 1e-3;  // all of it on the request's way
    stats.add(chrony_sample(i * 64, extra_s, extra_s / 2));
    EXPECT_EQ(stats.asymmetry() != 0, i >= 12) << i;  // ten, the first with four samples
  }
  EXPECT_NEAR(stats.asymmetry(), 0.5, 1e-9);
  EXPECT_NEAR(stats.estimate()->offset_s, 1e-3 + 10e-6 * 29 * 64, 1e-9);
}

// The count of asymmetric samples goes on where the slope is small; only its sign ends it.
TEST(ChronySourceStats, ASmallSlopeDoesNotEndTheRun) {
  ChronySourceStats stats({});
  double at_s = 0;
  const auto add = [&](int count, double share) {
    for (int i = 0; i < count; ++i, at_s += 64) {
      const double extra_s = (i * 7 % 5) * 1e-3;
      stats.add(chrony_sample(at_s, extra_s, share * extra_s));
    }
  };
  add(30, 0.5);
  add(10, 0.4);
  EXPECT_NE(stats.asymmetry(), 0);
  add(64, -0.5);
  add(64, -0.5);
  EXPECT_NEAR(stats.asymmetry(), -0.5, 1e-9);
}

TEST(ChronySourceStats, TestsDelaysFromSixSamplesOn) {
  const auto judged = [](int samples) {
    return stats_with(samples).is_good(chrony_sample(samples * 64, 5e-3, 2.5e-3));
  };
  EXPECT_TRUE(judged(5));
  EXPECT_FALSE(judged(6));
}

// After a day of silence 1 ppm explains 86 ms.
TEST(ChronySourceStats, TheClocksOwnErrorIsAllowedFor) {
  ChronyStatsSettings exact;
  exact.max_clock_error = 0;
  for (const bool is_exact : {true, false}) {
    ChronySourceStats stats(is_exact ? exact : ChronyStatsSettings{});
    for (int i = 0; i < 64; ++i) {
      stats.add(chrony_sample(i * 64, (i * 7 % 5) * 1e-6, i % 2 == 0 ? 50e-9 : -50e-9));
    }
    ChronySample late = chrony_sample(64 * 64 + 86400, 40e-3);
    late.offset_s = stats.predict_s(late.at_s);
    EXPECT_EQ(stats.is_good(late), !is_exact);
  }
}

TEST(ChronySourceStats, ASampleOfThePastRestarts) {
  ChronySourceStats stats = stats_with(10);
  stats.add(chrony_sample(100));
  EXPECT_EQ(stats.samples(), 1U);
  EXPECT_FALSE(stats.estimate());
}

TEST(ChronySourceStats, IsFiniteForAnySamples) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    boost::random::mt19937 engine(seed);
    boost::random::uniform_01<double> uniform;
    ChronySourceStats stats({});
    double at_s = 0;
    for (int i = 0; i < 300; ++i) {
      at_s += uniform(engine) < 0.1 ? 0 : std::exp(20 * uniform(engine) - 10);
      const double scale = std::exp(40 * uniform(engine) - 30);
      const ChronySample sample{at_s, (uniform(engine) - 0.5) * scale, uniform(engine) * scale,
                                uniform(engine) * 1e-3};
      if (stats.is_good(sample)) stats.add(sample);
      if (uniform(engine) < 0.3) stats.correct(at_s, stats.predict_s(at_s), 1e-6 * scale);
      ASSERT_TRUE(std::isfinite(stats.predict_s(at_s + 1))) << "seed " << seed;
      if (!stats.estimate()) continue;
      ASSERT_TRUE(std::isfinite(stats.estimate()->skew)) << "seed " << seed;
      ASSERT_TRUE(std::isfinite(stats.estimate()->offset_sd_s)) << "seed " << seed;
      ASSERT_GT(stats.estimate()->sd_s, 0) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace simbench

#include "sim/network/load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kLoadSeed = 99;
constexpr ComponentKey kLinkBursts("network: bursts");
constexpr scenarios::Burst kBursts{.rate_hz = 4, .duration_exponential_ms = 50, .latency_ms = 1};

TEST(BurstProcessTest, NoBurstsWithoutARate) {
  BurstProcess bursts({.rate_hz = 0, .duration_exponential_ms = 50, .latency_ms = 1}, kLoadSeed,
                      kLinkBursts, 0);
  for (int ms = -1000; ms < 1000; ++ms) EXPECT_FALSE(bursts.active(at_ms(ms)));
}

// Bursts that overlap make one: the process is busy for 1 - exp(-rate * duration) of the time.
TEST(BurstProcessTest, IsActiveForTheShareOfABusyServer) {
  BurstProcess bursts(kBursts, kLoadSeed, kLinkBursts, 0);
  constexpr int kSeconds = 4000;
  int active = 0;
  for (int i = 0; i < kSeconds * 100; ++i) active += bursts.active(at_ms(i * 10)) ? 1 : 0;
  const double expected = 1 - std::exp(-4 * 0.05);
  // About one independent sample in each cycle of idle and busy, some 0.3 s.
  EXPECT_NEAR(active / (kSeconds * 100.0), expected,
              5 * std::sqrt(expected * (1 - expected) / (kSeconds / 0.3)))
      << "seed " << kLoadSeed;
}

TEST(BurstProcessTest, BeginsAtItsRate) {
  BurstProcess bursts({.rate_hz = 0.5, .duration_exponential_ms = 10, .latency_ms = 1}, kLoadSeed,
                      kLinkBursts, 0);
  constexpr int kSeconds = 2000;
  int begins = 0;
  bool before = false;
  for (int ms = 0; ms < kSeconds * 1000; ++ms) {
    const bool now = bursts.active(at_ms(ms));
    if (now && !before) ++begins;
    before = now;
  }
  // Bursts shorter than the step of 1 ms are missed with a probability of about 1 / 20.
  const double expected = 0.5 * kSeconds * 0.95;
  EXPECT_NEAR(begins, expected, 5 * std::sqrt(expected)) << "seed " << kLoadSeed;
}

TEST(BurstProcessTest, DoesNotDependOnTheOrderOfQueries) {
  BurstProcess forwards(kBursts, kLoadSeed, kLinkBursts, 3);
  BurstProcess backwards(kBursts, kLoadSeed, kLinkBursts, 3);
  std::vector<bool> seen;
  for (int ms = -20'000; ms < 20'000; ms += 7) seen.push_back(forwards.active(at_ms(ms)));
  std::size_t i = seen.size();
  for (int ms = -20'000 + 7 * static_cast<int>(i - 1); i > 0; ms -= 7) {
    ASSERT_EQ(backwards.active(at_ms(ms)), seen[--i]) << ms;
  }
}

TEST(BurstProcessTest, LinksDiffer) {
  BurstProcess one(kBursts, kLoadSeed, kLinkBursts, 1);
  BurstProcess two(kBursts, kLoadSeed, kLinkBursts, 2);
  int different = 0;
  for (int ms = 0; ms < 20'000; ms += 7) {
    if (one.active(at_ms(ms)) != two.active(at_ms(ms))) ++different;
  }
  EXPECT_GT(different, 100);
}

// The permitted extremes: two billion bursts in a cell, which nobody samples.
TEST(BurstProcessTest, SoManyBurstsThatOneIsAlwaysUnderWay) {
  BurstProcess bursts({.rate_hz = 1e5, .duration_exponential_ms = 1e6, .latency_ms = 1}, kLoadSeed,
                      kLinkBursts, 0);
  for (int ms = -1000; ms < 1000; ++ms) EXPECT_TRUE(bursts.active(at_ms(ms)));
}

TEST(BurstProcessTest, JustFewEnoughBurstsAreSampledAndOneIsAlwaysUnderWay) {
  BurstProcess bursts({.rate_hz = 999, .duration_exponential_ms = 50, .latency_ms = 1}, kLoadSeed,
                      kLinkBursts, 0);
  for (int ms = -1000; ms < 1000; ++ms) EXPECT_TRUE(bursts.active(at_ms(ms)));
}

}  // namespace
}  // namespace simbench::sim

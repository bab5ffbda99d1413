#include <gmock/gmock.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>

#include "evaluation/statistics/paired.h"

namespace simbench::evaluation {
namespace {

// Differences 1, 2, 3, 4, 5: mean 3, standard error sqrt(2.5 / 5), t = 4.2426 with 4 degrees.
TEST(PairedT, AgreesWithATextbook) {
  const PairedT t = paired_t(pair_up({1, 1, 1, 1, 1}, {2, 3, 4, 5, 6}));
  EXPECT_NEAR(t.mean, 3, 1e-12);
  EXPECT_NEAR(t.mean_a, 1, 1e-12);
  EXPECT_NEAR(t.standard_error, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(t.p, 0.0132, 0.0001);  // R: t.test(1:5)
  const Estimate interval = t.interval(0.05);
  EXPECT_NEAR(interval.low, 1.0368, 0.0001);
  EXPECT_NEAR(interval.high, 4.9632, 0.0001);
}

TEST(PairedT, IsCertainOfWhatDoesNotScatter) {
  EXPECT_EQ(paired_t(pair_up({1, 2, 3}, {1, 2, 3})).p, 1);
  EXPECT_EQ(paired_t(pair_up({1, 2, 3}, {2, 3, 4})).p, 0);
  EXPECT_EQ(paired_t(pair_up({1}, {2})).p, 1);
  EXPECT_TRUE(std::isnan(paired_t(pair_up({1}, {2})).interval(0.05).low));
  EXPECT_EQ(paired_t({}).pairs, 0U);
}

// The worked example: 0.01 <= 0.05/4, 0.02 > 0.05/3, then no more.
TEST(Holm, StepsDownUntilTheFirstThatIsNotRejected) {
  const std::vector<HolmDecision> decisions = holm({0.03, 0.005, 0.02, 0.04});
  EXPECT_NEAR(decisions[1].adjusted_p, 0.02, 1e-12);
  EXPECT_NEAR(decisions[2].adjusted_p, 0.06, 1e-12);
  EXPECT_NEAR(decisions[0].adjusted_p, 0.06, 1e-12);
  EXPECT_NEAR(decisions[3].adjusted_p, 0.06, 1e-12);
  EXPECT_NEAR(decisions[1].error, 0.05 / 4, 1e-12);
  EXPECT_NEAR(decisions[2].error, 0.05 / 3, 1e-12);
  EXPECT_NEAR(decisions[0].error, 0.05 / 3, 1e-12);
  EXPECT_NEAR(decisions[3].error, 0.05 / 3, 1e-12);
  EXPECT_TRUE(holm({}).empty());
  EXPECT_EQ(holm({0.6, 0.9})[1].adjusted_p, 1);
}

TEST(Holm, AnIntervalExcludesZeroWhereThePValueIsRejected) {
  constexpr unsigned kSeed = 11;
  boost::random::mt19937_64 random(kSeed);
  boost::random::normal_distribution<double> normal;
  int rejected = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<PairedT> tests;
    std::vector<double> p;
    p.reserve(36);
    for (int metric = 0; metric < 5; ++metric) {
      PairedValues values;
      for (int i = 0; i < 32; ++i) values.pairs.push_back({0, normal(random) + 0.15 * metric});
      tests.push_back(paired_t(values));
      p.push_back(tests.back().p);
    }
    const std::vector<HolmDecision> decisions = holm(p);
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const Estimate interval = tests[i].interval(decisions[i].error);
      const bool excludes = interval.low > 0 || interval.high < 0;
      EXPECT_EQ(excludes, decisions[i].adjusted_p <= kFamilyError) << "seed " << kSeed;
      rejected += static_cast<int>(excludes);
    }
  }
  EXPECT_GT(rejected, 200);  // of metrics 3 and 4 most
  EXPECT_LT(rejected, 800);
}

TEST(Holm, RejectsSomethingByAccidentNoMoreOftenThanItSays) {
  boost::random::mt19937_64 random(5);
  boost::random::uniform_01<double> uniform;
  int families = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<double> p;
    p.reserve(36);
    for (int i = 0; i < 36; ++i) p.push_back(uniform(random));
    bool any = false;
    for (const HolmDecision& decision : holm(p)) any |= decision.adjusted_p <= kFamilyError;
    families += static_cast<int>(any);
  }
  EXPECT_NEAR(families / 4000.0, kFamilyError, 0.012);
}

}  // namespace
}  // namespace simbench::evaluation

#include "evaluation/scoring/set_counter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace simbench::evaluation {
namespace {

using ::testing::IsNan;

GlobalTime at(double ms) { return GlobalTime(from_ms(ms)); }

// Members by pulse, all stamped and arriving at 0; sources 0, 1, ...
std::vector<GatherFrame> members(const std::vector<std::int64_t>& pulses) {
  std::vector<GatherFrame> set;
  set.reserve(pulses.size());
  for (const std::int64_t pulse : pulses) {
    set.push_back({.source = static_cast<std::uint32_t>(set.size()), .tag = pulse});
  }
  return set;
}

class SetCounterTest : public testing::Test {
 protected:
  SeedScore score() const {
    SeedScore score;
    sets_.score(score);
    return score;
  }

  PulseTable table_{/*first_pulse=*/3, /*pulses=*/10, /*sources=*/4};
  SetCounter sets_{table_};
};

TEST_F(SetCounterTest, WithoutASetThereIsNoScore) {
  const SeedScore nothing = score();
  EXPECT_EQ(nothing.sets.emitted, 0);
  EXPECT_THAT(nothing.set_amd_ms, IsNan());
  EXPECT_THAT(nothing.set_absolute_error_ms, IsNan());
  EXPECT_THAT(nothing.emission_latency_ms, IsNan());
  EXPECT_THAT(nothing.emission_latency_max_ms, IsNan());
}

TEST_F(SetCounterTest, IndexErrorsAreAgainstTheMajority) {
  const struct {
    std::vector<std::int64_t> pulses;
    std::int64_t errors;
  } cases[] = {{{5, 5, 5, 5}, 0},    {{5, 5, 6, 5}, 1}, {{5, 6, 5, 6}, 2}, {{5, 6, 7, 8}, 3},
               {{-1, -1, -1, 5}, 3}, {{2, 2, 2, 3}, 1}, {{-1, 5, 5, 5}, 1}};
  std::int64_t expected = 0;
  for (const auto& [pulses, errors] : cases) {
    sets_.on_set(members(pulses));
    expected += errors;
    EXPECT_EQ(score().sets.index_errors, expected);
  }
  EXPECT_EQ(score().sets.emitted, 7);
  EXPECT_EQ(score().sets.pure, 1);
}

TEST_F(SetCounterTest, SetsWithoutAnEvaluatedMemberDoNotCount) {
  sets_.on_set(members({2, 2, 2, 2}));
  sets_.on_set(members({13, -1, 2, 13}));
  sets_.on_partial_set(members({2, 13}));
  sets_.on_partial_set(members({2, 3}));
  EXPECT_EQ(score().sets.emitted, 0);
  EXPECT_EQ(score().sets.index_errors, 0);
  EXPECT_EQ(score().sets.partial, 1);
}

TEST_F(SetCounterTest, AmdIsTheMeanRangeOfTheSets) {
  std::vector<GatherFrame> set = members({5, 5, 5, 5});
  set[1].stamp = at(-1);
  set[2].stamp = at(2);
  sets_.on_set(set);
  sets_.on_set(members({6, 6, 6, 6}));
  EXPECT_DOUBLE_EQ(score().set_amd_ms, 1.5);
  EXPECT_THAT(score().set_absolute_error_ms, IsNan()) << "there is no truth";
}

TEST_F(SetCounterTest, LatencyCountsFromTheLastMember) {
  std::vector<GatherFrame> set = members({5, 5, 5, 5});
  for (std::size_t i = 0; i < 4; ++i) set[i].arrival = at(10 + static_cast<double>(i));
  sets_.advance_to(at(13));  // the last member itself
  sets_.on_set(set);
  EXPECT_DOUBLE_EQ(score().emission_latency_ms, 0);
  sets_.advance_to(at(35));
  sets_.on_set(set);
  EXPECT_DOUBLE_EQ(score().emission_latency_ms, 11);
  EXPECT_DOUBLE_EQ(score().emission_latency_max_ms, 22);
}

TEST_F(SetCounterTest, AbsoluteErrorIsAgainstTheReferenceOfEachMembersPulse) {
  for (std::uint32_t source = 0; source < 4; ++source) {
    for (const std::int64_t pulse : {5, 6}) {
      FrameTruth truth;
      truth.pulse = pulse;
      truth.reference = HostTime(from_ms(1000 + 20 * static_cast<double>(pulse) + source));
      table_.store_truth(pulse, source, truth);
    }
  }
  std::vector<GatherFrame> set = members({5, 5, 6, 2});  // the last is not evaluated
  set[0].stamp = at(100 + 3);
  set[1].stamp = at(101 - 1);
  set[2].stamp = at(122 + 5);
  sets_.set_shift(from_ms(1000));
  sets_.on_set(set);
  EXPECT_DOUBLE_EQ(score().set_absolute_error_ms, 3);
}

}  // namespace
}  // namespace simbench::evaluation

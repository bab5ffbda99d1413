#include "reports/recordings/stack_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace simbench::reports {
namespace {

// 0, 1, ... 999, in an order in which neighbours have nothing to do with each other.
std::vector<double> shuffled_thousand() {
  std::vector<double> values;
  values.reserve(1000);
  for (int i = 0; i < 1000; ++i) values.push_back((i * 619) % 1000);
  return values;
}

TEST(StackLaw, TheTableHasEquallySpacedQuantilesOfAllButTheLongest) {
  const StackLaw law = stack_law(shuffled_thousand());
  ASSERT_EQ(law.quantiles_us.size(), kStackQuantiles);
  EXPECT_EQ(law.messages, 1000u);
  EXPECT_DOUBLE_EQ(law.quantiles_us.front(), 0);
  EXPECT_DOUBLE_EQ(law.quantiles_us[16], 497);
  EXPECT_DOUBLE_EQ(law.quantiles_us.back(), 994);  // the longest five are spikes
  EXPECT_DOUBLE_EQ(law.longest_us, 999);
  EXPECT_DOUBLE_EQ(law.mean_us, 499.5);
}

TEST(StackLaw, SpikesHaveTheMeanOfTheLongest) {
  const StackLaw law = stack_law(shuffled_thousand());
  EXPECT_DOUBLE_EQ(law.spike_probability, kSpikeShare);
  // On top of a table of mean 497, half of spike_max_us in the mean.
  EXPECT_NEAR(497 + law.spike_max_us / 2, 997, 1e-9);
}

TEST(StackLaw, FewMessagesHaveNoSpikes) {
  const StackLaw law = stack_law(std::vector<double>(kStackQuantiles, 3.0));
  EXPECT_EQ(law.spike_probability, 0);
  EXPECT_EQ(law.spike_max_us, 0);
  EXPECT_EQ(law.quantiles_us.back(), 3);
}

TEST(StackLaw, NeighboursOfASlowCourseAreCorrelated) {
  std::vector<double> wave(1000);
  for (std::size_t i = 0; i < wave.size(); ++i) wave[i] = std::sin(0.01 * static_cast<double>(i));
  EXPECT_GT(stack_law(wave).correlation_with_next, 0.95);
  EXPECT_LT(std::abs(stack_law(shuffled_thousand()).correlation_with_next), 0.5);
}

TEST(StackStudy, NamesConditionsAndParts) {
  const StackStudy study{.date = "2026-01-01",
                         .machine = "m",
                         .conditions = {{.name = "idle",
                                         .busy_threads = 0,
                                         .parts = {{"wake_up", stack_law(shuffled_thousand())}}}}};
  const auto json = nlohmann::json::parse(stack_study_json(study));
  EXPECT_EQ(json["conditions"][0]["name"], "idle");
  const auto& law = json["conditions"][0]["wake_up"];
  EXPECT_EQ(law["quantiles_us"].size(), kStackQuantiles);
  EXPECT_TRUE(std::is_sorted(law["quantiles_us"].begin(), law["quantiles_us"].end()));
}

}  // namespace
}  // namespace simbench::reports

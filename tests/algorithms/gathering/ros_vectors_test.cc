// Algorithm 3 on the inputs of the ROS ApproximateTime tests, read in place where they are present.
//
// Another policy, so not all sets agree; reference/gathering.md section 2 lists in which they do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/gathering/yoon2021.h"
#include "tests/algorithms/gathering/collected_sets.h"

namespace simbench {
namespace {

using Sets = std::vector<std::vector<double>>;

const std::string kVectors = SIMBENCH_SOURCE_DIR "/../shared/vectors/ros_approximate_time.json";

Sets gathered(const nlohmann::json& input, std::uint32_t topics) {
  const auto gatherer = make_yoon2021_gatherer(
      {.sources = topics, .period = from_ms(3000), .interval = from_ms(1500)});
  CollectedSets out;
  for (const nlohmann::json& message : input) {
    gatherer->push(frame_at(message[1].get<std::uint32_t>(), message[0].get<double>() * 1000, 0),
                   out);
  }
  Sets sets;
  for (const std::vector<GatherFrame>& set : out.sets) {
    sets.emplace_back();
    for (const GatherFrame& frame : set) {
      sets.back().push_back(to_seconds(frame.stamp.time_since_epoch()));
    }
  }
  return sets;
}

TEST(RosVectors, AlgorithmThreeAgreesInFiveOfFourteen) {
  std::ifstream file(kVectors);
  if (!file) GTEST_SKIP() << "not run: " << kVectors << " is absent";
  const nlohmann::json cases = nlohmann::json::parse(file).at("cases");
  ASSERT_EQ(cases.size(), 14U);
  const std::array<std::string, 5> agreeing = {"ExactMatch", "ImperfectMatch", "DoublePublish",
                                               "RateBound_2", "RateBoundAll_2"};
  for (const nlohmann::json& entry : cases) {
    const std::string name = entry.at("name");
    const Sets sets = gathered(entry.at("input_arrival_order"), entry.at("topics"));
    const Sets expected = entry.at("expected_sets_in_order");
    const bool agrees = std::ranges::count(agreeing, name) > 0;
    EXPECT_EQ(sets == expected, agrees) << name;
  }
}

}  // namespace
}  // namespace simbench

// All policies in one world: four cameras at 45 FPS, as in docs/reference/gathering.md section 4.
//
// Expected precision and recall are that page's, within what one other seed can differ by; beside
// them what must hold exactly: no policy finds more right sets than the oracle.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "algorithms/registry.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/algorithms/gathering/gathering_world.h"

namespace simbench {
namespace {

struct Found {
  double precision = 0;
  double recall = 0;
};

std::int64_t complete_pulses(const std::vector<GatherFrame>& frames, std::uint32_t sources) {
  std::map<std::int64_t, std::uint32_t> members;
  for (const GatherFrame& frame : frames) ++members[frame.tag];
  std::int64_t complete = 0;
  for (const auto& [pulse, count] : members) complete += count == sources ? 1 : 0;
  return complete;
}

Found gather(const std::string& name, double sigma_ms, double drop) {
  const GatheringWorld world = {.sources = 4,
                                .pulses = 3000,
                                .period_ms = 1000.0 / 45,
                                .sigma_ms = sigma_ms,
                                .drop = drop,
                                .delay_max_ms = 3};
  const std::vector<GatherFrame> frames = frames_of(world, 7);
  const GatheringEntry& entry = *find_algorithm<GatheringEntry>(name);
  const auto gatherer = entry.make(check_parameters(entry.info.parameters, {}),
                                   {.sources = world.sources,
                                    .period = from_ms(world.period_ms),
                                    .interval = from_ms(world.period_ms / 2)});
  CollectedSets out;
  for (const GatherFrame& frame : frames) gatherer->push(frame, out);
  const auto right = static_cast<double>(out.pure());
  return {right / static_cast<double>(out.sets.size()),
          right / static_cast<double>(complete_pulses(frames, world.sources))};
}

struct PolicyExpectation {
  std::string name;
  double sigma_ms;
  double drop;
  double precision;
  double recall;
  double tolerance;
};

TEST(GatheringPolicies, PrecisionAndRecallAreTheReferences) {
  const PolicyExpectation expectations[] = {
      {"yoon2021", 0.05, 0.1, 1, 1, 1e-9},
      {"yoon2021", 3, 0, 0.9997, 0.9570, 0.012},
      {"yoon2021", 3, 0.1, 0.9995, 0.9512, 0.012},
      {"epsilon", 0.05, 0.1, 1, 1, 1e-9},
      {"epsilon", 3, 0.02, 0.9996, 0.9447, 0.012},
      {"approximate_time", 0.05, 0, 1, 0.9997, 0.0004},
      {"approximate_time", 0.05, 0.02, 0.9942, 0.9996, 0.004},
      {"approximate_time", 0.05, 0.1, 0.9050, 0.9990, 0.015},
      {"approximate_time", 3, 0.1, 0.9023, 0.9728, 0.015},
      {"approximate_time_bounded", 0.05, 0.1, 1, 1, 1e-9},
      {"approximate_time_bounded", 3, 0, 1, 0.9573, 0.012},
      {"approximate_time_bounded", 3, 0.1, 0.9995, 0.9512, 0.012},
      {"phase_binning", 1, 0.1, 1, 1, 1e-9},
      {"phase_binning", 3, 0, 0.9990, 0.9977, 0.003},
      {"phase_binning", 3, 0.1, 0.9995, 0.9985, 0.003},
  };
  for (const PolicyExpectation& expected : expectations) {
    const Found found = gather(expected.name, expected.sigma_ms, expected.drop);
    EXPECT_NEAR(found.precision, expected.precision, expected.tolerance)
        << expected.name << ", sigma " << expected.sigma_ms << ", drop " << expected.drop;
    EXPECT_NEAR(found.recall, expected.recall, expected.tolerance)
        << expected.name << ", sigma " << expected.sigma_ms << ", drop " << expected.drop;
  }
}

TEST(GatheringPolicies, TheOracleIsPerfectWhateverTheStamps) {
  const Found found = gather("oracle", 40, 0.3);
  EXPECT_EQ(found.precision, 1);
  EXPECT_EQ(found.recall, 1);
}

TEST(GatheringPolicies, TheOracleGivesUpFramesOfNoPulse) {
  const GatheringEntry& entry = *find_algorithm<GatheringEntry>("oracle");
  const auto gatherer = entry.make({}, {.sources = 2});
  CollectedSets out;
  gatherer->push(frame_at(0, 0, -1), out);
  gatherer->push(frame_at(1, 0, -1), out);
  EXPECT_TRUE(out.sets.empty());
  EXPECT_EQ(gatherer->discarded(), 2U);
}

}  // namespace
}  // namespace simbench

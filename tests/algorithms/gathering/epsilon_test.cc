#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/algorithms/gathering/gathering_world.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

GatheringSetup epsilon_setup(std::uint32_t sources, double epsilon_ms,
                             std::uint32_t queue_limit = 10) {
  return {.sources = sources,
          .period = from_ms(22),
          .interval = from_ms(epsilon_ms),
          .queue_limit = queue_limit};
}

TEST(Epsilon, EpsilonItselfIsAllowed) {
  for (const double range_ms : {11.0, 11.000001}) {
    const auto gatherer = make_epsilon_gatherer(epsilon_setup(2, 11));
    CollectedSets out;
    gatherer->push(frame_at(0, 0, 0), out);
    gatherer->push(frame_at(1, range_ms, 0), out);
    EXPECT_EQ(out.sets.size(), range_ms > 11 ? 0U : 1U) << range_ms;
    EXPECT_EQ(gatherer->discarded(), range_ms > 11 ? 1U : 0U) << range_ms;
  }
}

TEST(Epsilon, GivesUpAllThatLieWithTheEarliest) {
  const auto gatherer = make_epsilon_gatherer(epsilon_setup(3, 11));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(1, 10, 0), out);  // Algorithm 3 would keep this one for 18 ms
  gatherer->push(frame_at(2, 18, 0), out);
  gatherer->push(frame_at(0, 17, 1), out);
  EXPECT_THAT(out.sets, IsEmpty());
  EXPECT_EQ(gatherer->discarded(), 2U);
  gatherer->push(frame_at(1, 20, 1), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(1, 1, 0)));
}

TEST(Epsilon, SparesTheFrameBehindOneThatIsGivenUp) {
  const auto gatherer = make_epsilon_gatherer(epsilon_setup(2, 5));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(0, 4, 1), out);
  gatherer->push(frame_at(1, 8, 0), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(1, 0)));
}

TEST(Epsilon, EqualsTheNaiveImplementation) {
  std::size_t sets = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const GatheringWorld world = {.sources = 1 + seed % 7,
                                  .sigma_ms = 1.5 * (seed % 6),
                                  .drop = 0.08 * (seed % 4),
                                  .delay_max_ms = 25.0 * (seed % 5),
                                  .quantum_ms = seed % 3 == 0 ? 4.0 : 0.0};
    const GatheringSetup setup = epsilon_setup(world.sources, seed % 12, 1 + seed % 9);
    const auto gatherer = make_epsilon_gatherer(setup);
    CollectedSets out;
    CollectedSets expected;
    std::vector<std::deque<GatherFrame>> queues(world.sources);
    std::uint64_t discarded = 0;
    for (const GatherFrame& frame : nonempty(frames_of(world, seed))) {
      gatherer->push(frame, out);
      queues[frame.source].push_back(frame);
      if (queues[frame.source].size() > setup.queue_limit.value()) {
        queues[frame.source].pop_front();
        ++discarded;
      }
      while (std::ranges::none_of(queues, [](const auto& queue) { return queue.empty(); })) {
        std::vector<GatherFrame> fronts;
        fronts.reserve(queues.size());
        for (const auto& queue : queues) fronts.push_back(queue.front());
        const GlobalTime limit =
            std::ranges::min_element(fronts, {}, &GatherFrame::stamp)->stamp + setup.interval;
        const bool fits =
            std::ranges::all_of(fronts, [&](const GatherFrame& f) { return f.stamp <= limit; });
        if (fits) expected.on_set(fronts);
        for (std::size_t i = 0; i < fronts.size(); ++i) {
          if (fronts[i].stamp > limit) continue;
          queues[i].pop_front();
          discarded += fits ? 0 : 1;
        }
      }
      ASSERT_EQ(gatherer->discarded(), discarded) << "seed " << seed;
    }
    ASSERT_EQ(out.tags(), expected.tags()) << "seed " << seed;
    sets += out.sets.size();
  }
  EXPECT_GT(sets, 5'000U);
}

}  // namespace
}  // namespace simbench

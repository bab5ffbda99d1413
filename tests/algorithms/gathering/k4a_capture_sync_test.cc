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

TEST(K4a, TheWindowLeansToTheLateSide) {
  const struct {
    double offset_ms;
    bool pairs;
  } cases[] = {{-5.000001, false}, {-5, true}, {0, true}, {15, true}, {15.000001, false}};
  for (const auto& [offset_ms, pairs] : cases) {
    const auto gatherer = make_k4a_gatherer(short_setup(2));
    CollectedSets out;
    gatherer->push(frame_at(0, 100, 0), out);
    gatherer->push(frame_at(1, 100 + offset_ms, 0), out);
    EXPECT_EQ(out.sets.size(), pairs ? 1U : 0U) << offset_ms;
    EXPECT_EQ(gatherer->discarded(), pairs ? 0U : 1U) << offset_ms;
  }
}

TEST(K4a, TheDelayMovesTheWindow) {
  const auto gatherer = make_k4a_gatherer(short_setup(2), from_ms(10));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(1, 4, 1), out);   // before the window
  gatherer->push(frame_at(1, 24, 2), out);  // within 5 to 25 ms
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0, 2)));
}

TEST(K4a, EveryOtherSourceMustBeInItsWindow) {
  const auto gatherer = make_k4a_gatherer(short_setup(3));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(1, 1, 0), out);
  gatherer->push(frame_at(2, 20, 1), out);  // lost its frame of pulse 0: beyond the window
  EXPECT_EQ(gatherer->discarded(), 1U) << "the reference";
  gatherer->push(frame_at(0, 20, 1), out);  // now the frame of source 1 is too early
  EXPECT_EQ(gatherer->discarded(), 2U);
  gatherer->push(frame_at(1, 21, 1), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(1, 1, 1)));
}

TEST(K4a, NoiseOfAQuarterPeriodPairsNeighbours) {
  const auto gatherer = make_k4a_gatherer(short_setup(2));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 20; ++pulse) {
    gatherer->push(frame_at(0, static_cast<double>(pulse) * kShortPeriodMs, pulse), out);
    gatherer->push(frame_at(1, static_cast<double>(pulse) * kShortPeriodMs - 6, pulse), out);
  }
  EXPECT_EQ(out.pure(), 0);
  EXPECT_EQ(out.sets.size(), 19U);
}

// All fronts at once, as soon as there are all: which source waits for which makes no difference
// while no queue overflows.
TEST(K4a, EqualsTheNaiveImplementation) {
  std::size_t sets = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    const GatheringWorld world = {.sources = 1 + seed % 6,
                                  .period_ms = kShortPeriodMs,
                                  .sigma_ms = 0.8 * (seed % 5),
                                  .drop = 0.05 * (seed % 5),
                                  .delay_max_ms = 25.0 * (seed % 4)};
    const auto gatherer = make_k4a_gatherer(short_setup(world.sources, 100));
    CollectedSets out;
    CollectedSets expected;
    std::vector<std::deque<GatherFrame>> queues(world.sources);
    const auto complete = [&] {
      return std::ranges::none_of(queues, [](const auto& queue) { return queue.empty(); });
    };
    for (const GatherFrame& frame : nonempty(frames_of(world, seed))) {
      gatherer->push(frame, out);
      queues[frame.source].push_back(frame);
      while (complete()) {
        const GlobalTime begin = queues[0].front().stamp - from_ms(kShortPeriodMs / 4);
        std::vector<GatherFrame> fronts;
        fronts.reserve(queues.size());
        for (const auto& queue : queues) fronts.push_back(queue.front());
        const auto late = [&](const GatherFrame& f) {
          return f.source > 0 && f.stamp > begin + from_ms(kShortPeriodMs);
        };
        const auto early = [&](const GatherFrame& f) { return f.source > 0 && f.stamp < begin; };
        if (const auto found = std::ranges::find_if(fronts, early); found != fronts.end()) {
          queues[found->source].pop_front();
        } else if (std::ranges::any_of(fronts, late)) {
          queues[0].pop_front();
        } else {
          expected.on_set(fronts);
          for (auto& queue : queues) queue.pop_front();
        }
      }
    }
    ASSERT_EQ(out.tags(), expected.tags()) << "seed " << seed;
    sets += out.sets.size();
  }
  EXPECT_GT(sets, 5'000U);
}

}  // namespace
}  // namespace simbench

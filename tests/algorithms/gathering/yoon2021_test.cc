// Algorithm 3 by example: what it emits, what it gives up, and its documented defects.
#include <gmock/gmock.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/gathering/fronts.h"
#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two sources over `pulses` pulses, the second constantly `offset_ms` ahead of its true time.
CollectedSets with_offset(double offset_ms, std::int64_t pulses) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(2));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < pulses; ++pulse) {
    const double at_ms = static_cast<double>(pulse) * kPeriodMs;
    gatherer->push(frame_at(0, at_ms, pulse), out);
    gatherer->push(frame_at(1, at_ms + offset_ms, pulse), out);
  }
  return out;
}

TEST(Yoon2021Gatherer, EmitsWhenTheLastSourceDelivers) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(3));
  CollectedSets out;
  gatherer->push(frame_at(2, 0.5, 12), out);
  gatherer->push(frame_at(0, 0, 10), out);
  EXPECT_THAT(out.sets, IsEmpty());
  gatherer->push(frame_at(1, 1, 11), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(10, 11, 12)));
  EXPECT_EQ(out.sets[0][1].source, 1U);
  EXPECT_EQ(out.sets[0][1].stamp, GlobalTime(from_ms(1)));
  EXPECT_EQ(gatherer->discarded(), 0U);
}

TEST(Yoon2021Gatherer, ASourceDeliveringAloneWaits) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(2));
  CollectedSets out;
  for (std::int64_t i = 0; i < 10; ++i) {
    gatherer->push(frame_at(0, static_cast<double>(i) * kPeriodMs, i), out);
  }
  EXPECT_THAT(out.sets, IsEmpty());
  for (std::int64_t i = 0; i < 10; ++i) {
    gatherer->push(frame_at(1, static_cast<double>(i) * kPeriodMs, i), out);
    EXPECT_EQ(out.pure(), i + 1);
  }
}

TEST(Yoon2021Gatherer, RangeMustBeLessThanTheInterval) {
  for (const double range_ms : {10.999999, 11.0}) {
    const auto gatherer = make_yoon2021_gatherer(setup_of(2));
    CollectedSets out;
    gatherer->push(frame_at(0, range_ms, 0), out);
    gatherer->push(frame_at(1, 0, 1), out);
    EXPECT_EQ(out.sets.size(), range_ms < 11 ? 1U : 0U) << range_ms;
    EXPECT_EQ(gatherer->discarded(), range_ms < 11 ? 0U : 1U) << range_ms;
  }
}

TEST(Yoon2021Gatherer, GivesUpTheEarliestFront) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(2));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(0, 22, 1), out);
  gatherer->push(frame_at(1, 22, 2), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(1, 2)));
  EXPECT_EQ(gatherer->discarded(), 1U);
}

TEST(Yoon2021Gatherer, OfEqualFrontsTheLowestSourceGoesFirst) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(3));
  CollectedSets out;
  // Sources 1 and 2 are both at 0. Were 2 given up first, 1's next frame would wait behind its
  // front; as 1 goes first, 2's front is still there and goes when 1 delivers again.
  gatherer->push(frame_at(2, 0, 20), out);
  gatherer->push(frame_at(0, 50, 0), out);
  gatherer->push(frame_at(1, 0, 10), out);
  EXPECT_EQ(gatherer->discarded(), 1U);
  gatherer->push(frame_at(2, 50, 21), out);  // behind 2's front: source 1 is the empty one
  EXPECT_THAT(out.sets, IsEmpty());
  gatherer->push(frame_at(1, 50, 11), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0, 11, 21)));
  EXPECT_EQ(gatherer->discarded(), 2U);
}

TEST(Yoon2021Gatherer, ADroppedFrameCostsItsPulseAndNoMore) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(18));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 100; ++pulse) {
    for (std::uint32_t source = 0; source < 18; ++source) {
      if (pulse == 40 && source == 7) continue;
      gatherer->push(frame_at(source, static_cast<double>(pulse) * kPeriodMs, pulse), out);
    }
    EXPECT_EQ(out.pure(), pulse < 40 ? pulse + 1 : pulse);
  }
  EXPECT_EQ(gatherer->discarded(), 17U);
}

TEST(Yoon2021Gatherer, OverflowDropsTheOldestAndRecovers) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(2, 4));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 10; ++pulse) {
    gatherer->push(frame_at(0, static_cast<double>(pulse) * kPeriodMs, pulse), out);
  }
  EXPECT_EQ(gatherer->discarded(), 6U);
  for (std::int64_t pulse = 0; pulse < 10; ++pulse) {  // the other comes back late
    gatherer->push(frame_at(1, static_cast<double>(pulse) * kPeriodMs, pulse), out);
  }
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(6, 6), ElementsAre(7, 7), ElementsAre(8, 8),
                                      ElementsAre(9, 9)));
  EXPECT_EQ(gatherer->discarded(), 12U);
}

TEST(Yoon2021Gatherer, WithoutALimitNothingIsDropped) {
  constexpr std::int64_t kPulses = 10 * std::int64_t{FrontMatcher::kFirstQueue};
  for (const std::optional<std::uint32_t> limit : {std::optional<std::uint32_t>(), {100}}) {
    GatheringSetup setup = setup_of(3);
    setup.queue_limit = limit;
    const auto gatherer = make_yoon2021_gatherer(setup);
    CollectedSets out;
    for (const std::uint32_t source : {0U, 2U, 1U}) {  // the last one delivers when all is over
      for (std::int64_t pulse = 0; pulse < kPulses; ++pulse) {
        gatherer->push(frame_at(source, static_cast<double>(pulse) * kPeriodMs, pulse), out);
      }
    }
    EXPECT_EQ(out.pure(), limit ? 100 : kPulses);
    EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
    EXPECT_EQ(gatherer->discarded(), limit ? 3U * (kPulses - 100) : 0U);
  }
}

// A host whose clock is a hundred periods behind: the next stamps of its camera are as old as what
// waits longest.
TEST(Yoon2021GathererDefect, AnOffsetOfManyPeriodsGivesWrongSetsSilently) {
  GatheringSetup setup = setup_of(2);
  setup.queue_limit.reset();
  const auto gatherer = make_yoon2021_gatherer(setup);
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 300; ++pulse) {
    const double at_ms = static_cast<double>(pulse) * kPeriodMs;
    gatherer->push(frame_at(0, at_ms, pulse), out);
    gatherer->push(frame_at(1, at_ms - 100 * kPeriodMs, pulse), out);
  }
  EXPECT_EQ(out.sets.size(), 200U);
  for (const std::vector<std::int64_t>& set : out.tags()) EXPECT_EQ(set[1], set[0] + 100);
}

TEST(Yoon2021Gatherer, QueueOfOneFrame) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(2, 1));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(0, 22, 1), out);
  gatherer->push(frame_at(1, 22, 2), out);
  gatherer->push(frame_at(1, 44, 3), out);
  gatherer->push(frame_at(0, 44, 4), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(1, 2), ElementsAre(4, 3)));
  EXPECT_EQ(gatherer->discarded(), 1U);
}

TEST(Yoon2021Gatherer, OneSourceIsASetPerFrame) {
  const auto gatherer = make_yoon2021_gatherer(setup_of(1));
  CollectedSets out;
  gatherer->push(frame_at(0, 5, 0), out);
  gatherer->push(frame_at(0, 4, 1), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0), ElementsAre(1)));
}

// Defects of Algorithm 3, as docs/reference/paper.md section 5 derives them.

TEST(Yoon2021GathererDefect, ConstantOffsetBeyondTheIntervalGivesNoSet) {
  EXPECT_EQ(with_offset(10.9, 100).pure(), 100);
  EXPECT_THAT(with_offset(11, 100).sets, IsEmpty());  // half a period: as far from both
  // Just beyond half a period the neighbouring pulse is nearer than the interval.
  EXPECT_EQ(with_offset(11.1, 100).sets.size(), 99U);
  EXPECT_EQ(with_offset(11.1, 100).pure(), 0);
}

TEST(Yoon2021GathererDefect, NarrowIntervalGivesNoSetForMostOffsets) {
  GatheringSetup setup = setup_of(2);
  setup.interval = from_ms(5);
  for (const double offset_ms : {5.0, 8.0, 11.0, 14.0, 17.0}) {
    const auto gatherer = make_yoon2021_gatherer(setup);
    CollectedSets out;
    for (std::int64_t pulse = 0; pulse < 100; ++pulse) {
      const double at_ms = static_cast<double>(pulse) * kPeriodMs;
      gatherer->push(frame_at(0, at_ms, pulse), out);
      gatherer->push(frame_at(1, at_ms + offset_ms, pulse), out);
    }
    EXPECT_THAT(out.sets, IsEmpty()) << offset_ms;
    EXPECT_EQ(gatherer->discarded(), 199U) << offset_ms;
  }
}

TEST(Yoon2021GathererDefect, OffsetOfAPeriodGivesWrongSetsSilently) {
  const CollectedSets out = with_offset(kPeriodMs, 100);
  EXPECT_EQ(out.sets.size(), 99U);
  EXPECT_EQ(out.pure(), 0);
  for (const std::vector<std::int64_t>& set : out.tags()) EXPECT_EQ(set[0], set[1] + 1);
}

TEST(Yoon2021GathererDeathTest, ContractIsChecked) {
  EXPECT_DEATH(make_yoon2021_gatherer(setup_of(0)), "needs a source");
  EXPECT_DEATH(make_yoon2021_gatherer({.sources = 1, .period = from_ms(1)}), "interval of 0");
  CollectedSets out;
  EXPECT_DEATH(make_yoon2021_gatherer(setup_of(2))->push(frame_at(2, 0, 0), out), "does not exist");
}

}  // namespace
}  // namespace simbench

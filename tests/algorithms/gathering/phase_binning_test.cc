#include <gmock/gmock.h>

#include <cstdint>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/algorithms/gathering/gathering_world.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;

// Two sources, `apart_ms` from each other, over `pulses` pulses of `period_ms`.
CollectedSets two_sources(double apart_ms, double period_ms, std::int64_t pulses) {
  const auto gatherer = make_phase_binning_gatherer(short_setup(2));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < pulses; ++pulse) {
    const double at_ms = static_cast<double>(pulse) * period_ms;
    gatherer->push(frame_at(0, at_ms, pulse), out);
    gatherer->push(frame_at(1, at_ms + apart_ms, pulse), out);
  }
  return out;
}

TEST(PhaseBinning, HalfAPeriodFromTheMeanIsAllowed) {
  EXPECT_EQ(two_sources(9.9, kShortPeriodMs, 100).pure(), 100);
  EXPECT_EQ(two_sources(-9.9, kShortPeriodMs, 100).pure(), 100);
}

TEST(PhaseBinning, AnOffsetOfAPeriodGivesWrongSetsSilently) {
  const CollectedSets out = two_sources(kShortPeriodMs, kShortPeriodMs, 100);
  EXPECT_EQ(out.sets.size(), 99U);
  EXPECT_EQ(out.pure(), 0);
}

TEST(PhaseBinning, APeriodThatIsALittleWrongNeverAddsUp) {
  // 500 ppm over 20,000 pulses is ten periods.
  EXPECT_EQ(two_sources(3, kShortPeriodMs * 1.0005, 20'000).pure(), 20'000);
  EXPECT_EQ(two_sources(3, kShortPeriodMs * 0.9995, 20'000).pure(), 20'000);
}

TEST(PhaseBinning, ThePhaseForgetsAWrongBeginning) {
  const auto gatherer = make_phase_binning_gatherer(short_setup(2));
  CollectedSets out;
  gatherer->push(frame_at(0, -9, 0), out);  // the first frame is off by nearly half a period
  for (std::int64_t pulse = 1; pulse < 100; ++pulse) {
    gatherer->push(frame_at(0, static_cast<double>(pulse) * kShortPeriodMs, pulse), out);
    gatherer->push(frame_at(1, static_cast<double>(pulse) * kShortPeriodMs + 6, pulse), out);
  }
  EXPECT_GE(out.pure(), 98);
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
}

TEST(PhaseBinning, ALostFrameCostsItsSlotAndNoMore) {
  const auto gatherer = make_phase_binning_gatherer(short_setup(3));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 100; ++pulse) {
    for (std::uint32_t source = 0; source < 3; ++source) {
      if (pulse == 40 && source == 1) continue;
      gatherer->push(frame_at(source, static_cast<double>(pulse) * kShortPeriodMs, pulse), out);
    }
  }
  EXPECT_EQ(out.pure(), 99);
  EXPECT_EQ(gatherer->discarded(), 2U);
}

TEST(PhaseBinning, TheFirstFrameOfASourceInASlotCounts) {
  const auto gatherer = make_phase_binning_gatherer(short_setup(2));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 10), out);
  gatherer->push(frame_at(0, 1, 11), out);
  EXPECT_EQ(gatherer->discarded(), 1U);
  gatherer->push(frame_at(1, 0, 12), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(10, 12)));
}

TEST(PhaseBinning, TooLateForItsSlot) {
  const auto gatherer = make_phase_binning_gatherer(short_setup(2));
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(0, 20, 1), out);
  gatherer->push(frame_at(1, 20, 1), out);
  EXPECT_EQ(gatherer->discarded(), 1U) << "the slot before the set";
  gatherer->push(frame_at(1, 0, 0), out);
  EXPECT_EQ(gatherer->discarded(), 2U);
  EXPECT_EQ(out.sets.size(), 1U);
}

TEST(PhaseBinning, ASlotFarBehindGivesItsPlaceAway) {
  const auto gatherer = make_phase_binning_gatherer(short_setup(2, 4));
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 6; ++pulse) {
    gatherer->push(frame_at(0, static_cast<double>(pulse) * kShortPeriodMs, pulse), out);
  }
  EXPECT_EQ(gatherer->discarded(), 2U);
  gatherer->push(frame_at(1, 2 * kShortPeriodMs, 2), out);
  EXPECT_EQ(out.pure(), 1);
}

TEST(PhaseBinning, WithoutDecayThePhaseIsTheLastStamp) {
  // Each frame moves the grid to itself: a walk of 6 ms per frame is followed.
  const auto gatherer = make_phase_binning_gatherer(short_setup(1), 0);
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 50; ++pulse) {
    gatherer->push(frame_at(0, static_cast<double>(pulse) * (kShortPeriodMs + 6), pulse), out);
  }
  EXPECT_EQ(out.sets.size(), 50U);
}

TEST(PhaseBinningDeathTest, ContractIsChecked) {
  EXPECT_DEATH(make_phase_binning_gatherer(short_setup(0)), "needs a source");
  EXPECT_DEATH(make_phase_binning_gatherer(short_setup(2), 1), "weighs less");
  EXPECT_DEATH(make_phase_binning_gatherer({.sources = 1}), "a microsecond or more");
}

}  // namespace
}  // namespace simbench

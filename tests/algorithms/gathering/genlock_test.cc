#include <gmock/gmock.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;
using Variant = GenlockOrder::Variant;

constexpr double kExactPeriodMs = 1000.0 / 45;

std::unique_ptr<Gatherer> gatherer_for(std::uint32_t sources, Variant variant,
                                       std::uint32_t queue_limit = 64) {
  return make_genlock_gatherer(
      {.sources = sources, .period = from_ms(kExactPeriodMs), .queue_limit = queue_limit}, variant);
}

// A frame of a camera with its own clock; the global stamp is of no use.
GatherFrame frame_of(std::uint32_t source, std::int64_t pulse, double period_error = 575e-6) {
  const double zero_us = 1e9 * (source + 1);
  // The cameras' clocks differ by 10 ppm from one to the next.
  const double rate = (1 - period_error) * (1 + 10e-6 * source);
  const double us = zero_us + static_cast<double>(pulse) * kExactPeriodMs * 1e3 * rate;
  return {.source = source,
          .stamp = GlobalTime(from_ms(-5.0 * static_cast<double>(pulse))),
          .sensor = DeviceTime(Microseconds(std::llround(us))),
          .tag = pulse};
}

TEST(GenlockGatherer, CompletesAnIndexWithItsLastFrame) {
  const auto gatherer = gatherer_for(3, Variant::kReanchored);
  CollectedSets out;
  for (const std::uint32_t source : {2U, 0U}) gatherer->push(frame_of(source, 0), out);
  EXPECT_TRUE(out.sets.empty());
  gatherer->push(frame_of(1, 0), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0, 0, 0)));
  EXPECT_TRUE(gatherer->from_first_frame());
}

TEST(GenlockGatherer, GivesUpOlderIncompleteIndices) {
  const auto gatherer = gatherer_for(2, Variant::kReanchored);
  CollectedSets out;
  for (const std::int64_t pulse : {0, 1, 2, 3}) gatherer->push(frame_of(0, pulse), out);
  for (const std::int64_t pulse : {0, 3}) gatherer->push(frame_of(1, pulse), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0, 0), ElementsAre(3, 3)));
  EXPECT_EQ(gatherer->discarded(), 2U);
}

TEST(GenlockGatherer, WaitingFramesAreBounded) {
  const auto gatherer = gatherer_for(2, Variant::kReanchored, 8);
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 100; ++pulse) gatherer->push(frame_of(0, pulse), out);
  EXPECT_EQ(gatherer->discarded(), 92U);
}

// Every set is one pulse, and every pulse that all cameras delivered is a set, for half an hour.
TEST(GenlockGatherer, PerfectForHalfAnHourWithLostFrames) {
  constexpr std::uint32_t kSeed = 12;
  boost::random::mt19937 random(kSeed);
  boost::random::uniform_01<double> uniform;
  const auto gatherer = gatherer_for(3, Variant::kReanchored);
  CollectedSets out;
  std::int64_t complete = 0;
  for (std::int64_t pulse = 0; pulse < 45 * 1800; ++pulse) {
    bool all = true;
    for (std::uint32_t source = 0; source < 3; ++source) {
      const bool lost = pulse > 0 && uniform(random) < 0.02;
      all = all && !lost;
      if (!lost) gatherer->push(frame_of(source, pulse), out);
    }
    complete += all ? 1 : 0;
  }
  EXPECT_EQ(static_cast<std::int64_t>(out.sets.size()), complete) << "seed " << kSeed;
  EXPECT_EQ(out.pure(), complete) << "seed " << kSeed;
}

// Cameras of different rates cross half a period at different frames: the printed variant then
// mixes pulses or finds none, within minutes.
TEST(GenlockGatherer, PrintedVariantFailsWithinMinutes) {
  const auto gatherer = gatherer_for(6, Variant::kFirstStamp);
  CollectedSets out;
  constexpr std::int64_t kPulses = 45 * 180;
  for (std::int64_t pulse = 0; pulse < kPulses; ++pulse) {
    for (std::uint32_t source = 0; source < 6; ++source) {
      gatherer->push(frame_of(source, pulse), out);
    }
  }
  EXPECT_LT(out.pure(), kPulses * 95 / 100);
  const std::vector<std::vector<std::int64_t>> tags = out.tags();
  for (std::int64_t pulse = 0; pulse < 800; ++pulse) {  // as long as it holds, it is right
    ASSERT_THAT(tags[static_cast<std::size_t>(pulse)], ::testing::Each(pulse));
  }
}

// A camera that loses its first frame is off by one ever after (docs/reference/paper.md section 8).
TEST(GenlockGathererDefect, LostFirstFrameShiftsACamera) {
  const auto gatherer = gatherer_for(2, Variant::kReanchored);
  CollectedSets out;
  for (std::int64_t pulse = 0; pulse < 50; ++pulse) {
    gatherer->push(frame_of(0, pulse), out);
    if (pulse > 0) gatherer->push(frame_of(1, pulse), out);
  }
  EXPECT_EQ(out.sets.size(), 49U);
  EXPECT_EQ(out.pure(), 0);
}

}  // namespace
}  // namespace simbench

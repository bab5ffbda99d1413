#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "algorithms/gathering/gatherers.h"
#include "algorithms/registry.h"
#include "tests/algorithms/gathering/collected_sets.h"

namespace simbench {
namespace {

std::unique_ptr<Gatherer> made(const GatheringSetup& setup) {
  return make_certified_gatherer(setup, {.hosts = 1, .host_of_camera = {0, 0}});
}

void push_two(Gatherer& gatherer, CollectedSets& out, Microseconds second_is_late = {}) {
  for (std::int64_t pulse = 0; pulse < 20; ++pulse) {
    for (const std::uint32_t source : {0U, 1U}) {
      GatherFrame frame = frame_at(source, static_cast<double>(pulse) * kShortPeriodMs, pulse);
      if (source == 1) frame.sensor += second_is_late;
      gatherer.push(frame, out);
    }
  }
}

TEST(CertifiedGatherer, EmitsWhatIsSure) {
  const auto gatherer = made(short_setup(2));
  gatherer->on_poll(0, {});
  gatherer->on_poll(1, {});
  CollectedSets out;
  push_two(*gatherer, out);
  EXPECT_EQ(out.sets.size(), 20U);
  EXPECT_EQ(gatherer->discarded(), 0U);
}

TEST(CertifiedGatherer, WithoutReadingsNothingIsSure) {
  const auto gatherer = made(short_setup(2));
  gatherer->on_poll(0, {});
  CollectedSets out;
  push_two(*gatherer, out);
  EXPECT_TRUE(out.sets.empty());
  EXPECT_EQ(gatherer->discarded(), 40U);
}

// Two hosts that an exchange ties to 0.2 ms, if their clocks are read as finely.
TEST(CertifiedGatherer, ACoarseSystemClockMakesNothingSure) {
  const GatheringEntry* entry = find_algorithm<GatheringEntry>("certified");
  ASSERT_NE(entry, nullptr);
  for (const double step_ms : {0.0, 15.625}) {
    GatheringSetup setup = short_setup(2);
    setup.hosts = 2;
    setup.host_of_source = {0, 1};
    setup.host_clock_step = from_ms(step_ms);
    const auto gatherer = entry->make(check_parameters(entry->info.parameters, {}), setup);
    for (std::uint32_t host : {0U, 1U}) gatherer->on_adjustment({.host = host});
    for (std::uint32_t source : {0U, 1U}) gatherer->on_poll(source, {});
    const HostTime asked(from_ms(-0.1));
    const HostTime answered(from_ms(0.1));
    gatherer->on_exchange(1, {.peer = 0, .t1 = asked, .t2 = asked, .t3 = asked, .t4 = answered});
    CollectedSets out;
    push_two(*gatherer, out);
    EXPECT_EQ(out.sets.size(), step_ms > 0 ? 0U : 20U) << step_ms;
  }
}

// The stamps agree, the exposures do not: a camera a whole period late by its own clock.
TEST(CertifiedGatherer, StampsThatAgreeWronglyAreNoSet) {
  const auto gatherer = made(short_setup(2));
  gatherer->on_poll(0, {});
  gatherer->on_poll(1, {});
  CollectedSets out;
  push_two(*gatherer, out, std::chrono::duration_cast<Microseconds>(from_ms(kShortPeriodMs)));
  EXPECT_TRUE(out.sets.empty());
}

}  // namespace
}  // namespace simbench

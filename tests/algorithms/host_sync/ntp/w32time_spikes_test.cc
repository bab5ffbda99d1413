#include <gtest/gtest.h>

#include "algorithms/host_sync/ntp/w32time.h"
#include "tests/algorithms/host_sync/closed_loop.h"

namespace simbench {
namespace {

SteadyTime at_s(double seconds) { return SteadyTime(from_ms(seconds * 1e3)); }

W32TimeSpikes after_hold() {
  W32TimeSpikes spikes;
  for (int i = 0; i < W32TimeSpikes::kHoldPeriod; ++i) spikes.accept(Nanoseconds{0}, at_s(i));
  return spikes;
}

TEST(W32TimeSpikes, TakesEverythingDuringTheHold) {
  W32TimeSpikes spikes;
  for (int i = 0; i < W32TimeSpikes::kHoldPeriod; ++i) {
    EXPECT_TRUE(spikes.accept(from_ms(9e3), at_s(i * 64)));
  }
  EXPECT_FALSE(spikes.accept(from_ms(9e3), at_s(400)));
}

TEST(W32TimeSpikes, DuringTheHoldTheRateIsLeftAlone) {
  W32TimeSpikes spikes;
  EXPECT_FALSE(spikes.corrects_rate());
  for (int i = 0; i < W32TimeSpikes::kHoldPeriod; ++i) {
    EXPECT_TRUE(spikes.accept(Nanoseconds{0}, at_s(i)));
    EXPECT_FALSE(spikes.corrects_rate()) << i;
  }
  EXPECT_TRUE(spikes.accept(Nanoseconds{0}, at_s(9)));
  EXPECT_TRUE(spikes.corrects_rate());
}

TEST(W32TimeSpikes, ASpikeIsFromTheLimitOnInBothDirections) {
  EXPECT_TRUE(after_hold().accept(from_ms(5e3) - Nanoseconds{1}, at_s(100)));
  EXPECT_FALSE(after_hold().accept(from_ms(5e3), at_s(100)));
  EXPECT_TRUE(after_hold().accept(from_ms(-5e3) + Nanoseconds{1}, at_s(100)));
  EXPECT_FALSE(after_hold().accept(from_ms(-5e3), at_s(100)));
}

TEST(W32TimeSpikes, ALargeOffsetThatPersistsIsAccepted) {
  W32TimeSpikes spikes = after_hold();
  EXPECT_FALSE(spikes.accept(from_ms(9e3), at_s(1000)));
  EXPECT_FALSE(spikes.accept(from_ms(9e3), at_s(1899)));
  EXPECT_TRUE(spikes.accept(from_ms(9e3), at_s(1900)));
  EXPECT_TRUE(spikes.accept(from_ms(9e3), at_s(1901))) << "a hold follows";
}

TEST(W32TimeSpikes, ASmallOffsetEndsTheSuspicion) {
  W32TimeSpikes spikes = after_hold();
  EXPECT_FALSE(spikes.accept(from_ms(9e3), at_s(1000)));
  EXPECT_TRUE(spikes.accept(from_ms(1), at_s(1500)));
  EXPECT_FALSE(spikes.accept(from_ms(9e3), at_s(1900)));
  EXPECT_TRUE(spikes.accept(from_ms(9e3), at_s(2800)));
}

TEST(W32TimeDomain, FollowsAStepOfTheMasterAfterTheSpikeWatch) {
  ScriptWorld world(2);
  world.connect(from_ms(2));
  W32TimeSettings settings = w32time_domain_settings();
  settings.poll_interval = from_ms(64e3);
  settings.start_spread = Nanoseconds{0};
  W32Time algorithm(settings);
  world.call_at(from_ms(1000e3), [&world] { world.host(0).offset += from_ms(20e3); });
  world.call_at(from_ms(1800e3), [&world] {
    EXPECT_EQ(world.host(1).lead_over(world.host(0)), from_ms(-20e3)) << "still watched";
  });
  world.run(algorithm, from_ms(2100e3));
  EXPECT_EQ(world.host(1).lead_over(world.host(0)), Nanoseconds{0});
}

TEST(W32TimeDomain, SlewsWhatAStandAloneMachineSets) {
  const W32TimeCorrection domain = w32time_correction(from_ms(1100), w32time_domain_settings());
  EXPECT_FALSE(domain.set);
  EXPECT_NEAR(domain.units_per_tick, 1.1e7 / (16 * 1 * 1024), 1e-6);
  EXPECT_TRUE(w32time_correction(from_ms(1100), W32TimeSettings{}).set);
}

TEST(W32TimeDomain, AStandAloneMachineRefusesMoreThan15Hours) {
  ScriptWorld world(2);
  world.connect(from_ms(2)).host(0).offset = from_ms(54001e3);
  W32TimeSettings settings;
  settings.start_spread = Nanoseconds{0};
  W32Time stand_alone(settings);
  world.run(stand_alone, from_ms(100));
  expect_refused(world, 1, "MaxPosPhaseCorrection");
  EXPECT_TRUE(world.host(1).steps.empty());

  ScriptWorld domain_world(2);
  domain_world.connect(from_ms(2)).host(0).offset = from_ms(54001e3);
  settings = w32time_domain_settings();
  settings.start_spread = Nanoseconds{0};
  W32Time domain(settings);
  domain_world.run(domain, from_ms(100));
  EXPECT_EQ(domain_world.host(1).lead_over(domain_world.host(0)), Nanoseconds{0});
}

}  // namespace
}  // namespace simbench

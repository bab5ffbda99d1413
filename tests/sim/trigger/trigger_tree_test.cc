#include "sim/trigger/trigger_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "scenarios/trigger_code.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

scenarios::Trigger ideal(double rate_hz) {
  scenarios::Trigger trigger = ideal_scenario().trigger;
  trigger.rate_hz = rate_hz;
  return trigger;
}

TEST(TriggerTree, SlotsAreEquallySpacedOverHours) {
  TriggerTree tree(ideal(45), 18, 1);
  tree.start(TrueTime(from_ms(100)));
  EXPECT_EQ(tree.due(0), TrueTime(from_ms(100)));
  // Three hours of 45 Hz: 486,000 periods of 22.2 recurring ms are exactly 10,800 s.
  EXPECT_EQ(tree.due(486000), TrueTime(from_ms(100) + std::chrono::hours(3)));
  EXPECT_EQ(tree.pulse(486000), tree.due(486000));
}

TEST(TriggerTree, RateErrorShortensThePeriod) {
  scenarios::Trigger settings = ideal(30);
  settings.rate_error_ppm = 500;
  TriggerTree tree(settings, 6, 1);
  tree.start(TrueTime{});
  EXPECT_DOUBLE_EQ(tree.period_ns(), 1e9 / 30.015);
  EXPECT_EQ(tree.due(30015), TrueTime(std::chrono::seconds(1000)));
}

TEST(TriggerTree, ACameraMayHaveADelayOfItsOwn) {
  scenarios::Trigger settings = ideal(30);
  settings.cable_delay_max_us = 3;
  const TriggerTree before(settings, 3, 1);
  settings.delay_of_camera_us = {0, 1500, 20.5};
  const TriggerTree after(settings, 3, 1);
  EXPECT_EQ(after.delay_to(0), before.delay_to(0));
  EXPECT_EQ(after.delay_to(1) - before.delay_to(1), from_us(1500));
  EXPECT_EQ(after.delay_to(2) - before.delay_to(2), from_us(20.5));
}

TEST(TriggerTree, StartsLate) {
  scenarios::Trigger settings = ideal(10);
  settings.start_delay_ms = 250;
  TriggerTree tree(settings, 6, 1);
  tree.start(TrueTime{});
  EXPECT_EQ(tree.pulse(0), TrueTime(from_ms(250)));
  EXPECT_EQ(tree.first_slot_from(TrueTime{}), 0);
  EXPECT_EQ(tree.first_slot_from(TrueTime(from_ms(250))), 0);
  EXPECT_EQ(tree.first_slot_from(TrueTime(from_ms(250.001))), 1);
}

TEST(TriggerTree, PausesLeaveTheirSlotsEmptyAndKeepTheNumbering) {
  scenarios::Trigger settings = ideal(10);
  settings.pauses = {{.at_ms = 200, .duration_ms = 300}};
  TriggerTree tree(settings, 6, 1);
  tree.start(TrueTime{});
  for (std::int64_t slot = 0; slot < 10; ++slot) {
    EXPECT_EQ(tree.pulse(slot).has_value(), slot < 2 || slot >= 5) << "slot " << slot;
  }
  EXPECT_EQ(tree.pulse(5), TrueTime(from_ms(500)));
}

TEST(TriggerTree, MissedPulsesHaveTheirProbabilityAndTheSameSlotsEachTime) {
  scenarios::Trigger settings = ideal(100);
  settings.missed_pulse_probability = 0.1;
  TriggerTree tree(settings, 6, 7);
  tree.start(TrueTime{});
  int missed = 0;
  const int slots = 20000;
  for (int slot = 0; slot < slots; ++slot) {
    missed += tree.pulse(slot).has_value() ? 0 : 1;
    EXPECT_EQ(tree.pulse(slot), tree.pulse(slot));
  }
  // Binomial: 2000 expected, sigma = sqrt(20000 * 0.1 * 0.9) = 42.4.
  EXPECT_NEAR(missed, 2000, 5 * 42.4) << "seed 7";
}

TEST(TriggerTree, JitterIsThatOfTheSettings) {
  scenarios::Trigger settings = ideal(100);
  settings.pulse_jitter_sigma_us = 3;
  TriggerTree tree(settings, 6, 3);
  tree.start(TrueTime{});
  double sum = 0;
  double squares = 0;
  const int slots = 20000;
  for (int slot = 0; slot < slots; ++slot) {
    const double us = 1e-3 * static_cast<double>((*tree.pulse(slot) - tree.due(slot)).count());
    sum += us;
    squares += us * us;
  }
  EXPECT_NEAR(sum / slots, 0.0, 5 * 3 / std::sqrt(slots)) << "seed 3";
  EXPECT_NEAR(std::sqrt(squares / slots), 3.0, 5 * 3 / std::sqrt(2.0 * slots)) << "seed 3";
}

TEST(TriggerTree, ACodeMovesThePulsesAndNotTheGrid) {
  scenarios::Trigger settings = ideal(45);
  const TriggerTree even(settings, 6, 3);
  settings.code = scenarios::TriggerCodeModel{
      .kind = scenarios::CodeKind::kPosition, .order = 6, .shift_us = 30, .pulses_per_symbol = 1};
  const TriggerTree coded(settings, 6, 3);
  const TriggerCode code = *scenarios::trigger_code(settings);
  for (std::int64_t slot = 0; slot < 200; ++slot) {
    EXPECT_EQ(coded.due(slot), even.due(slot));
    EXPECT_EQ(*coded.pulse(slot), *even.pulse(slot) + code.shift(slot)) << slot;
  }
  EXPECT_EQ(coded.first_slot_from(even.due(77)), 77);
}

TEST(TriggerTree, ACodeLeavesPulsesOut) {
  scenarios::Trigger settings = ideal(45);
  settings.code = scenarios::TriggerCodeModel{
      .kind = scenarios::CodeKind::kMissing, .order = 4, .shift_us = 0, .pulses_per_symbol = 3};
  const TriggerTree tree(settings, 6, 3);
  const TriggerCode code = *scenarios::trigger_code(settings);
  for (std::int64_t slot = 0; slot < 100; ++slot) {
    EXPECT_EQ(tree.pulse(slot).has_value(), code.is_sent(slot)) << slot;
  }
}

TEST(TriggerTree, JitterIsTheSameWithACode) {
  scenarios::Trigger settings = ideal(45);
  settings.pulse_jitter_sigma_us = 5;
  const TriggerTree even(settings, 6, 3);
  settings.code = scenarios::TriggerCodeModel{
      .kind = scenarios::CodeKind::kPosition, .order = 6, .shift_us = 30, .pulses_per_symbol = 1};
  const TriggerTree coded(settings, 6, 3);
  const TriggerCode code = *scenarios::trigger_code(settings);
  for (std::int64_t slot = 0; slot < 100; ++slot) {
    EXPECT_EQ(*coded.pulse(slot) - code.shift(slot), *even.pulse(slot)) << slot;
  }
}

TEST(TriggerTree, CamerasOfOneBranchShareItsDelay) {
  scenarios::Trigger settings = ideal(45);
  settings.branch_delay_max_us = 5;
  TriggerTree tree(settings, 18, 11);
  std::set<Nanoseconds> branches;
  for (std::size_t camera = 0; camera < 18; ++camera) {
    EXPECT_EQ(tree.delay_to(camera), tree.delay_to(camera / 6 * 6)) << "camera " << camera;
    EXPECT_GE(tree.delay_to(camera), Nanoseconds(0));
    EXPECT_LE(tree.delay_to(camera), Nanoseconds(5000));
    branches.insert(tree.delay_to(camera));
  }
  EXPECT_EQ(branches.size(), 3u);
}

TEST(TriggerTree, EachCameraOfADaisyChainPassesThePulseOn) {
  scenarios::Trigger settings = ideal(30);
  settings.cameras_per_sub_trigger = 9;
  settings.daisy_chain_delay_us = 1.5;
  TriggerTree tree(settings, 18, 11);
  for (std::size_t camera = 0; camera < 18; ++camera) {
    EXPECT_EQ(tree.delay_to(camera), Nanoseconds(1500 * static_cast<int>(camera % 9))) << camera;
  }
}

TEST(TriggerTree, EveryCableHasItsOwnDelay) {
  scenarios::Trigger settings = ideal(45);
  settings.cable_delay_max_us = 0.1;
  TriggerTree tree(settings, 18, 11);
  std::set<Nanoseconds> delays;
  for (std::size_t camera = 0; camera < 18; ++camera) delays.insert(tree.delay_to(camera));
  EXPECT_GT(delays.size(), 10u);
  EXPECT_LE(*delays.rbegin(), Nanoseconds(100));
}

}  // namespace
}  // namespace simbench::sim

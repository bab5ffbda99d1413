#include "sim/host/sim_host.h"

#include <gtest/gtest.h>

#include <boost/asio/awaitable.hpp>
#include <cmath>
#include <vector>

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

struct Reading {
  double value_ms;
  double returned_ms;
};

Task<void> read_clock(SimWorld& world, std::size_t host, std::vector<Reading>& out) {
  const HostTime value = co_await world.host(host).clock().now();
  out.push_back({ms_of(value), world.now_ms()});
}

Task<void> set_clock(SimWorld& world, std::size_t host, HostTime value, double& returned_ms) {
  co_await world.host(host).clock().set(value);
  returned_ms = world.now_ms();
}

Task<void> set_clock_at(SimWorld& world, TrueTime at, HostTime value) {
  co_await sim::sleep_until(world.context, at, "test");
  co_await world.host(0).clock().set(value);
}

Task<void> slew_clock_at(SimWorld& world, TrueTime at, double offset_ms, double rate_ppb) {
  co_await sim::sleep_until(world.context, at, "test");
  co_await world.host(0).clock().slew(from_ms(offset_ms), rate_ppb);
}

Task<void> sleep_to(SimWorld& world, HostTime at, double& woken_ms) {
  co_await world.host(0).sleep_until(at);
  woken_ms = world.now_ms();
}

Task<void> sleep_interval(SimWorld& world, double interval_ms, double& woken_ms) {
  co_await world.host(0).sleep_for(from_ms(interval_ms));
  woken_ms = world.now_ms();
}

TEST(SimHostTest, AGetCostsTimeAndReturnsTheReadingOfItsStart) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.read_cost_ms = 3;
  SimWorld world(scenario);
  std::vector<Reading> readings;
  world.spawn(read_clock(world, 0, readings));
  world.spawn(read_clock(world, 0, readings));  // waits for the CPU
  world.spawn(read_clock(world, 1, readings));  // has a CPU of its own
  world.engine.run();
  ASSERT_EQ(readings.size(), 3u);
  EXPECT_EQ(readings[0].value_ms, 0);
  EXPECT_EQ(readings[0].returned_ms, 3);
  EXPECT_EQ(readings[1].returned_ms, 3);
  EXPECT_EQ(readings[2].value_ms, 3);
  EXPECT_EQ(readings[2].returned_ms, 6);
}

TEST(SimHostTest, ASetCountsFromItsEffectiveInstantAndRoundsDown) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.set_cost_ms = 4;
  scenario.hosts.clock.set_effective_fraction = 0.25;
  scenario.hosts.clock.resolution_ms = 1;
  SimWorld world(scenario);
  double returned_ms = 0;
  world.spawn(set_clock(world, 0, host_ms(1000.7), returned_ms));
  world.engine.run();
  EXPECT_EQ(returned_ms, 4);
  const SystemClock& clock = world.hosts.clock(0);
  EXPECT_EQ(clock.read(at_ms(1) - Nanoseconds(1)), host_ms(1) - Nanoseconds(1));
  EXPECT_EQ(clock.read(at_ms(1)), host_ms(1000));
  EXPECT_EQ(clock.read(at_ms(4)), host_ms(1003));
  ASSERT_EQ(world.record.adjustments.size(), 1u);
  EXPECT_EQ(world.record.adjustments[0].before, host_ms(1));
  EXPECT_EQ(world.record.adjustments[0].after, host_ms(1000));
}

TEST(SimHostTest, ReadingsAreCoarse) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.resolution_ms = 1;
  SimWorld world(scenario);
  double woken_ms = 0;
  std::vector<Reading> readings;
  world.spawn(sleep_interval(world, 5.75, woken_ms));
  world.engine.run();
  world.spawn(read_clock(world, 0, readings));
  world.engine.run();
  EXPECT_EQ(readings.at(0).value_ms, 5);
}

TEST(SimHostTest, TheCostOfASetHasAFactorPerHostAndLoadAndOnePerCall) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.set_cost_ms = 4.5;
  scenario.hosts.clock.set_cost_session_log_sigma = 0.2;
  const auto costs_ms = [&](double call_log_sigma, std::string_view load_key) {
    scenario.hosts.clock.set_cost_call_log_sigma = call_log_sigma;
    SimWorld world(scenario, 7, InitialClocks::kUnsynchronised, load_key);
    std::vector<double> costs;
    for (int i = 0; i < 2000; ++i) {
      const double start_ms = world.now_ms();
      double returned_ms = 0;
      world.spawn(set_clock(world, 1, host_ms(0), returned_ms));
      world.engine.run();
      costs.push_back(returned_ms - start_ms);
    }
    return costs;
  };
  const std::vector<double> same = costs_ms(0, "both@world");
  EXPECT_NEAR(same[0], same[999], 1e-5);
  EXPECT_GT(std::abs(same[0] - 4.5), 1e-3);
  EXPECT_GT(std::abs(costs_ms(0, "time@world")[0] - same[0]), 1e-3);
  double sum = 0;
  double squares = 0;
  for (const double cost_ms : costs_ms(0.3, "both@world")) {
    const double log_factor = std::log(cost_ms / same[0]);
    sum += log_factor;
    squares += log_factor * log_factor;
  }
  EXPECT_NEAR(sum / 2000, 0, 5 * 0.3 / std::sqrt(2000));
  EXPECT_NEAR(std::sqrt(squares / 2000), 0.3, 5 * 0.3 / std::sqrt(4000));
}

TEST(SimHostTest, SleepForFollowsTheOscillator) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.hosts.clock.oscillator.skew_sigma_ppm = 1000;
  SimWorld world(scenario);
  double woken_ms = 0;
  world.spawn(sleep_interval(world, 1000, woken_ms));
  world.engine.run();
  const double skew = world.hosts.clock(0).oscillator().skew();
  EXPECT_GT(std::abs(skew), 1e-5);
  EXPECT_NEAR(woken_ms, 1000 / (1 + skew), 2e-6);
}

TEST(SimHostTest, SleepUntilWakesAtTheReading) {
  SimWorld world(ideal_hosts());
  double woken_ms = 0;
  double past_ms = -1;
  world.spawn(sleep_to(world, host_ms(1000), woken_ms));
  world.spawn(sleep_to(world, host_ms(-5), past_ms));
  world.engine.run();
  EXPECT_EQ(woken_ms, 1000);
  EXPECT_EQ(past_ms, 0);
}

TEST(SimHostTest, SleepUntilIsRearmedByAStep) {
  SimWorld world(ideal_hosts());
  double early_ms = 0;
  double late_ms = 0;
  double over_ms = 0;
  world.spawn(sleep_to(world, host_ms(1000), early_ms));
  world.spawn(sleep_to(world, host_ms(200), late_ms));
  world.spawn(sleep_to(world, host_ms(600), over_ms));
  world.spawn(set_clock_at(world, at_ms(100), host_ms(50)));   // late: 150 ms to go, at 250 ms
  world.spawn(set_clock_at(world, at_ms(300), host_ms(700)));  // over: passed, wakes now
  world.engine.run();
  EXPECT_EQ(late_ms, 250);
  EXPECT_EQ(over_ms, 300);
  EXPECT_EQ(early_ms, 600);
}

TEST(SimHostTest, SleepUntilIsRearmedByASlewAndItsEnd) {
  SimWorld world(ideal_hosts());
  double during_ms = 0;
  double after_ms = 0;
  world.spawn(sleep_to(world, host_ms(1100), during_ms));
  world.spawn(sleep_to(world, host_ms(5000), after_ms));
  world.spawn(slew_clock_at(world, at_ms(1000), 100, 100'000'000));  // 10 % for 1000 ms
  world.engine.run();
  EXPECT_NEAR(during_ms, 1000 + 100 / 1.1, 2e-6);
  EXPECT_NEAR(after_ms, 4900, 2e-6);
  ASSERT_EQ(world.record.adjustments.size(), 2u);
  EXPECT_EQ(world.record.adjustments[1].rate_ppb, 0);
}

TEST(SimHostTest, AFaultThatStepsTheClockWakesSleepersToo) {
  SimWorld world(ideal_hosts());
  double woken_ms = 0;
  world.spawn(sleep_to(world, host_ms(1000), woken_ms));
  world.engine.call_at(at_ms(10), [&] { world.hosts.clock(0).set(at_ms(10), host_ms(2000)); });
  world.engine.run();
  EXPECT_EQ(woken_ms, 10);
}

TEST(SimHostTest, ReportsGoToTheRecord) {
  SimWorld world(ideal_hosts());
  world.host(1).report_exchange({.peer = 0, .t1 = host_ms(1), .t2 = {}, .t3 = {}, .t4 = {}});
  world.host(0).report_outcome(
      {.slave = 1, .synchronised = true, .passes = 2, .message = "after two passes"});
  ASSERT_EQ(world.record.exchanges.size(), 1u);
  EXPECT_EQ(world.record.exchanges[0].first, 1u);
  EXPECT_EQ(world.record.exchanges[0].second.t1, host_ms(1));
  ASSERT_EQ(world.record.outcomes.size(), 1u);
  EXPECT_EQ(world.record.outcomes[0].passes, 2u);
  world.host(1).report_delays({.slave = 1, .pass = 2, .t_l = from_ms(3)});
  ASSERT_EQ(world.record.delays.size(), 1u);
  EXPECT_EQ(world.record.delays[0].t_l, from_ms(3));
}

TEST(SimHostTest, RandomNumbersAreInTheUnitIntervalAndDifferBetweenHosts) {
  SimWorld world(ideal_hosts());
  for (int i = 0; i < 100; ++i) {
    const double number = world.host(0).random_uniform();
    EXPECT_GE(number, 0);
    EXPECT_LT(number, 1);
    EXPECT_NE(number, world.host(1).random_uniform());
  }
}

}  // namespace
}  // namespace simbench::sim

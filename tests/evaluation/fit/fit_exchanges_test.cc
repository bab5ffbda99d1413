#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "evaluation/fit/fit.h"
#include "evaluation/statistics/statistics.h"
#include "sim/engine/random.h"

namespace simbench::evaluation {
namespace {

HostTime host_at(double ms) { return HostTime(from_ms(ms)); }

// A slave that asks the master: its oscillator is fast, its clock was ahead and is then set.
struct Slave {
  double skew_ppm = 25;
  double ahead_ms = 120;
  double set_at_ms = 5'000;  // true time; to the master's
  std::uint32_t host = 2;
};

double system_ms(const Slave& slave, double t_ms) {
  const double steady_ms = t_ms * (1 + slave.skew_ppm * 1e-6);
  if (t_ms < slave.set_at_ms) return steady_ms + slave.ahead_ms;
  return slave.set_at_ms + steady_ms - slave.set_at_ms * (1 + slave.skew_ppm * 1e-6);
}

ClockAdjustment adjustment(const Slave& slave, double t_ms, double before_ms, double after_ms) {
  return {.host = slave.host,
          .at = SteadyTime(from_ms(t_ms * (1 + slave.skew_ppm * 1e-6))),
          .before = host_at(before_ms),
          .after = host_at(after_ms),
          .rate_ppb = 0};
}

// Asks every 50 ms of true time.
FitInput exchanges(const Slave& slave, int count, const std::function<double()>& way_ms) {
  FitInput input;
  input.hosts = {"m", "a", "b"};
  input.clock_events.emplace_back(ClockAdjustment{});
  input.clock_events.emplace_back(adjustment(slave, 0, slave.ahead_ms, slave.ahead_ms));
  bool is_set = false;
  for (int i = 0; i < count; ++i) {
    const double t1 = 10 + i * 50.0;
    if (!is_set && t1 >= slave.set_at_ms) {
      input.clock_events.emplace_back(adjustment(
          slave, slave.set_at_ms, slave.set_at_ms * (1 + slave.skew_ppm * 1e-6) + slave.ahead_ms,
          slave.set_at_ms));
      is_set = true;
    }
    const double t2 = t1 + way_ms();
    const double t3 = t2 + 0.3;
    const double t4 = t3 + way_ms();
    input.clock_events.emplace_back(
        ExchangeEvent{slave.host, Exchange{.peer = 0,
                                           .t1 = host_at(system_ms(slave, t1)),
                                           .t2 = host_at(t2),
                                           .t3 = host_at(t3),
                                           .t4 = host_at(system_ms(slave, t4))}});
  }
  return input;
}

TEST(FitExchanges, FindsOffsetRateAndLatency) {
  const NetworkFit fit = fit_exchanges(exchanges(Slave{}, 400, [] { return 0.25; }));
  ASSERT_EQ(fit.round_trips_ms.size(), 400U);
  for (const double trip : fit.round_trips_ms) EXPECT_NEAR(trip, 0.5, 1e-4);
  for (const double way : fit.latency_quantiles_ms) EXPECT_NEAR(way, 0.25, 1e-4);
  ASSERT_EQ(fit.hosts.size(), 1U);
  EXPECT_EQ(fit.hosts[0].host, 2U);
  ASSERT_TRUE(fit.hosts[0].skew_ppm && fit.hosts[0].initial_offset_ms);
  EXPECT_NEAR(fit.hosts[0].skew_ppm->value, 25, 0.01);
  // Ahead from the first question on by what the rate adds to it in 5 s, 0.125 ms at most.
  EXPECT_NEAR(fit.hosts[0].initial_offset_ms->value, 120, 0.126);
  EXPECT_NEAR(fit.hosts[0].initial_offset_ms->error, 0.25, 1e-4);
}

TEST(FitExchanges, ErrorsHoldTheTruth) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream random(seed, "test");
    const NetworkFit fit =
        fit_exchanges(exchanges(Slave{}, 400, [&] { return 0.1 + random.exponential(0.1); }));
    ASSERT_TRUE(fit.hosts[0].skew_ppm) << "seed " << seed;
    EXPECT_NEAR(fit.hosts[0].skew_ppm->value, 25, 5 * fit.hosts[0].skew_ppm->error)
        << "seed " << seed;
    EXPECT_NEAR(fit.hosts[0].initial_offset_ms->value, 120,
                fit.hosts[0].initial_offset_ms->error + 0.126)
        << "seed " << seed;
  }
}

TEST(FitExchanges, AMasterThatAsksSeesTheSame) {
  Slave slave;
  slave.set_at_ms = 1e9;
  FitInput input = exchanges(slave, 300, [] { return 0.25; });
  for (std::size_t i = 0; i < input.clock_events.size(); ++i) {
    auto* asked = std::get_if<ExchangeEvent>(&input.clock_events[i]);
    if (asked == nullptr) continue;
    const double t_ms = static_cast<double>(i) * 50;
    *asked = {0, Exchange{.peer = slave.host,
                          .t1 = host_at(t_ms),
                          .t2 = host_at(system_ms(slave, t_ms + 0.25)),
                          .t3 = host_at(system_ms(slave, t_ms + 0.5)),
                          .t4 = host_at(t_ms + 0.75)}};
  }
  const NetworkFit fit = fit_exchanges(input);
  ASSERT_EQ(fit.hosts.size(), 1U);
  EXPECT_EQ(fit.hosts[0].host, 2U);
  EXPECT_NEAR(fit.hosts[0].skew_ppm->value, 25, 0.01);
  EXPECT_NEAR(fit.hosts[0].initial_offset_ms->value, 120, 0.4);  // 25 ppm of 15 s
}

TEST(FitExchanges, NeedsAllStampsAndEnoughOfThem) {
  FitInput input = exchanges(Slave{}, 49, [] { return 0.25; });
  EXPECT_TRUE(fit_exchanges(input).latency_quantiles_ms.empty());
  for (RecordingEvent& event : input.clock_events) {
    if (auto* asked = std::get_if<ExchangeEvent>(&event)) asked->exchange.t3.reset();
  }
  EXPECT_TRUE(fit_exchanges(input).round_trips_ms.empty());
  EXPECT_TRUE(fit_exchanges(input).hosts.empty());
}

// 20,000 draws of what two independent ways of a table make.
std::vector<double> sums_of(const std::vector<double>& table, sim::RandomStream& random) {
  const auto end = static_cast<double>(table.size() - 1);
  const auto draw = [&] {
    const double at = random.uniform(0, end);
    const auto below = static_cast<std::size_t>(at);
    return table[below] + (at - static_cast<double>(below)) * (table[below + 1] - table[below]);
  };
  std::vector<double> sums;
  for (int i = 0; i < 20'000; ++i) {
    const double there = draw();
    sums.push_back(there + draw());
  }
  return sums;
}

TEST(OneWayTable, OfExponentialWaysIsExponential) {
  sim::RandomStream random(3, "test");
  std::vector<double> trips;
  for (int i = 0; i < 20'000; ++i) {
    const double there = random.exponential(0.2);
    trips.push_back(1 + there + random.exponential(0.2));
  }
  const std::vector<double> table = one_way_table(trips);
  ASSERT_EQ(table.size(), 101U);
  EXPECT_TRUE(std::is_sorted(table.begin(), table.end()));
  EXPECT_NEAR(table.front(), 0.5, 0.01);
  for (const int percent : {10, 25, 50, 75, 90, 95}) {
    const double expected = 0.5 - 0.2 * std::log1p(-percent / 100.0);
    // Halved round trips would be off by up to 0.13.
    EXPECT_NEAR(table[static_cast<std::size_t>(percent)], expected, 0.025)
        << percent << " %, seed 3";
  }
  EXPECT_LT(ks_distance(trips, sums_of(table, random)), 0.03) << "seed 3";
}

TEST(OneWayTable, KeepsRareSpikes) {
  sim::RandomStream random(4, "test");
  const auto way = [&] {
    const double extra = random.exponential(0.05);
    const double spike = random.chance(0.05) ? random.uniform(0, 2) : 0;
    return 0.1 + extra + spike;
  };
  std::vector<double> trips;
  for (int i = 0; i < 20'000; ++i) {
    const double there = way();
    trips.push_back(there + way());
  }
  const std::vector<double> table = one_way_table(trips);
  EXPECT_NEAR(table[50], 0.1 - 0.05 * std::log1p(-0.5 / 0.95), 0.02) << "seed 4";
  EXPECT_NEAR(table[98], 0.1 + 2 * 0.6, 0.25) << "of 5 % spikes, 3 in 5 are shorter; seed 4";
  EXPECT_LT(ks_distance(trips, sums_of(table, random)), 0.1) << "seed 4";
}

TEST(OneWayTable, OfOneLengthIsOneLength) {
  EXPECT_EQ(one_way_table({0.5, 0.5, 0.5}), (std::vector<double>{0.25, 0.25}));
}

}  // namespace
}  // namespace simbench::evaluation

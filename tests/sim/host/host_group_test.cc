#include "sim/host/host_group.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

scenarios::Scenario scattered(std::int64_t hosts) {
  scenarios::Scenario scenario = ideal_hosts(hosts);
  scenario.hosts.clock.oscillator.skew_sigma_ppm = 10;
  scenario.hosts.clock.initial_offset_sigma_ms = 300;
  scenario.hosts.clock.last_set = {
      .hours_ago = 6.8, .skew_sigma_ppm = 10, .minutes_since_baseline = 0};
  return scenario;
}

double offset_ms(SimWorld& world, std::size_t host) {
  return ms_of(world.hosts.clock(host).read(TrueTime{}));
}

TEST(HostGroupTest, SlavesStartOffAndTheMasterAtZero) {
  SimWorld world(scattered(2000), 5);
  EXPECT_EQ(offset_ms(world, 0), 0);
  double squares = 0;
  for (std::size_t i = 1; i < 2000; ++i) squares += std::pow(offset_ms(world, i), 2);
  EXPECT_NEAR(std::sqrt(squares / 1999), 300, 5 * 300 / std::sqrt(2 * 1999));
}

TEST(HostGroupTest, ClocksSetHoursAgoAreOffByTheDriftSinceThen) {
  SimWorld world(scattered(2000), 5, InitialClocks::kLastSet);
  EXPECT_EQ(offset_ms(world, 0), 0);
  double squares = 0;
  double with_present_skew = 0;
  const double sigma_ms = 10e-6 * 6.8 * 3.6e6;
  for (std::size_t i = 1; i < 2000; ++i) {
    const double off_ms = offset_ms(world, i);
    squares += off_ms * off_ms;
    with_present_skew += off_ms / sigma_ms * world.hosts.clock(i).oscillator().skew() / 10e-6;
  }
  EXPECT_NEAR(std::sqrt(squares / 1999), sigma_ms, 5 * sigma_ms / std::sqrt(2 * 1999));
  EXPECT_NEAR(with_present_skew / 1999, 0, 5 / std::sqrt(1999));
}

TEST(HostGroupTest, ALaterRecordingIsShiftedByThePresentRates) {
  scenarios::Scenario later = scattered(6);
  later.hosts.clock.last_set.minutes_since_baseline = 15;
  SimWorld first(scattered(6), 5, InitialClocks::kLastSet);
  SimWorld second(later, 5, InitialClocks::kLastSet);
  for (std::size_t i = 1; i < 6; ++i) {
    const double skew =
        first.hosts.clock(i).oscillator().skew() - first.hosts.clock(0).oscillator().skew();
    EXPECT_NEAR(offset_ms(second, i) - offset_ms(first, i), skew * 15 * 60e3, 2e-6);
  }
}

TEST(HostGroupTest, AnOraclesSlavesHaveTheMastersClock) {
  SimWorld world(scattered(4), 5, InitialClocks::kMaster);
  for (std::size_t i = 1; i < 4; ++i) {
    for (const double ms : {0.0, 1e4, 1e7}) {
      EXPECT_EQ(world.hosts.clock(i).read(at_ms(ms)), world.hosts.clock(0).read(at_ms(ms)));
    }
  }
}

TEST(HostGroupTest, StatedSkewsAndOffsetsAreExact) {
  scenarios::Scenario scenario = scattered(3);
  scenario.hosts.clock.skew_of_host_ppm = {2, -7.5, 40};
  scenario.hosts.clock.initial_offset_of_host_ms = {0, 12.5, -300};
  SimWorld world(scenario, 5);
  SimWorld drawn(scattered(3), 5);
  const double hours = 10;
  for (std::size_t host = 0; host < 3; ++host) {
    const double offset_ms = scenario.hosts.clock.initial_offset_of_host_ms[host];
    const double ahead_ms = scenario.hosts.clock.skew_of_host_ppm[host] * 1e-6 * hours * 3.6e6;
    const TrueTime then = at_ms(hours * 3.6e6);
    EXPECT_NEAR(ms_of(world.hosts.clock(host).read(then)) - hours * 3.6e6, offset_ms + ahead_ms,
                2e-6);
    EXPECT_EQ(world.hosts.clock(host).steady(TrueTime{}),
              drawn.hosts.clock(host).steady(TrueTime{}));
  }
}

TEST(HostGroupTest, StatedSkewsLeaveTheNoiseAsDrawn) {
  scenarios::Scenario drawn = scattered(2);
  drawn.hosts.clock.oscillator.random_walk_ppb_per_sqrt_s = 3;
  drawn.hosts.clock.oscillator.wander_step_ms = 100;
  scenarios::Scenario stated = drawn;
  stated.hosts.clock.skew_of_host_ppm = {5, -5};
  SimWorld with_draws(drawn, 5);
  SimWorld with_skews(stated, 5);
  for (std::size_t host = 0; host < 2; ++host) {
    const OscillatorModel& a = with_draws.hosts.clock(host).oscillator();
    const OscillatorModel& b = with_skews.hosts.clock(host).oscillator();
    const TrueTime then = at_ms(1e6);
    EXPECT_NEAR(a.deviation_ns(then) - a.skew() * 1e12, b.deviation_ns(then) - b.skew() * 1e12,
                1e-3);
  }
}

TEST(HostOscillatorsTest, AreThoseOfEachSeedInWhateverOrderTheyAreRead) {
  scenarios::Scenario scenario = scattered(3);
  scenario.hosts.clock.oscillator.random_walk_ppb_per_sqrt_s = 3;
  scenario.hosts.clock.oscillator.flicker_floor_ppb = 3;
  scenario.hosts.clock.oscillator.wander_step_ms = 100;
  HostOscillators shared(scenario.hosts);
  for (const std::uint64_t seed : {5, 5, 6, 5}) {
    for (std::size_t host = 0; host < 3; ++host) {
      const OscillatorModel one = shared.of(seed, host);
      const OscillatorModel other = shared.of(seed, host);
      const OscillatorModel own = host_oscillator(scenario.hosts, seed, host);
      for (const double ms : {-5e6, -1.0, 3e3, -4e6}) {
        EXPECT_EQ(one.deviation_ns(at_ms(ms)), own.deviation_ns(at_ms(ms)));
        EXPECT_EQ(other.deviation_ns(at_ms(ms - 1)), own.deviation_ns(at_ms(ms - 1)));
      }
    }
  }
}

TEST(HostGroupTest, AnExactMasterCountsTrueTime) {
  scenarios::Scenario scenario = scattered(3);
  scenario.hosts.clock.oscillator = {.skew_sigma_ppm = 10,
                                     .white_frequency_ppb = 5,
                                     .random_walk_ppb_per_sqrt_s = 5,
                                     .wander_step_ms = 100,
                                     .flicker_floor_ppb = 5,
                                     .ramp_ppm_per_hour = 1,
                                     .self_heating_ppm = 2,
                                     .self_heating_time_constant_s = 100};
  SimWorld noisy(scenario, 5);
  scenario.hosts.master_is_exact = true;
  SimWorld exact(scenario, 5);
  for (const double ms : {0.0, 1.0, 1e4, 36e6}) {
    EXPECT_EQ(ms_of(exact.hosts.clock(0).read(at_ms(ms))), ms);
    for (std::size_t slave = 1; slave < 3; ++slave) {
      EXPECT_EQ(exact.hosts.clock(slave).read(at_ms(ms)), noisy.hosts.clock(slave).read(at_ms(ms)));
    }
  }
}

TEST(HostGroupTest, FrequenciesFollowTheTemperaturesOfTheirHosts) {
  scenarios::Scenario scenario = scattered(3);
  scenario.hosts.master_is_exact = true;
  scenario.hosts.clock.skew_of_host_ppm = {0, 4, -8};
  scenario.hosts.clock.oscillator.temperature_coefficient_ppb_per_k = 480;
  scenario.hosts.temperature = scenarios::Temperature{.day_amplitude_k = 3,
                                                      .day_period_h = 24,
                                                      .load_amplitude_k = 5,
                                                      .load_period_s = 1200,
                                                      .load_time_constant_s = 180,
                                                      .fan_amplitude_k = 0.5,
                                                      .fan_period_s = 90};
  SimWorld world(scenario, 5);
  EXPECT_EQ(ms_of(world.hosts.clock(0).read(at_ms(36e6))), 36e6);
  for (std::size_t slave = 1; slave < 3; ++slave) {
    const TemperatureCourse course(*scenario.hosts.temperature, 5,
                                   "host" + std::to_string(slave) + ": temperature");
    for (const double ms : {-1e7, 500.0, 36e6}) {
      const double expected_ns =
          scenario.hosts.clock.skew_of_host_ppm[slave] * ms + 480 * course.integral_ks(at_ms(ms));
      EXPECT_NEAR(world.hosts.clock(slave).oscillator().deviation_ns(at_ms(ms)), expected_ns, 1e-3);
    }
  }
}

// What the load key must not move: oscillators and offsets pair the pipelines of a seed.
TEST(HostGroupTest, ClocksDoNotDependOnTheLoadKey) {
  scenarios::Scenario scenario = scattered(4);
  scenario.hosts.load_log_sigma = 0.6;
  scenario.hosts.clock.oscillator.white_frequency_ppb = 10;
  scenario.hosts.clock.oscillator.wander_step_ms = 100;
  SimWorld both(scenario, 5, InitialClocks::kUnsynchronised, "both@world");
  SimWorld time(scenario, 5, InitialClocks::kUnsynchronised, "time@world");
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double ms : {-1e5, 0.0, 1e5}) {
      EXPECT_EQ(both.hosts.clock(i).read(at_ms(ms)), time.hosts.clock(i).read(at_ms(ms)));
      EXPECT_EQ(both.hosts.clock(i).steady(at_ms(ms)), time.hosts.clock(i).steady(at_ms(ms)));
    }
  }
}

TEST(HostGroupTest, ClocksAreOnRecordBeforeTheyAreAdjusted) {
  SimWorld world(scattered(3));
  world.hosts.report_clocks();
  ASSERT_EQ(world.record.adjustments.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(world.record.adjustments[i].host, i);
    EXPECT_EQ(world.record.adjustments[i].at, world.hosts.clock(i).steady(TrueTime{}));
    EXPECT_EQ(ms_of(world.record.adjustments[i].after), offset_ms(world, i));
  }
}

Task<void> chat(SimWorld& world, std::size_t host, PeerId peer, int count) {
  MessageChannel& channel = world.host(host).open_channel(peer, Transport::kStream);
  for (int i = 0; i < count; ++i) {
    if (host == 0) co_await channel.send(Bytes(8));
    const std::optional<ReceivedMessage> got =
        co_await channel.receive(world.host(host).steady_clock().now() + from_ms(1000));
    EXPECT_TRUE(got);
    if (host != 0) co_await channel.send(Bytes(8));
  }
}

TEST(HostGroupTest, TheSameSeedMakesTheSameEventsAndAnotherSeedOthers) {
  scenarios::Scenario scenario = scattered(4);
  scenario.network.latency_exponential_ms = 0.1;
  scenario.hosts.send_cost_exponential_ms = 0.01;
  const auto trace_hash = [&](std::uint64_t seed) {
    SimWorld world(scenario, seed);
    for (PeerId slave = 1; slave < 4; ++slave) {
      world.spawn(chat(world, slave, 0, 20));
      world.spawn(chat(world, 0, slave, 20));
    }
    world.engine.run();
    return world.engine.trace_hash();
  };
  EXPECT_EQ(trace_hash(1), trace_hash(1));
  EXPECT_NE(trace_hash(1), trace_hash(2));
}

}  // namespace
}  // namespace simbench::sim

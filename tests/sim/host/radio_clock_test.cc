#include "sim/host/radio_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/host_sync/wifi/wifi_time.h"
#include "tests/nonempty.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

constexpr scenarios::DelayLaw fixed_us(double us) { return {.fixed_us = us, .exponential_us = 0}; }

// Host 0 is the access point. Clocks are exact, radios too unless a test says otherwise.
scenarios::Scenario radio_hosts(std::int64_t count = 2) {
  scenarios::Scenario s = ideal_hosts(count);
  scenarios::Wifi wifi{};
  wifi.access_point_host = 0;
  wifi.rate_mbit_per_s = 54;
  wifi.basic_rate_mbit_per_s = 6;
  wifi.sifs_us = 10;
  wifi.retry_limit = 7;
  wifi.tsf.emplace();
  wifi.tsf->read_before = fixed_us(100);
  wifi.tsf->read_after = fixed_us(100);
  wifi.ftm.emplace();
  wifi.ftm->exchanges = 31;
  wifi.ftm->session_ms = 1000;
  s.network.wifi = wifi;
  return s;
}

Task<void> read_often(Host& host, int count, Nanoseconds pause, std::vector<TsfReading>& readings) {
  for (int i = 0; i < count; ++i) {
    const std::optional<TsfReading> reading = co_await host.radio_clock()->read_tsf();
    if (reading) readings.push_back(*reading);
    co_await host.sleep_for(pause);
  }
}

// A copy's reading less the access point's counter in the middle of the call, in us.
std::vector<double> errors_us(const scenarios::Scenario& s, int count, std::uint64_t seed) {
  SimWorld world(s, seed);
  std::vector<TsfReading> readings;
  world.spawn(read_often(world.host(1), count, from_ms(37), readings));
  world.engine.run();
  const std::deque<SystemClock>& clocks = world.hosts.all_clocks();
  const AccessPoint access_point(*world.scenario.network.wifi, seed, clocks);
  std::vector<double> errors;
  for (const TsfReading& reading : readings) {
    const SteadyTime middle = reading.before + (reading.after - reading.before) / 2;
    const TrueTime at = world.hosts.clock(1).when(middle);
    errors.push_back(to_ns(reading.tsf - access_point.at(at)) * 1e-3);
  }
  return errors;
}

double mean_us(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_us(const std::vector<double>& values) {
  const double mean = mean_us(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(RadioClock, ExactRadiosReadTheAccessPointsCounter) {
  for (const double error : nonempty(errors_us(radio_hosts(), 20, 1))) EXPECT_NEAR(error, 0, 0.002);
}

TEST(RadioClock, HostsOnTheWireAndWiredNetworksHaveNone) {
  scenarios::Scenario s = radio_hosts(3);
  s.network.wifi->wired_hosts = {2};
  SimWorld world(s);
  EXPECT_TRUE(world.host(0).radio_clock()->is_access_point());
  EXPECT_FALSE(world.host(1).radio_clock()->is_access_point());
  EXPECT_EQ(world.host(2).radio_clock(), nullptr);
  EXPECT_EQ(SimWorld(ideal_hosts()).host(0).radio_clock(), nullptr);
}

// The call's two parts differ by E1 - E2; its middle is wrong by half of that.
TEST(RadioClock, AnUnequalCallIsHalfOfTheDifferenceWrong) {
  scenarios::Scenario s = radio_hosts();
  s.network.wifi->tsf->read_before = fixed_us(250);
  s.network.wifi->tsf->read_after = fixed_us(50);
  EXPECT_NEAR(mean_us(errors_us(s, 20, 1)), 100, 0.01);
  s.network.wifi->tsf->read_before = {.fixed_us = 96, .exponential_us = 53};
  s.network.wifi->tsf->read_after = {.fixed_us = 96, .exponential_us = 53};
  const std::vector<double> errors = errors_us(s, 4000, 5);
  EXPECT_NEAR(mean_us(errors), 0, 5 * 37.5 / std::sqrt(4000.0)) << "seed 5";
  EXPECT_NEAR(deviation_us(errors), 53 / std::sqrt(2.0), 3) << "seed 5";
}

// Rounded down twice, at the beacon and at the reading: a half each on average. Beacons are whole
// microseconds apart, so one seed has one rest; many seeds have all.
TEST(RadioClock, CopiesAreInWholeMicroseconds) {
  scenarios::Scenario s = radio_hosts();
  s.network.wifi->tsf->resolution_us = 1;
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    errors.push_back(errors_us(s, 1, seed).at(0));
    EXPECT_GT(errors.back(), -2.001) << seed;
    EXPECT_LT(errors.back(), 0.001) << seed;
  }
  EXPECT_NEAR(mean_us(errors), -1, 5 * std::sqrt(2.0 / 12 / 400)) << "seeds 1-400";
}

TEST(RadioClock, CopiesDriftBetweenBeacons) {
  scenarios::Scenario s = radio_hosts();
  s.hosts.clock.skew_of_host_ppm = {0, 10};
  // Half of 102.4 ms at 10 ppm.
  EXPECT_NEAR(mean_us(errors_us(s, 2000, 3)), 0.512, 0.03) << "seed 3";
}

TEST(RadioClock, ErrorsOfBeaconsHaveTheirLaw) {
  scenarios::Scenario s = radio_hosts();
  s.network.wifi->tsf->beacon_stamp_sigma_us = 3;
  s.network.wifi->tsf->receive_sigma_us = 4;
  EXPECT_NEAR(deviation_us(errors_us(s, 4000, 7)), 5, 0.5) << "seed 7";
  s.network.wifi->tsf->beacon_loss_probability = 1;
  EXPECT_TRUE(errors_us(s, 3, 7).empty());
}

Task<void> measure(Host& host, int sessions, std::vector<std::vector<FtmExchange>>& all) {
  for (int i = 0; i < sessions; ++i) {
    std::vector<FtmExchange> exchanges = co_await host.radio_clock()->measure_ftm();
    all.push_back(std::move(exchanges));
  }
}

std::vector<std::vector<FtmExchange>> sessions_of(const scenarios::Scenario& s, int sessions,
                                                  std::uint64_t seed) {
  SimWorld world(s, seed);
  std::vector<std::vector<FtmExchange>> all;
  world.spawn(measure(world.host(1), sessions, all));
  world.engine.run();
  return all;
}

// Mean of a session's offsets, against those of exact radios.
double session_error_ns(const scenarios::Scenario& s, std::uint64_t seed) {
  const auto of = [seed](const scenarios::Scenario& world) {
    double sum = 0;
    const std::vector<FtmExchange> exchanges = sessions_of(world, 1, seed).front();
    for (const FtmExchange& exchange : exchanges) {
      sum += static_cast<double>(
                 exchange.t1.time_since_epoch().count() - exchange.t2.time_since_epoch().count() +
                 exchange.t4.time_since_epoch().count() - exchange.t3.time_since_epoch().count()) /
             2;
    }
    return sum / static_cast<double>(exchanges.size());
  };
  return of(s) - of(radio_hosts());
}

TEST(Ftm, NoiseFallsWithTheExchangesAndBiasStays) {
  scenarios::Scenario s = radio_hosts();
  s.network.wifi->ftm->stamp_sigma_ns = 100;
  std::vector<double> noise;
  std::vector<double> bias;
  constexpr int kSeeds = 400;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    s.network.wifi->ftm->calibration_sigma_ns = 0;
    noise.push_back(session_error_ns(s, seed));
    scenarios::Scenario biased = radio_hosts();
    biased.network.wifi->ftm->calibration_sigma_ns = 1000;
    bias.push_back(session_error_ns(biased, seed));
  }
  const double within = 5 / std::sqrt(2.0 * kSeeds);
  const double expected_ns = 100 / std::sqrt(2.0 * 31);
  EXPECT_NEAR(deviation_us(noise), expected_ns, expected_ns * within) << "seeds 1-400";
  EXPECT_NEAR(deviation_us(bias), 1000 / std::sqrt(2.0), 707 * within) << "seeds 1-400";
}

TEST(Ftm, SessionsAndExchangesAreLost) {
  scenarios::Scenario s = radio_hosts();
  s.network.wifi->ftm->exchange_loss_probability = 0.25;
  std::size_t exchanges = 0;
  for (const auto& session : nonempty(sessions_of(s, 200, 2))) exchanges += session.size();
  EXPECT_NEAR(static_cast<double>(exchanges) / (200 * 31), 0.75, 0.03) << "seed 2";
  s.network.wifi->ftm->session_loss_probability = 1;
  EXPECT_TRUE(sessions_of(s, 1, 2).front().empty());
}

TEST(Ftm, TheSameSeedGivesTheSameStamps) {
  scenarios::Scenario s = radio_hosts();
  s.network.wifi->ftm->stamp_sigma_ns = 5;
  const auto once = sessions_of(s, 2, 9);
  const auto again = sessions_of(s, 2, 9);
  ASSERT_EQ(once.at(1).size(), 31U);
  EXPECT_EQ(once.at(1).at(7).t2, again.at(1).at(7).t2);
  EXPECT_NE(once.at(1).at(7).t2, sessions_of(s, 2, 10).at(1).at(7).t2);
}

}  // namespace
}  // namespace simbench::sim

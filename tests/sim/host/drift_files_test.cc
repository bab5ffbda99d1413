#include "sim/host/drift_files.h"

#include <gtest/gtest.h>

#include <cmath>

#include "algorithms/host_sync/chrony/chrony.h"
#include "algorithms/host_sync/ntp/ntp_service.h"
#include "tests/sim/host/service_world.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

// Latencies of 0.1 ms, skews of -10, 25 and 40 ppm and no noise.
scenarios::Scenario skewed() {
  scenarios::Scenario scenario = ideal_hosts(3);
  scenario.network.latency_fixed_ms = 0.1;
  scenario.hosts.clock.oscillator.wander_step_ms = 1000;
  scenario.hosts.clock.skew_of_host_ppm = {-10, 25, 40};
  return scenario;
}

scenarios::Scenario with_file(scenarios::Scenario scenario, double age_h, double error_ppb) {
  scenario.hosts.drift_file = scenarios::DriftFile{.age_h = age_h, .error_ppb = error_ppb};
  return scenario;
}

TEST(DriftFiles, AreNotThereUnlessStated) {
  SimWorld world(skewed());
  EXPECT_FALSE(world.host(1).stored_frequency().has_value());
}

TEST(DriftFiles, AnExactOneKeepsTheClockWithTheMasters) {
  SimWorld world(with_file(skewed(), 5, 0));
  for (std::size_t slave = 1; slave < 3; ++slave) {
    const auto stored = world.host(slave).stored_frequency();
    ASSERT_TRUE(stored.has_value());
    EXPECT_EQ(stored->error_ppb, 0);
    SystemClock& clock = world.hosts.clock(slave);
    clock.adjust_frequency(world.now(), stored->ppb);
    const TrueTime then = at_ms(10 * 3.6e6);
    EXPECT_NEAR(ms_of(clock.read(then)), ms_of(world.hosts.clock(0).read(then)), 3e-6);
  }
}

// The standard deviation of the stored frequencies of many hosts about the exact one, in ppb.
double spread_ppb(scenarios::Scenario scenario) {
  constexpr std::int64_t kHosts = 2001;
  scenario.hosts.count = kHosts;
  scenario.hosts.clock.skew_of_host_ppm.assign(kHosts, 0);
  SimWorld world(scenario);
  double squares = 0;
  for (std::size_t host = 1; host < kHosts; ++host) {
    squares += std::pow(world.host(host).stored_frequency()->ppb, 2);
  }
  return std::sqrt(squares / (kHosts - 1));
}

TEST(DriftFiles, AreWrongByTheirError) {
  EXPECT_NEAR(spread_ppb(with_file(skewed(), 0, 30)), 30, 5 * 30 / std::sqrt(2 * 2000));
}

TEST(DriftFiles, AreWrongByWhatTheFrequencyHasWalkedSince) {
  scenarios::Scenario scenario = with_file(skewed(), 9, 0);
  scenario.hosts.clock.oscillator.random_walk_ppb_per_sqrt_s = 2;
  scenario.hosts.clock.oscillator.wander_step_ms = 100'000;
  // The walk since the file was written, and the hour's mean before the start, whose variance
  // about the end of the hour, where the walk is 0, is K^2 h / 3, of host and master.
  const double since = 2 * std::sqrt(9 * 3600.0);
  scenario.hosts.master_is_exact = true;
  const double hour = 2 * std::sqrt(3600 / 3.0);
  const double expected = std::hypot(since, hour);
  EXPECT_NEAR(spread_ppb(scenario), expected, 5 * expected / std::sqrt(2 * 2000));
}

TEST(DriftFiles, AreWrongByTheTemperatureOfTheirTime) {
  scenarios::Scenario scenario = skewed();
  scenario.hosts.master_is_exact = true;
  scenario.hosts.clock.skew_of_host_ppm = {0, 0, 0};
  scenario.hosts.clock.oscillator.temperature_coefficient_ppb_per_k = 100;
  scenario.hosts.temperature = scenarios::Temperature{.day_amplitude_k = 3,
                                                      .day_period_h = 24,
                                                      .load_amplitude_k = 0,
                                                      .load_period_s = 1,
                                                      .load_time_constant_s = 0,
                                                      .fan_amplitude_k = 0,
                                                      .fan_period_s = 1};
  SimWorld now(with_file(scenario, 0, 0));
  SimWorld half_a_day_ago(with_file(scenario, 12, 0));
  SimWorld a_day_ago(with_file(scenario, 24, 0));
  for (std::size_t slave = 1; slave < 3; ++slave) {
    const OscillatorModel& oscillator = now.hosts.clock(slave).oscillator();
    const double warm =
        oscillator.mean_frequency(now.now() - std::chrono::hours(1), now.now()) * 1e9;
    EXPECT_GT(std::abs(warm), 1);
    EXPECT_NEAR(now.host(slave).stored_frequency()->ppb, -warm, 1e-3);
    EXPECT_NEAR(half_a_day_ago.host(slave).stored_frequency()->ppb, warm, 1e-3);
    EXPECT_NEAR(a_day_ago.host(slave).stored_frequency()->ppb, -warm, 1e-3);
  }
}

// The largest error of a slave in the first five minutes, in seconds.
template <class Service, class Settings>
double worst_start_s(const scenarios::Scenario& scenario) {
  ServiceWorld world(scenario);
  Service service{Settings{}};
  world.start(service);
  double worst_s = 0;
  world.watch(300, 1, [&](double) {
    for (std::size_t slave = 1; slave < 3; ++slave) {
      worst_s = std::max(worst_s, std::abs(world.error_s(slave)));
    }
  });
  return worst_s;
}

TEST(DriftFiles, ServicesStartWithThem) {
  // 50 ppm against the master are 3.2 ms at the second regular poll.
  EXPECT_GT((worst_start_s<ChronyService, ChronySettings>(skewed())), 50e-6);
  EXPECT_GT((worst_start_s<NtpService, NtpSettings>(skewed())), 1e-3);
  const scenarios::Scenario warm = with_file(skewed(), 1, 0);
  EXPECT_LT((worst_start_s<ChronyService, ChronySettings>(warm)), 1e-6);
  EXPECT_LT((worst_start_s<NtpService, NtpSettings>(warm)), 1e-6);
}

}  // namespace
}  // namespace simbench::sim

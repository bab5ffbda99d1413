
#include "sim/host/leap_second.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "algorithms/host_sync/chrony/chrony.h"
#include "algorithms/host_sync/ntp/ntp_service.h"
#include "tests/sim/host/service_world.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

scenarios::Scenario with_leap(double at_ms, double smear_ms, bool inserted = true) {
  scenarios::Scenario scenario = ideal_hosts(3);
  scenario.hosts.clock.oscillator.wander_step_ms = 1000;
  scenario.hosts.clock.skew_of_host_ppm = {0, 0, 0};
  scenario.faults = {
      scenarios::LeapSecond{.at_ms = at_ms, .smear_ms = smear_ms, .inserted = inserted}};
  return scenario;
}

// How far a clock is ahead of true time, in ms.
double ahead_ms(SimWorld& world, std::size_t host) {
  return world.hosts.clock(host).ahead_ns(world.now()) * 1e-6;
}

void run_until(SimWorld& world, double ms) { world.engine.run_until(at_ms(ms)); }

TEST(LeapSecond, EachClockStepsWhenItReadsTheInstant) {
  scenarios::Scenario scenario = with_leap(5000, 0);
  scenario.hosts.clock.initial_offset_of_host_ms = {0, 300, -400};
  SimWorld world(scenario);
  world.hosts.begin_faults();
  run_until(world, 4699);
  EXPECT_NEAR(ahead_ms(world, 1), 300, 1e-6);
  run_until(world, 4701);
  EXPECT_NEAR(ahead_ms(world, 1), 300 - 1000, 1e-6);
  EXPECT_NEAR(ahead_ms(world, 0), 0, 1e-6);
  run_until(world, 5001);
  EXPECT_NEAR(ahead_ms(world, 0), -1000, 1e-6);
  EXPECT_NEAR(ahead_ms(world, 2), -400, 1e-6);
  run_until(world, 5401);
  EXPECT_NEAR(ahead_ms(world, 2), -400 - 1000, 1e-6);
  world.engine.run();
  for (std::size_t host = 0; host < 3; ++host) {
    EXPECT_NEAR(ahead_ms(world, host), scenario.hosts.clock.initial_offset_of_host_ms[host] - 1000,
                1e-6);
  }
}

TEST(LeapSecond, OneThatIsLeftOutIsSkipped) {
  SimWorld world(with_leap(5000, 0, false));
  world.hosts.begin_faults();
  run_until(world, 6000);
  EXPECT_NEAR(ahead_ms(world, 0), 1000, 1e-6);
}

TEST(LeapSecond, InstantsCountFromTheBeginOfTheFaults) {
  SimWorld world(with_leap(5000, 0));
  run_until(world, 2000);
  world.hosts.begin_faults();
  run_until(world, 6999);
  EXPECT_NEAR(ahead_ms(world, 0), 0, 1e-6);
  run_until(world, 7001);
  EXPECT_NEAR(ahead_ms(world, 0), -1000, 1e-6);
}

TEST(LeapSecond, ASmearIsEvenAndEnds) {
  for (const bool inserted : {true, false}) {
    const double second_ms = inserted ? -1000 : 1000;
    SimWorld world(with_leap(5000, 100'000, inserted));
    world.hosts.begin_faults();
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
      run_until(world, 5000 + share * 100'000);
      EXPECT_NEAR(ahead_ms(world, 1), share * second_ms, 2e-6) << share;
    }
    run_until(world, 200'000);
    EXPECT_NEAR(ahead_ms(world, 1), second_ms, 2e-6);
  }
}

TEST(LeapSecond, SettingsAndSlewsOfProgramsGoOn) {
  for (const double smear_ms : {0.0, 100'000.0}) {
    SimWorld world(with_leap(5000, smear_ms));
    world.hosts.begin_faults();
    run_until(world, 4000);
    world.hosts.clock(1).slew(world.now(), from_ms(2), 500'000);  // takes 4 s
    run_until(world, 6000);
    world.hosts.clock(1).adjust_frequency(world.now(), 10'000);  // 10 ppm
    run_until(world, 206'000);
    EXPECT_NEAR(ahead_ms(world, 1), -1000 + 2 + 200'000 * 10e-6, 2e-5) << smear_ms;
    run_until(world, 306'000);
    EXPECT_NEAR(ahead_ms(world, 1), -1000 + 2 + 300'000 * 10e-6, 2e-5) << smear_ms;
  }
}

// A LAN with quartzes and hosts up to 40 ppm off, and a leap second after two hours.
scenarios::Scenario serviced(double smear_ms) {
  scenarios::Scenario scenario = with_leap(2 * 3.6e6, smear_ms);
  scenario.network.latency_fixed_ms = 0.1;
  scenario.network.latency_exponential_ms = 0.02;
  scenario.hosts.clock.skew_of_host_ppm = {3, -10, 40};
  scenario.hosts.clock.initial_offset_of_host_ms = {0, 20, -30};
  return scenario;
}

template <class Service, class Settings>
void expect_sync_for_hours(double smear_ms) {
  ServiceWorld world(serviced(smear_ms));
  Service service{Settings{}};
  world.start(service);
  world.begin_faults();
  const auto worst_s = [&](double from_s, double to_s) {
    world.run_until(from_s);
    double worst = 0;
    world.watch(to_s, 10, [&](double) {
      for (std::size_t slave = 1; slave < 3; ++slave) {
        worst = std::max(worst, std::abs(world.error_s(slave)));
      }
    });
    return worst;
  };
  EXPECT_LT(worst_s(3600 + 1800, 7190), 1e-3);
  // The second itself: for as long as two clocks differ, they differ by it.
  EXPECT_LT(worst_s(7210, 4 * 3600), 1e-3) << "smear " << smear_ms;
  EXPECT_NEAR(world.clock(0).ahead_ns(world.now()) * 1e-9, -1 + 3e-6 * 4 * 3600, 1e-4);
}

TEST(LeapSecond, ServicesStayInSyncThroughIt) {
  for (const double smear_ms : {0.0, 3.6e6}) {
    expect_sync_for_hours<ChronyService, ChronySettings>(smear_ms);
    expect_sync_for_hours<NtpService, NtpSettings>(smear_ms);
  }
}

// The 32 bits of an NTP time stamp's seconds end in 2036.
template <class Service, class Settings>
double worst_through_the_end_of_the_era_s() {
  constexpr std::chrono::seconds kEraEnd(2'085'978'496);  // since 1970: 2^32 s since 1900
  scenarios::Scenario scenario = serviced(0);
  scenario.faults.clear();
  ServiceWorld world(scenario);
  for (std::size_t host = 0; host < 3; ++host) {
    SystemClock& clock = world.clock(host);
    const Nanoseconds offset = clock.read(world.now()).time_since_epoch();
    clock.set(world.now(), HostTime(kEraEnd - std::chrono::hours(2)) + offset);
  }
  Service service{Settings{}};
  world.start(service);
  world.run_until(5400);
  double worst_s = 0;
  world.watch(4 * 3600, 10, [&](double) {
    for (std::size_t slave = 1; slave < 3; ++slave) {
      worst_s = std::max(worst_s, std::abs(world.error_s(slave)));
    }
  });
  EXPECT_GT(world.clock(1).read(world.now()), HostTime(kEraEnd + std::chrono::hours(1)));
  return worst_s;
}

TEST(LeapSecond, ServicesStayInSyncThroughTheEndOfAnNtpEra) {
  EXPECT_LT((worst_through_the_end_of_the_era_s<ChronyService, ChronySettings>()), 1e-3);
  EXPECT_LT((worst_through_the_end_of_the_era_s<NtpService, NtpSettings>()), 1e-3);
}

}  // namespace
}  // namespace simbench::sim

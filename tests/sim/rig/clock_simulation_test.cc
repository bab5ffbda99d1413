#include "sim/rig/clock_simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/host_sync/ptp/ptp.h"
#include "algorithms/parameters.h"
#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "recording/recording.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"
#include "tests/sim/rig/test_world.h"

namespace simbench::sim {
namespace {

using std::chrono::seconds;

constexpr double kNanosecond = 1e-9;

struct KeptReadings final : ClockSink {
  struct Reading {
    double at_s;
    std::vector<double> errors_s;
  };
  void on_errors(TrueTime at, std::span<const double> errors_s) override {
    readings.push_back({to_seconds(at.time_since_epoch()), {errors_s.begin(), errors_s.end()}});
  }
  void on_outcome(const SyncOutcome& outcome) override { outcomes.push_back(outcome); }
  // The errors of the reading at that second, which must exist.
  const std::vector<double>& at(double second) const {
    for (const Reading& reading : readings) {
      if (std::abs(reading.at_s - second) < kNanosecond) return reading.errors_s;
    }
    throw std::out_of_range("no such reading");
  }
  std::vector<Reading> readings;
  std::vector<SyncOutcome> outcomes;
};

struct Kept {
  KeptReadings clocks;
  ClockCost cost;
};

Kept read_clocks(const scenarios::Scenario& scenario, const ClockRequest& request) {
  Kept kept;
  kept.cost = make_clock_simulation(scenario)->run(request, kept.clocks);
  return kept;
}

// Three hosts without noise, whose slaves are 30 ppm fast and 12.5 ppm slow of the master.
scenarios::Scenario three_hosts() {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.hosts.count = 3;
  scenario.cameras.count = 3;
  scenario.hosts.clock.skew_of_host_ppm = {-5, 25, -17.5};
  scenario.hosts.clock.initial_offset_of_host_ms = {0, 250, -1.5};
  return scenario;
}

constexpr double kFast = 30e-6;
constexpr double kSlow = -12.5e-6;

TEST(ClockSimulation, FreeClocksDriftApartByTheirSkews) {
  const Kept kept = read_clocks(
      three_hosts(), {.pipeline = "free", .duration = seconds(3600), .interval = seconds(1)});
  ASSERT_EQ(kept.clocks.readings.size(), 3601U);
  double t = 0;
  for (const auto& reading : kept.clocks.readings) {
    EXPECT_DOUBLE_EQ(reading.at_s, t);
    ASSERT_EQ(reading.errors_s.size(), 3U);
    EXPECT_EQ(reading.errors_s[0], 0);
    EXPECT_NEAR(reading.errors_s[1], 0.25 + kFast * t, kNanosecond);
    EXPECT_NEAR(reading.errors_s[2], -0.0015 + kSlow * t, kNanosecond);
    t += 1;
  }
  EXPECT_EQ(kept.cost.messages, 0U);
}

// What a clock refuses is the algorithm's mistake, and the message says whose.
TEST(ClockSimulation, AnAdjustmentBeyondTheLimitNamesHostAndAlgorithm) {
  scenarios::Scenario scenario = three_hosts();
  scenario.pipelines = {{.name = "mine",
                         .host_sync = "too_fast",
                         .device_time = "raw_arrival",
                         .gathering = "genlock"}};
  const auto refusal = [&scenario](Service::Program program) -> std::string {
    Service service(std::move(program));
    try {
      read_clocks(scenario, {.pipeline = "mine",
                             .host_sync = &service,
                             .duration = seconds(10),
                             .interval = seconds(1)});
    } catch (const scenarios::InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(refusal([](Host& host) -> Task<void> {
              if (host.id() == 2) co_await host.clock().slew(from_ms(1), 6e8);
            }),
            "host_sync too_fast on host 2: clock: found a rate of 600000000 ppb, allowed less than "
            "500000000 ppb in either direction");
  EXPECT_EQ(refusal([](Host& host) -> Task<void> {
              if (host.id() == 0) co_await host.clock().slew(from_ms(1), -5);
            }),
            "host_sync too_fast on host 0: clock: found a slew at -5 ppb, allowed a rate above 0");
  EXPECT_THAT(
      refusal([](Host& host) -> Task<void> { co_await host.clock().adjust_frequency(1e12); }),
      testing::HasSubstr("on host 1: clock: found a rate of 1"));
}

TEST(ClockSimulation, AnExactMasterIsTrueTime) {
  scenarios::Scenario scenario = three_hosts();
  scenario.hosts.master_is_exact = true;
  scenario.hosts.clock.skew_of_host_ppm = {0, 25, -17.5};
  const Kept kept = read_clocks(
      scenario, {.pipeline = "free", .duration = seconds(100), .interval = seconds(100)});
  EXPECT_NEAR(kept.clocks.at(100)[1], 0.25 + 25e-4, kNanosecond);
}

// In steps of 1 ms a skew of 1 ppb moves the clock by 1 fs.
TEST(ClockSimulation, PartsOfANanosecondAreKept) {
  scenarios::Scenario scenario = three_hosts();
  scenario.hosts.clock.skew_of_host_ppm = {0, 1e-3, -1e-3};
  scenario.hosts.clock.initial_offset_of_host_ms = {0, 0, 0};
  const Kept kept = read_clocks(
      scenario,
      {.pipeline = "free", .duration = seconds(2), .interval = std::chrono::milliseconds(1)});
  ASSERT_EQ(kept.clocks.readings.size(), 2001U);
  for (const auto& reading : kept.clocks.readings) {
    EXPECT_NEAR(reading.errors_s[1], 1e-9 * reading.at_s, 1e-15);
    EXPECT_NEAR(reading.errors_s[2], -1e-9 * reading.at_s, 1e-15);
  }
}

std::unique_ptr<HostSync> algorithm(const std::string& name) {
  const HostSyncEntry* const entry = find_algorithm<HostSyncEntry>(name);
  return entry->make(check_parameters(entry->info.parameters, {}));
}

// How long after the master's clock has jumped by 50 ms all slaves are within 1 ms of it.
double recovery_s(const std::string& name, const scenarios::Scenario& world) {
  constexpr double kStepS = 300;
  scenarios::Scenario scenario = world;
  scenario.faults.emplace_back(
      scenarios::ClockStep{.host = 0, .at_ms = kStepS * 1e3, .step_ms = 50});
  const auto sync = algorithm(name);
  const Kept kept = read_clocks(scenario, {.pipeline = name,
                                           .host_sync = sync.get(),
                                           .duration = seconds(600),
                                           .interval = seconds(1)});
  double last_s = kStepS;
  for (const auto& reading : kept.clocks.readings) {
    if (reading.at_s < kStepS) continue;
    for (const double error_s : reading.errors_s) {
      if (std::abs(error_s) > 1e-3) last_s = reading.at_s;
    }
  }
  return last_s - kStepS;
}

scenarios::Scenario with_cards(double max_adjustment_ppm) {
  scenarios::Scenario scenario = three_hosts();
  scenario.hosts.nic = {.hardware_stamps = true,
                        .skew_sigma_ppm = 0,
                        .stamp_resolution_ns = 1,
                        .stamp_jitter_sigma_ns = 0,
                        .max_adjustment_ppm = max_adjustment_ppm,
                        .cross_stamp_cost_ms = 0.004};
  return scenario;
}

// Debian's ptp4l and phc2sys take 15 s. With 500 ppm, as adjtimex(2) has it without the tick, the
// 49 ms until then take 98 s.
TEST(ClockSimulation, AfterAStepOfTheMasterClocksAreSteeredAsFarAsTheyGo) {
  EXPECT_LT(recovery_s("ptp_e2e_hardware", with_cards(62'499.999)), 25);
  EXPECT_GT(recovery_s("ptp_e2e_hardware", with_cards(500)), 97);
  EXPECT_LT(recovery_s("sptp_hardware", with_cards(62'499.999)), 60);
}

// Where calls cost nothing, a probe leaves in the very instant of its call.
TEST(ClockSimulation, HuygensNeedsNoCallThatCosts) {
  const scenarios::Scenario star = scenarios::load_scenario("6host_star");
  ASSERT_EQ(star.hosts.send_cost_ms, 0);
  const auto sync = algorithm("huygens_software");
  const Kept kept = read_clocks(star, {.pipeline = "huygens_software",
                                       .host_sync = sync.get(),
                                       .duration = seconds(90),
                                       .interval = seconds(10)});
  for (const double error_s : nonempty(kept.clocks.at(90))) EXPECT_LT(std::abs(error_s), 0.2e-3);
}

TEST(ClockSimulation, ClocksAreReadUpToTheEnd) {
  const auto ends = [](const ClockRequest& request) {
    const Kept kept = read_clocks(three_hosts(), request);
    return kept.clocks.readings.back().at_s;
  };
  EXPECT_EQ(ends({.duration = seconds(10), .interval = seconds(1)}), 10);
  EXPECT_EQ(ends({.duration = seconds(10), .interval = seconds(3)}), 9);
  EXPECT_EQ(ends({.duration = seconds(10), .interval = seconds(1), .recovery = seconds(9)}), 10)
      << "nothing to recover from";
  EXPECT_EQ(ends({.duration = seconds(10),
                  .interval = seconds(1),
                  .master_lost_for = seconds(20),
                  .recovery = seconds(5)}),
            35);
}

TEST(ClockSimulation, AClockStepMovesItsHostFromItsInstantOn) {
  scenarios::Scenario scenario = three_hosts();
  scenario.faults = {scenarios::ClockStep{.host = 1, .at_ms = 10'500, .step_ms = -40},
                     scenarios::ClockStep{.host = 0, .at_ms = 20'000, .step_ms = 3}};
  const Kept kept =
      read_clocks(scenario, {.pipeline = "free", .duration = seconds(30), .interval = seconds(1)});
  for (const auto& reading : nonempty(kept.clocks.readings)) {
    const double t = reading.at_s;
    const double of_master = t >= 20 ? 0.003 : 0;
    // A step counts from a reading, which has whole nanoseconds.
    EXPECT_NEAR(reading.errors_s[1], 0.25 + kFast * t - (t > 10 ? 0.04 : 0) - of_master,
                2 * kNanosecond);
    EXPECT_NEAR(reading.errors_s[2], -0.0015 + kSlow * t - of_master, kNanosecond);
  }
}

// Sets the slaves' clocks once a second to what the master says, and its 0.1 ms of way.
Task<void> tell_time(Host& master) {
  for (;;) {
    const HostTime now = co_await master.clock().now();
    for (const PeerId slave : {1U, 2U}) {
      Bytes text(sizeof(HostTime::rep));
      auto ns = static_cast<std::uint64_t>(nanoseconds_of(now));
      for (std::byte& byte : text) {
        byte = static_cast<std::byte>(ns & 0xFFU);
        ns >>= 8U;
      }
      co_await master.open_channel(slave, Transport::kDatagram).send(std::move(text));
    }
    co_await master.sleep_for(seconds(1));
  }
}

Task<void> take_time(Host& slave) {
  MessageChannel& channel = slave.open_channel(0, Transport::kDatagram);
  for (;;) {
    const auto message = co_await channel.receive(kNoDeadline);
    std::uint64_t ns = 0;
    for (std::size_t i = message->bytes.size(); i-- > 0;) {
      ns = (ns << 8U) | std::to_integer<std::uint64_t>(message->bytes[i]);
    }
    co_await slave.clock().set(HostTime(Nanoseconds(static_cast<std::int64_t>(ns)) + from_ms(0.1)));
  }
}

Service told_time() {
  return Service([](Host& host) { return host.id() == 0 ? tell_time(host) : take_time(host); });
}

TEST(ClockSimulation, ClocksRunFreeWhileTheMasterIsLostAndRecoverAfterwards) {
  Service service = told_time();
  const Kept kept = read_clocks(three_hosts(), {.pipeline = "told",
                                                .host_sync = &service,
                                                .duration = seconds(300),
                                                .interval = seconds(1),
                                                .master_lost_for = seconds(600),
                                                .recovery = seconds(100)});
  ASSERT_EQ(kept.clocks.readings.size(), 1001U);
  // Set within the last second, by messages of 0.1 ms and rates of some ppm.
  constexpr double kSynchronised = 35e-6;
  for (const auto& reading : kept.clocks.readings) {
    SCOPED_TRACE(reading.at_s);
    const double since_loss_s = reading.at_s - 300;
    if (reading.at_s < 1) continue;
    if (since_loss_s < 0.5 || since_loss_s > 600.5) {
      EXPECT_LT(std::abs(reading.errors_s[1]), kSynchronised);
      EXPECT_LT(std::abs(reading.errors_s[2]), kSynchronised);
    } else {
      EXPECT_NEAR(reading.errors_s[1], kFast * since_loss_s, kSynchronised);
      EXPECT_NEAR(reading.errors_s[2], kSlow * since_loss_s, kSynchronised);
    }
  }
}

TEST(ClockSimulation, WithoutALossTheMasterIsThere) {
  Service service = told_time();
  const Kept kept = read_clocks(three_hosts(), {.pipeline = "told",
                                                .host_sync = &service,
                                                .duration = seconds(400),
                                                .interval = seconds(1)});
  EXPECT_LT(std::abs(kept.clocks.at(400)[1]), 35e-6);
}

TEST(ClockSimulation, MessagesCountThatLeaveBeforeTheLossOfTheMaster) {
  // At 0, 1 ... 59 s of a clock that is 5 ppm slow: each a little later, to both slaves.
  for (const Nanoseconds lost : {Nanoseconds(0), Nanoseconds(seconds(50))}) {
    Service service = told_time();
    const Kept kept = read_clocks(three_hosts(), {.pipeline = "told",
                                                  .host_sync = &service,
                                                  .duration = seconds(60),
                                                  .interval = seconds(1),
                                                  .master_lost_for = lost,
                                                  .recovery = seconds(10)});
    EXPECT_EQ(kept.cost.messages, 120U);
  }
}

struct Sync {
  std::string scenario;
  std::string host_sync;
};

Kept synchronised(const Sync& sync, std::uint64_t seed, Nanoseconds duration = seconds(600)) {
  const scenarios::Scenario scenario = scenarios::load_scenario(sync.scenario);
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(sync.host_sync);
  const auto algorithm = entry->make(check_parameters(entry->info.parameters, {}));
  return read_clocks(scenario, {.seed = seed,
                                .pipeline = sync.host_sync,
                                .host_sync = algorithm.get(),
                                .duration = duration,
                                .interval = seconds(1),
                                .master_lost_for = seconds(60),
                                .recovery = seconds(60)});
}

void expect_equal(const Kept& a, const Kept& b) {
  EXPECT_EQ(a.cost.events, b.cost.events);
  EXPECT_EQ(a.cost.messages, b.cost.messages);
  EXPECT_EQ(a.cost.trace_hash, b.cost.trace_hash);
  ASSERT_EQ(a.clocks.readings.size(), b.clocks.readings.size());
  for (std::size_t i = 0; i < a.clocks.readings.size(); ++i) {
    ASSERT_EQ(a.clocks.readings[i].errors_s, b.clocks.readings[i].errors_s) << "reading " << i;
  }
}

const std::vector<Sync> kSyncs = {{"6host_star", "chrony"},
                                  {"6host_star", "ptp_e2e_software"},
                                  {"6host_lan_day", "ntp"},
                                  {"6host_lan_day", "two_way_hull"},
                                  {"18cam_6host_45fps", "yoon2021_both"}};

TEST(ClockSimulation, TheSameSeedGivesTheSameReadings) {
  for (const Sync& sync : kSyncs) {
    SCOPED_TRACE(sync.scenario + ", " + sync.host_sync);
    const Kept first = synchronised(sync, 3);
    expect_equal(first, synchronised(sync, 3));
    EXPECT_NE(first.clocks.readings.back().errors_s,
              synchronised(sync, 4).clocks.readings.back().errors_s);
  }
}

// Nothing is shared between worlds: a capture that is recorded between two readings changes none.
TEST(ClockSimulation, ACaptureBesideItChangesNothing) {
  struct Interrupted final : ClockSink {
    void on_errors(TrueTime at, std::span<const double> errors_s) override {
      kept.on_errors(at, errors_s);
      if (kept.readings.size() == 100) {
        KeptLists lists;
        run_world(ideal_scenario(), nullptr, lists, 3);
        EXPECT_FALSE(lists.frames.empty());
      }
    }
    KeptReadings kept;
  } interrupted;
  const Sync sync{"6host_star", "chrony"};
  const Kept alone = synchronised(sync, 3);
  const scenarios::Scenario scenario = scenarios::load_scenario(sync.scenario);
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(sync.host_sync);
  const auto algorithm = entry->make(check_parameters(entry->info.parameters, {}));
  Kept beside;
  beside.cost = make_clock_simulation(scenario)->run({.seed = 3,
                                                      .pipeline = sync.host_sync,
                                                      .host_sync = algorithm.get(),
                                                      .duration = seconds(600),
                                                      .interval = seconds(1),
                                                      .master_lost_for = seconds(60),
                                                      .recovery = seconds(60)},
                                                     interrupted);
  beside.clocks = interrupted.kept;
  expect_equal(alone, beside);
}

TEST(ClockSimulation, OneSourceRunsAnyNumberOfTimes) {
  const scenarios::Scenario scenario = three_hosts();
  const auto source = make_clock_simulation(scenario);
  const ClockRequest request{.pipeline = "free", .duration = seconds(10), .interval = seconds(1)};
  Kept first;
  Kept second;
  first.cost = source->run(request, first.clocks);
  second.cost = source->run(request, second.clocks);
  expect_equal(first, second);
}

TEST(ClockSimulation, AnOraclesClocksAreTheMasters) {
  const Kept kept = synchronised({"6host_lan_day", "oracle"}, 1);
  for (const auto& reading : nonempty(kept.clocks.readings)) {
    EXPECT_EQ(reading.errors_s, std::vector<double>(6, 0.0));
  }
}

TEST(ClockSimulation, ChronySynchronisesFromAColdStart) {
  const Kept kept = synchronised({"6host_star", "chrony"}, 1, seconds(3600));
  const std::vector<double>& begin = kept.clocks.readings.front().errors_s;
  EXPECT_GT(std::abs(*std::max_element(begin.begin(), begin.end())), 1e-3);
  for (const double error_s : kept.clocks.at(3600)) EXPECT_LT(std::abs(error_s), 1e-4);
}

// Sets the flag at the tenth reading.
struct Cancelling final : ClockSink {
  void on_errors(TrueTime, std::span<const double>) override {
    if (++readings == 10) cancel = true;
  }
  std::atomic<bool> cancel = false;
  int readings = 0;
};

TEST(ClockSimulation, ARunCanBeCancelled) {
  const scenarios::Scenario scenario = scenarios::load_scenario("6host_star");
  Cancelling sink;
  EXPECT_THROW(make_clock_simulation(scenario)->run({.pipeline = "free",
                                                     .duration = seconds(30'000'000),
                                                     .interval = seconds(1),
                                                     .cancel = &sink.cancel},
                                                    sink),
               RecordingCancelled);
  EXPECT_LT(sink.readings, 1'000'000);
}

TEST(ClockSimulation, WhatASynchronisationThrowsArrives) {
  Service service([](Host& host) -> Task<void> {
    co_await host.sleep_for(seconds(5));
    throw std::runtime_error("no such luck");
  });
  EXPECT_THROW(read_clocks(three_hosts(), {.pipeline = "bad",
                                           .host_sync = &service,
                                           .duration = seconds(60),
                                           .interval = seconds(1)}),
               std::runtime_error);
}

// A chain of four exact hosts whose programs are cold: 40 us before a request leaves, 60 us before
// a server reads its clock.
scenarios::Scenario cold_chain() {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.hosts.count = 4;
  scenario.hosts.follows = {0, 0, 1, 2};
  scenario.hosts.clock.initial_offset_of_host_ms = {0, 20, -30, 40};
  scenario.hosts.nic = {.hardware_stamps = true, .stamp_resolution_ns = 1};
  scenario.hosts.cpu_load = scenarios::CpuLoad{
      .cold_after_ms = 10, .cold_transmit = {.fixed_us = 40}, .cold_wake_up = {.fixed_us = 60}};
  return scenario;
}

std::vector<double> errors_of_chain(const std::string& host_sync) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(host_sync);
  const auto sync = entry->make(check_parameters(entry->info.parameters, {}));
  const Kept kept = read_clocks(cold_chain(), {.pipeline = "chain",
                                               .host_sync = sync.get(),
                                               .duration = seconds(7200),
                                               .interval = seconds(60)});
  return kept.clocks.at(7200);
}

TEST(ClockSimulation, AChainAddsTheErrorOfEachHop) {
  const std::vector<double> errors_s = errors_of_chain("chrony_sw");
  for (std::size_t host = 1; host < 4; ++host) {
    EXPECT_NEAR(errors_s[host], 50e-6 * static_cast<double>(host), 2e-6) << "host " << host;
  }
}

TEST(ClockSimulation, TheCardsStampsKnowNothingOfTheProgram) {
  for (const double error_s : errors_of_chain("chrony_hw_xleave")) EXPECT_NEAR(error_s, 0, 1e-7);
}

TEST(ClockSimulation, WithoutInterleavingTheServersDepartureIsItsPrograms) {
  // The answer is warm: its program needs no time in this world.
  for (const double error_s : errors_of_chain("chrony_hw")) EXPECT_NEAR(error_s, 0, 1e-7);
}

TEST(ClockSimulation, ABoundaryClockServesWhatItFollows) {
  for (const char* host_sync : {"ptp_e2e_hardware", "ptp_p2p_hardware", "ntp"}) {
    const std::vector<double> errors_s = errors_of_chain(host_sync);
    const double bound_s = std::string(host_sync) == "ntp" ? 1e-3 : 1e-6;
    for (const double error_s : errors_s) EXPECT_NEAR(error_s, 0, bound_s) << host_sync;
  }
}

// The RMS error of a host over four seeds.
double rms_in_chain_s(const char* host_sync, std::size_t host) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(host_sync);
  scenarios::Scenario scenario = scenarios::load_scenario("4host_gptp_chain");
  scenario.hosts.nic.stamp_jitter_sigma_ns = 200;
  double sum = 0;
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto sync = entry->make(check_parameters(entry->info.parameters, {}));
    const Kept kept = read_clocks(scenario, {.seed = seed,
                                             .pipeline = host_sync,
                                             .host_sync = sync.get(),
                                             .duration = seconds(900),
                                             .interval = seconds(1)});
    for (const auto& reading : kept.clocks.readings) {
      if (reading.at_s < 120) continue;
      sum += reading.errors_s[host] * reading.errors_s[host];
      ++count;
    }
  }
  return std::sqrt(sum / static_cast<double>(count));
}

// Relays whose noise adds up by squares, against servos that follow servos.
TEST(ClockSimulation, RelaysOfGeneralisedPtpPassLessNoiseOnThanBoundaryClocks) {
  const double relayed = rms_in_chain_s("gptp_hardware", 3) / rms_in_chain_s("gptp_hardware", 1);
  const double steered =
      rms_in_chain_s("ptp_p2p_hardware", 3) / rms_in_chain_s("ptp_p2p_hardware", 1);
  EXPECT_LT(relayed, std::sqrt(3.0));
  EXPECT_GT(steered, 1.15 * relayed);
}

TEST(ClockSimulation, AnOrdinarySwitchIsNoLinkOfGeneralisedPtp) {
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>("gptp_hardware");
  const auto sync = entry->make(check_parameters(entry->info.parameters, {}));
  const Kept kept =
      read_clocks(scenarios::load_scenario("3host_ptp_switch"), {.pipeline = "gptp",
                                                                 .host_sync = sync.get(),
                                                                 .duration = seconds(60),
                                                                 .interval = seconds(1)});
  ASSERT_EQ(kept.clocks.outcomes.size(), 2U);
  for (const SyncOutcome& outcome : kept.clocks.outcomes) {
    EXPECT_FALSE(outcome.synchronised);
    EXPECT_THAT(outcome.message, testing::HasSubstr("does not know 802.1AS"));
  }
}

// A master of domain 1 and slaves of another.
class OtherDomain final : public HostSync {
 public:
  explicit OtherDomain(int domain) : domain_(domain) {}
  std::optional<Nanoseconds> warm_up() const override { return seconds(60); }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override {
    return serve_ptp(host, std::move(slaves), {.stamps = StampSource::kCard, .domain = 1});
  }
  Task<void> run_slave(Host& host, PeerId master) override {
    return follow_ptp(host, master, {.stamps = StampSource::kCard, .domain = domain_});
  }

 private:
  int domain_;
};

TEST(ClockSimulation, AMasterOfAnotherDomainIsNotFollowed) {
  for (const int domain : {0, 1}) {
    OtherDomain sync(domain);
    scenarios::Scenario scenario = three_hosts();
    scenario.hosts.nic = {.hardware_stamps = true, .stamp_resolution_ns = 1};
    const Kept kept = read_clocks(scenario, {.pipeline = "domains",
                                             .host_sync = &sync,
                                             .duration = seconds(400),
                                             .interval = seconds(1)});
    ASSERT_EQ(kept.clocks.outcomes.size(), 2U);
    for (const SyncOutcome& outcome : kept.clocks.outcomes) {
      EXPECT_EQ(outcome.synchronised, domain == 1);
    }
    EXPECT_EQ(std::abs(kept.clocks.at(400)[1]) < 1e-3, domain == 1);
  }
}

}  // namespace
}  // namespace simbench::sim

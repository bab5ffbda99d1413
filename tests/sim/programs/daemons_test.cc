// Debian's chronyd, ntpd and ptp4l, unmodified, in the simulated world: the limits that their own
// test suites state.
#include "tests/sim/programs/daemons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using testing::IsEmpty;

// chrony's simulation tests: in sync within 120 to 210 s, then at most 1 ms, RMS 0.3 ms.
TEST_F(Daemons, ChronydMeetsTheLimitsOfItsSimulationTests) {
  const std::vector<Course> slaves =
      run(chronyd("server {master}"), scenarios::load_scenario("6host_star"), 10'000, 1e-3);
  ASSERT_EQ(slaves.size(), 5U);
  for (const Course& slave : slaves) {
    EXPECT_GE(slave.settled_s, 120);
    EXPECT_LE(slave.settled_s, 210);
    EXPECT_LE(slave.max_s, 1e-3);
    EXPECT_LE(slave.rms_s, 3e-4);
    EXPECT_GT(slave.rms_s, 0);
  }
}

// In a chain each host's chronyd serves the next: {master} is the host that it follows.
TEST_F(Daemons, ChronydsInAChainFollowEachOther) {
  const std::vector<Course> slaves = run(chronyd("server {master} iburst\nallow"),
                                         scenarios::load_scenario("4host_chain_idle"), 7200, 1e-3);
  ASSERT_EQ(slaves.size(), 3U);
  for (const Course& slave : slaves) {
    EXPECT_LT(slave.settled_s, 600);
    EXPECT_LT(slave.rms_s, 0.3e-3);
  }
}

// linuxptp's: in sync within 10 to 40 s, then RMS 1 us and at most 2 us, by hardware stamps over
// quiet links.
TEST_F(Daemons, Ptp4lMeetsTheLimitsOfItsTestSuite) {
  const Command ptp4l{"ptp4l", "-i", "{interface}", "-m", "-q", "-f", "{files}/ptp4l.conf"};
  Command slave = ptp4l;
  slave.emplace_back("-s");
  const Command to_card{"phc2sys", "-s", "CLOCK_REALTIME", "-c", "{interface}", "-O", "0", "-m"};
  const Command from_card{"phc2sys",       "-s", "{interface}", "-c", "CLOCK_REALTIME", "-w", "-z",
                          "{files}/ptp4l", "-O", "0",           "-m"};
  const scenarios::Scenario quiet = scenarios::load_scenario(
      "6host_star",
      {{"/hosts/nic/hardware_stamps", "true"}, {"/network/latency_exponential_ms", "0.00001"}});
  const std::vector<Course> slaves =
      run(settings({ptp4l, to_card}, {slave, from_card},
                   {{"ptp4l.conf", "[global]\nuds_address {files}/ptp4l\n"}}),
          quiet, 600, 2e-6);
  for (const Course& each : slaves) {
    EXPECT_GE(each.settled_s, 10);
    EXPECT_LE(each.settled_s, 40);
    EXPECT_LE(each.max_s, 2e-6);
    EXPECT_LE(each.rms_s, 1e-6);
    EXPECT_GT(each.rms_s, 0);
  }
}

// It steps, measures its frequency for 300 s, and is within ntpd's own 128 ms then.
TEST_F(Daemons, NtpdSynchronises) {
  const auto command = [](const char* file) {
    return Command{"ntpd", "-n", "-c", std::string("{files}/") + file};
  };
  const std::vector<Course> slaves =
      run(settings({command("server.conf")}, {command("client.conf")},
                   {{"server.conf", "tos orphan 1 orphanwait 1\n"},
                    {"client.conf", "server {master} iburst\n"}}),
          scenarios::load_scenario("6host_star"), 3600, 5e-3);
  for (const Course& slave : slaves) {
    EXPECT_LE(slave.settled_s, 600);
    EXPECT_LE(slave.rms_s, 2e-3);
    EXPECT_GT(slave.rms_s, 0);
  }
}

TEST_F(Daemons, TheSameSeedGivesTheSameBytesInAnyFolder) {
  const scenarios::Scenario star = scenarios::load_scenario("6host_star");
  const std::vector<Course> first = run(chronyd("server {master} iburst"), star, 600, 1e-3);
  const std::string said = logs();
  std::filesystem::remove_all(folder_);
  folder_ += "_of_another_name";
  const std::vector<Course> second = run(chronyd("server {master} iburst"), star, 600, 1e-3);
  EXPECT_EQ(logs(), said);
  EXPECT_THAT(said, testing::HasSubstr("Selected source 10.0.0.1"));
  for (std::size_t slave = 0; slave < first.size(); ++slave) {
    EXPECT_EQ(first[slave].rms_s, second[slave].rms_s);
  }
}

// Its own message is the note's.
TEST_F(Daemons, AConfigurationThatADaemonRefusesIsSaidInItsWords) {
  ProgramSettings programs = chronyd("servr {master}");
  programs.hosts = 6;
  ProgramSync sync(std::move(programs));
  ServiceWorld world(scenarios::load_scenario("6host_star"), 1);
  world.start(sync);
  world.run_until(10);
  // Clocks differ, so the beginnings of their words may.
  ASSERT_THAT(sync.notes(), testing::Not(IsEmpty()));
  EXPECT_THAT(sync.notes(),
              testing::Each(testing::AllOf(
                  testing::StartsWith("host"), testing::HasSubstr(": chronyd: exited"),
                  testing::HasSubstr("Invalid directive at line 1 in file /files/client.conf"))));
}

}  // namespace
}  // namespace simbench::sim

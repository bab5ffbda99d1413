// Programs that look at the line with a pulse per second and at the card's external stamps, in a
// world of three hosts. The master's clock is exact: it reads true time.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/kernel_clock.h"
#include "tests/sim/host/service_world.h"
#include "tests/sim/programs/calls_on_hosts.h"

namespace simbench::sim {
namespace {

using scenarios::Override;
using testing::Each;

std::vector<Override> lines(const char* jitter_us, const char* latency_us,
                            const char* exponential_us) {
  return {{"/hosts/pulse_lines/pps", "true"},
          {"/hosts/pulse_lines/pps_jitter_sigma_us", jitter_us},
          {"/hosts/pulse_lines/interrupt_latency_us", latency_us},
          {"/hosts/pulse_lines/interrupt_latency_exponential_us", exponential_us}};
}

class PulseCallsTest : public CallsOnHosts {};

TEST_F(PulseCallsTest, HostsWithoutALineHaveNoDevice) {
  EXPECT_THAT(
      run("pulse_calls", {{"absent"}}, {{"absent"}}, {{"/hosts/nic/hardware_stamps", "true"}}),
      Each(std::string("done\n")));
}

// Pulses come at full seconds of GNSS time, a quarter of a second before those of true time. The
// slaves' clocks are off by what their hosts are told, and drift by some 10 ppm in a second.
TEST_F(PulseCallsTest, TheLineDoesWhatRfc2783AndLinuxPromise) {
  std::vector<Override> changes = lines("0", "7", "0");
  changes.push_back({"/hosts/clock/initial_offset_of_host_ms", "[0, 100, -100]"});
  const std::string exact = std::to_string(750'000'000 + 7'000);
  const std::string off = std::to_string(750'000'000);
  const std::vector<std::string> said =
      run("pulse_calls", {{"check", exact, "0"}}, {{"check", off, "110000000"}}, changes);
  EXPECT_THAT(said, Each(std::string("done\n")));
}

TEST_F(PulseCallsTest, TheCardStampsPulsesWithoutTheInterruptsLatency) {
  std::vector<Override> changes = lines("0", "7", "0");
  changes.push_back({"/hosts/nic/hardware_stamps", "true"});
  changes.push_back({"/hosts/nic/stamp_jitter_sigma_ns", "0"});
  const std::vector<std::string> said =
      run("pulse_calls", {{"card", "7000"}}, {{"card", "7000"}}, changes, 300);
  EXPECT_THAT(said, Each(std::string("done\n")));
}

// Programs and algorithms have one line: the same pulses, errors, latencies and stamps.
TEST_F(PulseCallsTest, StampsAreThoseOfTheAlgorithms) {
  std::vector<Override> changes = lines("20", "5", "30");
  changes.push_back({"/hosts/pulse_lines/interrupt_latency_log_sigma", "0.5"});
  const std::vector<std::string> said =
      run("pulse_calls", {{"print", "50"}}, {{"print", "50"}}, changes);
  changes.insert(changes.begin(), {{"/hosts/count", "3"}, {"/cameras/count", "3"}});
  ServiceWorld world(scenarios::load_scenario("6host_star", changes), 1);
  std::vector<std::string> expected(kCallingHosts);
  const auto collect = [](Host& host, std::string& text) -> Task<void> {
    for (int i = 0; i < 50; ++i) {
      const auto stamp = co_await host.pulse_input(PulseLine::kPps)->next(SteadyTime::max());
      text += fmt::format("{}\n", epoch_ns(stamp->system));
    }
    text += "done\n";
  };
  for (std::size_t host = 0; host < kCallingHosts; ++host) {
    world.spawn(collect(world.host(host), expected[host]));
  }
  world.run_until(60);
  EXPECT_EQ(said, expected);
  EXPECT_NE(said[0], said[1]);
}

TEST_F(PulseCallsTest, ProgramsOfAHostShareNtpsSegments) {
  const std::vector<Words> both = {{"read"}, {"write"}};
  EXPECT_THAT(run("time_sources", both, both), Each(std::string("done\n")));
}

}  // namespace
}  // namespace simbench::sim

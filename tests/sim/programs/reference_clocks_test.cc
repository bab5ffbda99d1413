// Daemons that set clocks by pulses, by the card's stamps of them, and by what programs of their
// host say (NTP's shared memory, chronyd's socket), in a world of three hosts.
//
// All errors are to the receivers' time, which is a quarter of a second ahead of true time; the
// first offsets are such that all hosts take the same second for a pulse's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/host/pulse_lines.h"
#include "tests/sim/programs/real_programs.h"

namespace simbench::sim {
namespace {

using scenarios::Override;
using testing::AllOf;
using testing::Each;
using testing::Ge;
using testing::IsEmpty;
using testing::Le;

std::string chrony_conf(const std::string& text) {
  return text + "makestep 0.01 3\ncmdport 0\npidfile {files}/chronyd.pid\nbindcmdaddress /\n";
}

// What 6host_star says of the lines.
constexpr double kLatencyUs = 5;
constexpr double kExponentialUs = 5;

// A host's clock minus the receivers' time, once it has settled.
struct Settled {
  double mean_us = 0;
  double rms_us = 0;  // about the mean
  double max_us = 0;  // likewise
};

class ReferenceClocks : public RealPrograms {
 protected:
  static scenarios::Scenario three_hosts(std::vector<Override> changes = {}) {
    const std::vector<Override> fixed{{"/hosts/count", "3"},
                                      {"/cameras/count", "3"},
                                      {"/hosts/pulse_lines/pps", "true"},
                                      {"/hosts/clock/initial_offset_of_host_ms", "[0, 100, -100]"}};
    changes.insert(changes.begin(), fixed.begin(), fixed.end());
    return scenarios::load_scenario("6host_star", changes);
  }

  // By host, from `begin_s` on.
  std::vector<Settled> settle(ProgramSettings programs, const scenarios::Scenario& scenario,
                              double begin_s, double end_s) {
    programs.hosts = static_cast<std::size_t>(scenario.hosts.count);
    ProgramSync sync(std::move(programs));
    ServiceWorld world(scenario, 1);
    world.start(sync);
    std::vector<std::vector<double>> errors_us(static_cast<std::size_t>(scenario.hosts.count));
    world.run_until(begin_s);
    world.watch(end_s, 1, [&](double) {
      for (std::size_t host = 0; host < errors_us.size(); ++host) {
        errors_us[host].push_back(error_us(world, host));
      }
    });
    EXPECT_THAT(sync.notes(), IsEmpty());
    std::vector<Settled> settled;
    for (const auto& each : errors_us) settled.push_back(settled_of(each));
    return settled;
  }

  static Command own(std::vector<std::string> words) {
    words.insert(words.begin(), std::string(SIMBENCH_PROGRAMS) + "/simbench_time_sources");
    return words;
  }
  static Command chronyd(const std::string& file = "chrony.conf") {
    return {"chronyd", "-d", "-f", "{files}/" + file};
  }

 private:
  static double error_us(ServiceWorld& world, std::size_t host) {
    constexpr Nanoseconds kAhead = kGnssTimeAtTrueZero % Nanoseconds(kSecondNs);
    const TrueTime now = world.now();
    return static_cast<double>((world.clock(host).read(now).time_since_epoch() -
                                now.time_since_epoch() - kAhead)
                                   .count()) *
           1e-3;
  }
  static Settled settled_of(const std::vector<double>& errors_us) {
    Settled settled;
    const auto count = static_cast<double>(errors_us.size());
    for (const double each : errors_us) settled.mean_us += each / count;
    for (const double each : errors_us) {
      const double off = each - settled.mean_us;
      settled.rms_us += off * off / count;
      settled.max_us = std::max(settled.max_us, std::abs(off));
    }
    settled.rms_us = std::sqrt(settled.rms_us);
    printf("mean %f rms %f max %f us\n", settled.mean_us, settled.rms_us, settled.max_us);
    return settled;
  }
};

TEST_F(ReferenceClocks, ChronydTakesPulsesAndTheirSecondsFromSharedMemory) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::vector<Command> both{chronyd(), own({"shm", "0", "120"})};
  const auto settled =
      settle(settings(both, both,
                      {{"chrony.conf", chrony_conf("refclock SHM 0 refid NMEA offset 0.12 delay 0.2\n"
                                                   "refclock PPS /dev/pps0 lock NMEA refid PPS\n")}}),
             three_hosts(), 600, 3000);
  printf("%s\n", logs().c_str());
}

TEST_F(ReferenceClocks, ChronydTakesSamplesFromASocket) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::vector<Command> both{chronyd(), own({"sock", "/run/receiver.sock"})};
  const auto settled =
      settle(settings(both, both,
                      {{"chrony.conf", chrony_conf("refclock SOCK /run/receiver.sock refid GNSS\n")}}),
             three_hosts(), 600, 3000);
  printf("%s\n", logs().c_str());
}

TEST_F(ReferenceClocks, ChronydTakesTheSecondFromAServerAndThePulseFromTheLine) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const auto settled =
      settle(settings({chronyd("server.conf")}, {chronyd("client.conf")},
                      {{"server.conf", chrony_conf("local stratum 1\nallow\nrefclock PPS /dev/pps0 refid PPS\n")},
                       {"client.conf", chrony_conf("server {master} iburst\nrefclock PPS /dev/pps0 refid PPS\n")}}),
             three_hosts(), 1200, 3600);
  printf("%s\n", logs().c_str());
}

TEST_F(ReferenceClocks, ChronydKeepsItsFrequencyByTheLine) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  for (const char* more : {"", "refclock PPS /dev/pps0 refid PPS local\n"}) {
  const auto settled =
      settle(settings({chronyd("server.conf")}, {chronyd("client.conf")},
                      {{"server.conf", chrony_conf("local stratum 1\nallow\n")},
                       {"client.conf", chrony_conf(std::string("server {master} iburst\n") + more)}}),
             three_hosts(), 1200, 7200);
  printf("%s\n", logs().c_str());
  }
}

TEST_F(ReferenceClocks, Ts2phcSetsTheCardByPulsesAndPhc2sysTheClockByTheCard) {
  SIMBENCH_SKIP_WITHOUT("ts2phc");
  const std::vector<Command> both{{"ts2phc", "-m", "-q", "-s", "generic", "-c", "{interface}"},
                                  {"phc2sys", "-m", "-q", "-s", "{interface}", "-c", "CLOCK_REALTIME", "-O", "0"}};
  const auto settled = settle(settings(both, both), three_hosts({{"/hosts/nic/hardware_stamps", "true"}}), 60, 600);
  printf("%s\n", logs().substr(0, 6000).c_str());
}

}  // namespace
}  // namespace simbench::sim

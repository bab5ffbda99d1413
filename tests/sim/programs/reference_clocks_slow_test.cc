// Daemons that set clocks by pulses, by the card's stamps of them, and by what programs of their
// host say (NTP's shared memory, chronyd's socket), in a world of three hosts.
//
// All errors are to the receivers' time, which is a quarter of a second ahead of true time; the
// first offsets are such that all hosts take the same second for a pulse's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/host/pulse_lines.h"
#include "tests/sim/programs/real_programs.h"

namespace simbench::sim {
namespace {

using scenarios::Override;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string chrony_conf(const std::string& text) {
  return text + "makestep 0.01 3\ncmdport 0\npidfile {files}/chronyd.pid\nbindcmdaddress /\n";
}

// What 6host_star says of the lines: a stamp is 5 us and an exponential 5 us late.
constexpr double kLatencyUs = 5;
constexpr double kExponentialUs = 5;
// chronyd takes the mean of those 60 % of a poll's samples that lie nearest to the median: the
// exponential between its quantiles of 20 and 80 %, which is 0.761 of its mean. Its clock is as
// late. 16 samples leave an error of about a quarter of the exponential's deviation.
constexpr double kMeanUs = -(kLatencyUs + 0.761 * kExponentialUs);
constexpr double kSampleUs = kExponentialUs / 4;

// A host's clock minus the receivers' time, once it has settled.
struct Settled {
  double mean_us = 0;
  double rms_us = 0;  // about the mean
  double max_us = 0;  // likewise
};

void expect_interrupts_error(const std::vector<Settled>& hosts) {
  ASSERT_EQ(hosts.size(), 3U);
  for (const Settled& each : hosts) {
    EXPECT_NEAR(each.mean_us, kMeanUs, kSampleUs / 2);
    EXPECT_LE(each.rms_us, kSampleUs);
    EXPECT_GT(each.rms_us, kSampleUs / 20);
    EXPECT_LE(each.max_us, 4 * kSampleUs);
  }
}

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
    return static_cast<double>(
               (world.clock(host).read(now).time_since_epoch() - now.time_since_epoch() - kAhead)
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
    return settled;
  }
};

// A receiver's message comes 120 ms after its pulse.
TEST_F(ReferenceClocks, ChronydTakesPulsesAndTheirSecondsFromSharedMemory) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::vector<Command> both{chronyd(), own({"shm", "0", "120"})};
  const std::string conf =
      "refclock SHM 0 refid NMEA offset 0.12 delay 0.2\n"
      "refclock PPS /dev/pps0 lock NMEA refid PPS\n";
  expect_interrupts_error(
      settle(settings(both, both, {{"chrony.conf", chrony_conf(conf)}}), three_hosts(), 600, 3000));
  EXPECT_THAT(logs(), HasSubstr("Selected source PPS"));
}

TEST_F(ReferenceClocks, ChronydTakesSamplesFromASocket) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::vector<Command> both{chronyd(), own({"sock", "/run/receiver.sock"})};
  const std::string conf = "refclock SOCK /run/receiver.sock refid GNSS\n";
  expect_interrupts_error(
      settle(settings(both, both, {{"chrony.conf", chrony_conf(conf)}}), three_hosts(), 600, 3000));
}

// The server has the pulse as well: its seconds begin with it.
TEST_F(ReferenceClocks, ChronydTakesTheSecondFromAServerAndThePulseFromTheLine) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::string line = "refclock PPS /dev/pps0 refid PPS\n";
  const auto programs = settings({chronyd("server.conf")}, {chronyd("client.conf")},
                                 {{"server.conf", chrony_conf("local stratum 1\nallow\n" + line)},
                                  {"client.conf", chrony_conf("server {master} iburst\n" + line)}});
  expect_interrupts_error(settle(programs, three_hosts(), 600, 2400));
}

// The server's seconds are others than the receivers', but as long: the line tells the frequency,
// so that the quartz's wander does not matter and the messages' jitter goes into a long mean. One
// of them has an error of 50 us / sqrt(2).
TEST_F(ReferenceClocks, ChronydKeepsAServersTimeByTheLinesFrequency) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const auto errors_us = [this](const std::string& line) {
    const std::string client = chrony_conf("server {master} iburst\n" + line);
    auto settled = settle(settings({chronyd("server.conf")}, {chronyd("client.conf")},
                                   {{"server.conf", chrony_conf("local stratum 1\nallow\n")},
                                    {"client.conf", client}}),
                          three_hosts(), 1200, 4800);
    std::vector<double> errors;
    for (std::size_t slave : {1, 2}) {
      errors.push_back(
          std::hypot(settled[slave].rms_us, settled[slave].mean_us - settled[0].mean_us));
    }
    EXPECT_NEAR(settled[0].mean_us, -250'000, 1e-6) << "the server's clock is exact";
    return errors;
  };
  const std::vector<double> without = errors_us("");
  const std::vector<double> with = errors_us("refclock PPS /dev/pps0 refid PPS local\n");
  for (const double each : with) EXPECT_LE(each, 50 / std::sqrt(2) / 2);
  EXPECT_LE(std::hypot(with[0], with[1]), std::hypot(without[0], without[1]) / 2);
}

// ntpd leaves out one sample after the other that lies farthest from the median, of an exponential
// mostly late ones: the mean of the rest is between that of its lower 60 %, 0.389, and 0.761. Its
// loop takes two hours to know the quartz.
TEST_F(ReferenceClocks, NtpdTakesPulsesAndTheirSecondsFromSharedMemory) {
  SIMBENCH_SKIP_WITHOUT("ntpd");
  const std::vector<Command> both{{"ntpd", "-n", "-c", "{files}/ntp.conf"},
                                  own({"shm", "0", "120"})};
  const std::string conf =
      "refclock shm unit 0 refid NMEA prefer time1 0.12 minpoll 4 maxpoll 4\n"
      "refclock pps unit 0 refid PPS minpoll 4 maxpoll 4\ntos mindist 0.2\n";
  const auto settled =
      settle(settings(both, both, {{"ntp.conf", conf}}), three_hosts(), 7200, 14'400);
  for (const Settled& each : settled) {
    EXPECT_GE(each.mean_us, kMeanUs - kSampleUs / 2);
    EXPECT_LE(each.mean_us, -(kLatencyUs + 0.389 * kExponentialUs) + kSampleUs / 2);
    EXPECT_LE(each.max_us, 4 * kSampleUs);
  }
}

// The card stamps the pulse itself: an error of 50 ns of the receiver's, 10 ns of the stamp's noise
// and 8 ns / sqrt(12) of its resolution, 51 ns together. A PI servo with linuxptp's constants, 0.7
// and 0.3 s^-1, turns white noise into 1.05 times as much of its clock: the variance X of x' = -w -
// d, d' = d + 0.3 (x + w) is 1.112 that of w. That of phc2sys follows the card a second later, by
// readings as noisy as its stamps.
TEST_F(ReferenceClocks, Ts2phcSetsTheCardByPulsesAndPhc2sysTheClockByTheCard) {
  SIMBENCH_SKIP_WITHOUT("ts2phc");
  const std::vector<Command> both{
      {"ts2phc", "-m", "-q", "-s", "generic", "-c", "{interface}"},
      {"phc2sys", "-m", "-q", "-s", "{interface}", "-c", "CLOCK_REALTIME", "-O", "0"}};
  const auto settled =
      settle(settings(both, both), three_hosts({{"/hosts/nic/hardware_stamps", "true"}}), 60, 1260);
  constexpr double kCardUs = 1.05 * 0.051;
  for (const Settled& each : settled) {
    EXPECT_NEAR(each.mean_us, 0, kCardUs / 4) << "the interrupt's latency is not in it";
    EXPECT_LE(each.rms_us, 1.5 * kCardUs);
    EXPECT_GE(each.rms_us, 0.5 * kCardUs);
    EXPECT_LE(each.max_us, 6 * kCardUs);
  }
}

// chronyd takes the card's stamps itself, and converts them by readings of both clocks. It fits
// four polls of 16 s at least: a quartz that walks by 1 ppb a root second has gone 0.3 us astray in
// that, 64^1.5 ns / sqrt(3).
TEST_F(ReferenceClocks, ChronydTakesTheCardsStampsOfPulses) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::vector<Command> both{chronyd(), own({"shm", "0", "120"})};
  const std::string conf =
      "refclock SHM 0 refid NMEA offset 0.12 delay 0.2\n"
      "refclock PHC /dev/ptp0:extpps:pin=0 lock NMEA refid CARD\n";
  const auto settled = settle(settings(both, both, {{"chrony.conf", chrony_conf(conf)}}),
                              three_hosts({{"/hosts/nic/hardware_stamps", "true"}}), 600, 3000);
  EXPECT_LE(settled[0].rms_us, 0.05) << "its quartz does not walk: the receiver's error is left";
  for (const Settled& each : settled) {
    EXPECT_NEAR(each.mean_us, 0, 0.1) << "the interrupt's latency is not in it";
    EXPECT_LE(each.rms_us, 0.3);
    EXPECT_GT(each.rms_us, 0);
  }
}

TEST_F(ReferenceClocks, TheSamePulsesGiveTheSameBytes) {
  SIMBENCH_SKIP_WITHOUT("ts2phc");
  const std::vector<Command> both{{"ts2phc", "-m", "-q", "-l", "7", "-s", "generic", "-c", "eth0"},
                                  own({"shm", "0", "120"})};
  const scenarios::Scenario wired =
      two_hosts({{"/hosts/nic/hardware_stamps", "true"}, {"/hosts/pulse_lines/pps", "true"}});
  const std::vector<Course> first = run(settings(both, both), wired, 120);
  const std::string said = logs();
  std::filesystem::remove_all(folder_);
  folder_ += "_of_another_name";
  EXPECT_EQ(run(settings(both, both), wired, 120).at(0).rms_s, first.at(0).rms_s);
  EXPECT_EQ(logs(), said);
  EXPECT_THAT(said, HasSubstr("eth0 extts index 0 at "));
}

// Without a line ts2phc says which request failed.
TEST_F(ReferenceClocks, Ts2phcEndsOnAHostWithoutALine) {
  SIMBENCH_SKIP_WITHOUT("ts2phc");
  const std::vector<Command> both{{"ts2phc", "-m", "-q", "-s", "generic", "-c", "{interface}"}};
  ProgramSettings programs = settings(both, both);
  programs.hosts = 2;
  ProgramSync sync(std::move(programs));
  ServiceWorld world(two_hosts({{"/hosts/nic/hardware_stamps", "true"}}), 1);
  world.start(sync);
  world.run_until(10);
  EXPECT_THAT(sync.notes(), SizeIs(2));
  EXPECT_THAT(sync.notes(), Each(HasSubstr("PTP_EXTTS_REQUEST2 failed: Invalid argument")));
}

}  // namespace
}  // namespace simbench::sim

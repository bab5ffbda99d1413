// Daemons and clients as their users configure them, in the simulated world: each does its work, in
// simulated time, and twice to the byte.
//
// Messages of 6host_star take 0.1 ms and an exponential 0.05 ms each way, so that the offset that
// one exchange measures is off by half the difference of two of these: a mean square of 0.035 ms.
// Quartzes are wrong by 10 ppm, first clocks by 0.3 s (mean squares).
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/scratch_folder.h"
#include "tests/sim/programs/real_programs.h"

namespace simbench::sim {
namespace {

using testing::HasSubstr;

constexpr double kExchange_s = 0.0354e-3;
constexpr double kSkew = 10e-6;

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

class RealDaemons : public RealPrograms {
 protected:
  // A server and a client of chronyd with these words before "-f FILE".
  ProgramSettings chronyd(const std::vector<std::string>& words, const std::string& server,
                          const std::string& client,
                          std::map<std::string, std::string> files = {}) const {
    files["server.conf"] = server;
    files["client.conf"] = client;
    Command command{"chronyd"};
    command.insert(command.end(), words.begin(), words.end());
    command.emplace_back("-f");
    Command slave = command;
    command.emplace_back("{files}/server.conf");
    slave.emplace_back("{files}/client.conf");
    return settings({command}, {slave}, std::move(files));
  }
};

TEST_F(RealDaemons, ChronydWithManyOptions) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const std::string keys = "1 SHA1 HEX:0123456789ABCDEF0123456789ABCDEF01234567\n";
  const Course client = run_twice(
      chronyd({"-d"},
              "local stratum 1\nallow 10.0.0.0/16\nkeyfile /etc/chrony/chrony.keys\n"
              "clientloglimit 100000\nratelimit interval 1 burst 16\nhwtimestamp *\n"
              "smoothtime 400 0.01 leaponly\nbindaddress {address}\nport 123\n",
              "server {master} iburst minpoll 0 maxpoll 2 xleave key 1 minsamples 8 maxsamples 32 "
              "maxdelay 0.1 maxdelayratio 2.0 maxdelaydevratio 10 asymmetry 0.1 prefer trust "
              "require filter 1 polltarget 16 presend 6\n"
              "keyfile /etc/chrony/chrony.keys\ndriftfile /var/lib/chrony/chrony.drift\n"
              "dumpdir /var/lib/chrony\nlogdir /var/log/chrony\nlogbanner 10\n"
              "log measurements statistics tracking rawmeasurements\nlogchange 0.05\n"
              "makestep 0.1 3\nmaxupdateskew 100\nmaxslewrate 1000\ncorrtimeratio 3\nrtcsync\n"
              "maxchange 1000 1 2\nstratumweight 0.001\ncombinelimit 3\nreselectdist 0.0001\n"
              "maxdistance 3\nmaxjitter 1\nminsources 1\nfallbackdrift 16 18\n"
              "pidfile /run/chrony/chronyd.pid\nbindcmdaddress /run/chrony/chronyd.sock\n"
              "lock_all\nsched_priority 1\nuser _chrony\nhwtimestamp *\nacquisitionport 1123\n"
              "confdir /etc/chrony/conf.d\nsourcedir /etc/chrony/sources.d\n",
              {{"etc/chrony/chrony.keys", keys},
               {"etc/chrony/conf.d/more.conf", "logdir /var/log/chrony\nnoclientlog\n"}}),
      two_hosts({{"/hosts/nic/hardware_stamps", "true"}}), 900, 10 * kExchange_s);
  EXPECT_LT(client.settled_s, 120);
  EXPECT_LT(client.rms_s, kExchange_s);
  EXPECT_GT(client.rms_s, 0);
  // One exchange each 4 s at most.
  EXPECT_GT(count_lines(file(1, "var/log/chrony/measurements.log")), 900U / 4);
  EXPECT_THAT(file(1, "var/log/chrony/tracking.log"), HasSubstr("2028-01-01 00:10:"));
  EXPECT_THAT(file(1, "run/chrony/chronyd.pid"), "100\n");
  EXPECT_THAT(logs(), HasSubstr("Selected source 10.0.0.1"));
}

// As Debian starts it: as a user of its own, with a helper that binds sockets, in the background.
TEST_F(RealDaemons, ChronydWithAHelperInTheBackground) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const Course client =
      run_twice(chronyd({"-F", "1", "-u", "_chrony"}, "local stratum 1\nallow\n",
                        "server {master} iburst minpoll 0 maxpoll 2\nmakestep 1 3\n"
                        "driftfile /var/lib/chrony/chrony.drift\n"),
                two_hosts(), 600, 10 * kExchange_s);
  EXPECT_LT(client.settled_s, 120);
  EXPECT_LT(client.rms_s, kExchange_s);
  EXPECT_GT(client.rms_s, 0);
}

// It measures for some seconds, sets the clock once and ends: from then on the quartz is on its
// own, at the frequency that four exchanges within 6 s tell to some ppm.
TEST_F(RealDaemons, ChronydSetsAClockOnce) {
  SIMBENCH_SKIP_WITHOUT("chronyd");
  ProgramSettings programs =
      chronyd({"-d"}, "local stratum 1\nallow\n", "server {master} iburst\n");
  programs.programs.slave = {{"/bin/sh", "-c", "chronyd -q -f {files}/client.conf; sleep 1000000"}};
  programs.programs.environment["PATH"] =
      std::filesystem::path(programs.paths.at("chronyd")).parent_path().string() + ":/usr/bin:/bin";
  const Course client = run_twice(programs, two_hosts(), 30, 1e-3);
  EXPECT_LT(client.settled_s, 15);
  EXPECT_LT(client.max_s, 5 * kExchange_s + 30 * 5 * kSkew);
  EXPECT_THAT(logs(), HasSubstr("System clock wrong by "));
  EXPECT_THAT(logs(), HasSubstr("chronyd exiting"));
}

TEST_F(RealDaemons, NtpsecWritesItsStatisticsAndItsDrift) {
  SIMBENCH_SKIP_WITHOUT("ntpd");
  const Course client =
      run_twice(settings({{"ntpd", "-n", "-c", "{files}/server.conf"}},
                         {{"ntpd", "-n", "-g", "-c", "{files}/client.conf"}},
                         {{"server.conf", "tos orphan 1 orphanwait 1\nrestrict default nomodify\n"},
                          {"client.conf",
                           "server {master} iburst minpoll 3 maxpoll 3\n"
                           "driftfile /var/lib/ntpsec/ntp.drift\nstatsdir /var/log/ntpsec/\n"
                           "statistics loopstats peerstats\n"
                           "filegen loopstats file loopstats type day enable\n"
                           "filegen peerstats file peerstats type day enable\n"}}),
                two_hosts(), 7200, 1e-3);
  EXPECT_LT(client.settled_s, 900);
  EXPECT_LT(client.rms_s, 0.2e-3);
  EXPECT_GT(client.rms_s, 0);
  // It polls once in 8 s, and takes the best of the last eight replies if that is a new one.
  EXPECT_GT(count_lines(file(1, "var/log/ntpsec/peerstats")), 7200U / 64);
  EXPECT_LT(count_lines(file(1, "var/log/ntpsec/peerstats")), 7200U / 8 + 8);
  EXPECT_THAT(file(1, "var/log/ntpsec/loopstats"), HasSubstr("61771 "));
  EXPECT_NEAR(std::stod(file(1, "var/lib/ntpsec/ntp.drift")), 0, 5 * kSkew * 1e6);
}

// Three processes: the one with rights, the one with the network, and its resolver.
TEST_F(RealDaemons, OpenNtpdOfThreeProcessesFollowsChronyd) {
  SIMBENCH_SKIP_WITHOUT("openntpd");
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const Course client = run_twice(settings({{"chronyd", "-d", "-f", "{files}/server.conf"}},
                                           {{"openntpd", "-d", "-s", "-f", "{files}/client.conf"}},
                                           {{"server.conf", "local stratum 1\nallow\n"},
                                            {"client.conf", "listen on *\nserver {master}\n"}}),
                                  two_hosts(), 7200, 5e-3);
  EXPECT_LT(client.settled_s, 600);
  EXPECT_LT(client.rms_s, 1e-3);
  EXPECT_GT(client.rms_s, 0);
  EXPECT_THAT(logs(), HasSubstr("clock is now synced"));
}

TEST_F(RealDaemons, SystemdTimesyncdFollowsItsConfiguration) {
  SIMBENCH_SKIP_WITHOUT("systemd-timesyncd");
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const Course client =
      run_twice(settings({{"chronyd", "-d", "-f", "{files}/server.conf"}}, {{"systemd-timesyncd"}},
                         {{"server.conf", "local stratum 1\nallow\n"},
                          {"etc/systemd/timesyncd.conf",
                           "[Time]\nNTP={master}\nPollIntervalMinSec=16\nPollIntervalMaxSec=32\n"}},
                         {{"SYSTEMD_LOG_LEVEL", "debug"}}),
                two_hosts(), 1800, 1e-3);
  EXPECT_LT(client.settled_s, 300);
  EXPECT_LT(client.rms_s, 3 * kExchange_s);
  EXPECT_GT(client.rms_s, 0);
  EXPECT_THAT(logs(), HasSubstr("Contacted time server 10.0.0.1:123 (10.0.0.1)."));
}

// Between two settings the quartz runs freely for 20 s.
TEST_F(RealDaemons, NtpdigSetsTheClockInALoop) {
  SIMBENCH_SKIP_WITHOUT("ntpdig");
  SIMBENCH_SKIP_WITHOUT("chronyd");
  // Its library is looked for beside its modules.
  const ScratchFolder modules;
  const std::filesystem::path unpacked = std::string(SIMBENCH_PACKAGES) + "/usr/lib";
  if (!std::filesystem::exists(unpacked / "python3/dist-packages/ntp")) {
    GTEST_SKIP() << "ntpdig is installed rather than unpacked";
  }
  std::filesystem::copy(unpacked / "python3/dist-packages/ntp", modules.path() / "ntp",
                        std::filesystem::copy_options::recursive);
  for (const auto& library : std::filesystem::directory_iterator(unpacked)) {
    if (std::filesystem::exists(library.path() / "ntp/libntpc.so")) {
      std::filesystem::copy(library.path() / "ntp/libntpc.so", modules.path() / "ntp");
    }
  }
  const std::string loop = "while true; do ntpdig -S {master}; /bin/sleep 20; done";
  const Course client =
      run_twice(settings({{"chronyd", "-d", "-f", "{files}/server.conf"}},
                         {{"/bin/sh", "-c", loop}}, {{"server.conf", "local stratum 1\nallow\n"}},
                         {{"PYTHONPATH", modules.path().string()},
                          {"PATH", std::string(SIMBENCH_PACKAGES) + "/usr/bin:/usr/bin:/bin"}}),
                two_hosts(), 200, 2e-3);
  EXPECT_LT(client.settled_s, 5);
  EXPECT_LT(client.max_s, 6 * kExchange_s + 20 * 5 * kSkew);
  EXPECT_EQ(count_lines(file(1, "0_sh.log")), 2 * 10U);
}

TEST_F(RealDaemons, PtpdFollowsPtpd) {
  SIMBENCH_SKIP_WITHOUT("ptpd");
  const Course client = run_twice(settings({{"ptpd", "-C", "-M", "-i", "{interface}"}},
                                           {{"ptpd", "-C", "-s", "-i", "{interface}"}}),
                                  two_hosts(), 3600, 0.2e-3);
  EXPECT_LT(client.settled_s, 900);
  EXPECT_LT(client.rms_s, 5 * kExchange_s);
  EXPECT_GT(client.rms_s, 0);
  EXPECT_THAT(logs(), HasSubstr("PTP_SLAVE"));
}

TEST_F(RealDaemons, Ptp4lFollowsOverUdpBySoftwareStamps) {
  SIMBENCH_SKIP_WITHOUT("ptp4l");
  const Command ptp4l{"ptp4l", "-4", "-S", "-m", "-i", "{interface}"};
  Command master = ptp4l;
  master.emplace_back("--priority1=1");
  Command slave = ptp4l;
  slave.emplace_back("-s");
  const Course client = run_twice(settings({master}, {slave}), two_hosts(), 600, 1e-3);
  EXPECT_LT(client.settled_s, 60);
  EXPECT_LT(client.rms_s, 2 * kExchange_s);
  EXPECT_GT(client.rms_s, 0);
}

// It starts chronyd and ptp4l, and gives the one what the other measures by shared memory.
TEST_F(RealDaemons, TimemasterHasChronydFollowPtp4l) {
  SIMBENCH_SKIP_WITHOUT("timemaster");
  SIMBENCH_SKIP_WITHOUT("chronyd");
  const Course client = run_twice(
      settings({{"ptp4l", "-4", "-S", "-m", "-i", "{interface}", "--priority1=1"}},
               {{"timemaster", "-m", "-f", "{files}/timemaster.conf"}},
               {{"timemaster.conf",
                 "[timemaster]\nntp_program chronyd\n[ptp_domain 0]\ninterfaces {interface}\n"
                 "[chrony.conf]\nmakestep 1 3\nlogdir /var/log/chrony\nlog refclocks\n"
                 "[ptp4l.conf]\ntime_stamping software\n"}}),
      two_hosts(), 900, 1e-3);
  EXPECT_LT(client.settled_s, 300);
  EXPECT_LT(client.rms_s, 2 * kExchange_s);
  EXPECT_GT(client.rms_s, 0);
  EXPECT_THAT(logs(), HasSubstr("Selected source PTP0"));
}

TEST_F(RealDaemons, RdateSetsTheClockInALoop) {
  SIMBENCH_SKIP_WITHOUT("rdate");
  SIMBENCH_SKIP_WITHOUT("chronyd");
  ProgramSettings programs = settings({{"chronyd", "-d", "-f", "{files}/server.conf"}}, {{"rdate"}},
                                      {{"server.conf", "local stratum 1\nallow\n"}});
  const std::string folder =
      std::filesystem::path(programs.paths.at("rdate")).parent_path().string();
  programs.programs.slave = {
      {"/bin/sh", "-c", "while true; do rdate -n -v {master}; sleep 20; done"}};
  programs.programs.environment["PATH"] = folder + ":/usr/bin:/bin";
  const Course client = run_twice(programs, two_hosts(), 200, 2e-3);
  EXPECT_LT(client.settled_s, 5);
  EXPECT_LT(client.max_s, 6 * kExchange_s + 20 * 5 * kSkew);
}

}  // namespace
}  // namespace simbench::sim

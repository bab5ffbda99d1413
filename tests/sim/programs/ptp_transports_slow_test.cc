// Debian's ptp4l over UDP by IPv4 and IPv6, over Ethernet, and as a time-aware station; chronyd
// over IPv6.
#include <regex>

#include "sim/programs/program_file.h"
#include "tests/sim/programs/daemons.h"

namespace simbench::sim {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kTolerance = 1.25;
constexpr const char* kDefault = "[global]\n";

class PtpTransports : public Daemons {
 protected:
  void SetUp() override {
    for (const char* program : {"ptp4l", "phc2sys", "chronyd"}) {
      try {
        find_program(program, SIMBENCH_PACKAGES);
      } catch (const ProgramError& error) {
        GTEST_SKIP() << error.what();
      }
    }
  }

  // ptp4l on all hosts, which follows or serves the card's clock, and phc2sys beside it. Clocks are
  // set once more when a master is elected: all hosts begin as their own.
  ProgramSettings ptp4l(const Command& words, const std::string& config,
                        const std::string& transport_specific = "0") {
    Command ptp4l{"ptp4l", "-m", "-q", "-f", "{files}/ptp4l.conf"};
    ptp4l.insert(ptp4l.end(), words.begin(), words.end());
    const Command to_card{"phc2sys", "-s", "CLOCK_REALTIME", "-c", "{interface}", "-O", "0"};
    const Command from_card{"phc2sys",
                            "-s",
                            "{interface}",
                            "-c",
                            "CLOCK_REALTIME",
                            "-w",
                            "-z",
                            "{files}/ptp4l",
                            "-O",
                            "0",
                            "-S",
                            "0.0001",
                            "--transportSpecific=" + transport_specific};
    const std::string common =
        "priority1 {host}\nstep_threshold 0.0001\nuds_address {files}/ptp4l\n";
    return settings({ptp4l, to_card}, {ptp4l, from_card}, {{"ptp4l.conf", config + common}});
  }

  // The configuration that linuxptp ships for 802.1AS.
  static std::string gptp() {
    std::ostringstream text;
    text << std::ifstream(std::string(SIMBENCH_PACKAGES) +
                          "/usr/share/doc/linuxptp/configs/gPTP.cfg")
                .rdbuf();
    EXPECT_THAT(text.str(), HasSubstr("01:80:C2:00:00:0E"));
    return text.str() + "\n";
  }

  static scenarios::Scenario star(const std::string& bandwidth_mbit_per_s) {
    return scenarios::load_scenario("6host_star",
                                    {{"/hosts/nic/hardware_stamps", "true"},
                                     {"/network/latency_exponential_ms", "0.00001"},
                                     {"/network/bandwidth_mbit_per_s", bandwidth_mbit_per_s}});
  }

  std::string log_of(std::size_t host) const { return file(host, "0_ptp4l.log"); }
  // The last path delay that the host's ptp4l prints.
  double path_delay_ns(std::size_t host) const {
    const std::string text = log_of(host);
    const std::regex pattern("path delay +([0-9]+)");
    double last = 0;
    for (std::sregex_iterator each(text.begin(), text.end(), pattern), end; each != end; ++each) {
      last = std::stod((*each)[1]);
    }
    return last;
  }
};

TEST_F(PtpTransports, AllTransportsSynchroniseAlike) {
  const std::vector<Course> expected =
      run(ptp4l({"-i", "{interface}", "-4"}, kDefault), star("1000"), 200, 2e-6);
  for (const char* transport : {"-6", "-2"}) {
    const std::vector<Course> slaves =
        run(ptp4l({"-i", "{interface}", transport}, kDefault), star("1000"), 200, 2e-6);
    ASSERT_EQ(slaves.size(), 5U);
    for (std::size_t i = 0; i < slaves.size(); ++i) {
      EXPECT_LE(slaves[i].settled_s, 40) << transport;
      EXPECT_LE(slaves[i].rms_s, kTolerance * expected[i].rms_s) << transport;
      EXPECT_GE(slaves[i].rms_s, expected[i].rms_s / kTolerance) << transport;
    }
  }
}

// At 100 Mbit/s a byte takes 80 ns, and the stamps lie around the switch's port alone. By IPv6 a
// message has 20 bytes of head more, and ptp4l adds two bytes for the checksum; over Ethernet it
// has no heads of IP and UDP (28 bytes) but two of padding.
TEST_F(PtpTransports, TheDelayIsThatOfTheHeads) {
  std::map<std::string, double> delays_ns;
  for (const char* transport : {"-4", "-6", "-2"}) {
    run(ptp4l({"-i", "{interface}", transport}, kDefault), star("100"), 120, 2e-6);
    delays_ns[transport] = path_delay_ns(1);
  }
  EXPECT_GT(delays_ns["-4"], 50'000);
  EXPECT_NEAR(delays_ns["-6"] - delays_ns["-4"], 22 * 80, 20);
  EXPECT_NEAR(delays_ns["-2"] - delays_ns["-4"], -26 * 80, 20);
}

// An ordinary switch forwards nothing that is sent to 01:80:C2:00:00:0E.
TEST_F(PtpTransports, GptpFindsNobodyThroughASwitchThatDoesNotKnowIt) {
  const std::vector<Course> slaves = run(ptp4l({"-i", "{interface}"}, gptp(), "1"),
                                         scenarios::load_scenario("4host_chain_idle"), 100, 1e-3);
  for (std::size_t host = 1; host <= slaves.size(); ++host) {
    EXPECT_EQ(slaves[host - 1].settled_s, 100) << "never";
    EXPECT_THAT(log_of(host), HasSubstr("selected local clock"));
    EXPECT_THAT(log_of(host), Not(HasSubstr("foreign master")));
  }
}

// Each host has a card for either neighbour; the last one's second leads nowhere.
TEST_F(PtpTransports, GptpSynchronisesAChainOfTimeAwareStations) {
  const std::vector<Course> slaves = run(ptp4l({"-i", "eth0", "-i", "eth1"}, gptp(), "1"),
                                         scenarios::load_scenario("4host_gptp_chain"), 250, 3e-6);
  ASSERT_EQ(slaves.size(), 3U);
  for (const Course& slave : slaves) {
    EXPECT_LE(slave.settled_s, 120);
    EXPECT_LE(slave.rms_s, 1e-6);
    EXPECT_GT(slave.rms_s, 0);
  }
  EXPECT_THAT(log_of(2), HasSubstr("port 2: "));
}

// The same profile over a cable, by Ethernet and by UDP.
TEST_F(PtpTransports, GptpOverEthernetIsAsGoodAsOverUdp) {
  const scenarios::Scenario pair = scenarios::load_scenario(
      "4host_gptp_chain",
      {{"/hosts/count", "2"}, {"/hosts/follows", "[0, 0]"}, {"/cameras/count", "2"}});
  const std::vector<Course> ethernet =
      run(ptp4l({"-i", "{interface}"}, gptp(), "1"), pair, 200, 3e-6);
  const std::vector<Course> udp =
      run(ptp4l({"-i", "{interface}", "-4"}, gptp(), "1"), pair, 200, 3e-6);
  ASSERT_EQ(ethernet.size(), 1U);
  EXPECT_LE(ethernet[0].settled_s, 60);
  EXPECT_LE(ethernet[0].rms_s, kTolerance * udp[0].rms_s);
  EXPECT_GE(ethernet[0].rms_s, udp[0].rms_s / kTolerance);
}

// A card that cannot put stamps into messages says so, and ptp4l in its words; it does not end.
TEST_F(PtpTransports, OneStepClocksAreRefusedByTheCard) {
  ProgramSettings programs =
      ptp4l({"-i", "{interface}", "-2"}, "[global]\ntime_stamping onestep\ntwoStepFlag 0\n");
  programs.hosts = 6;
  ProgramSync sync(std::move(programs));
  ServiceWorld world(star("1000"), 1);
  world.start(sync);
  world.run_until(60);
  EXPECT_THAT(sync.notes(), IsEmpty());
  EXPECT_THAT(log_of(1), HasSubstr("ioctl SIOCSHWTSTAMP failed: Numerical result out of range"));
  EXPECT_THAT(log_of(1), HasSubstr("FAULTY"));
}

TEST_F(PtpTransports, ChronydSynchronisesOverIpv6) {
  const scenarios::Scenario cards =
      scenarios::load_scenario("6host_star", {{"/hosts/nic/hardware_stamps", "true"}});
  // Addresses with a scope are not for chronyd; an interface is.
  const std::string by_link = "bindacqdevice {interface}\n";
  for (const std::string more : {"", "hwtimestamp *\n"}) {
    const auto follow = [&](const std::string& server) {
      ProgramSettings programs =
          chronyd(more + by_link + "server " + server + " iburst minpoll 2 maxpoll 4");
      programs.programs.files["server.conf"] += more;
      return run(std::move(programs), cards, 1500, 1e-3);
    };
    const std::vector<Course> expected = follow("{master}");
    for (const char* server : {"fd00::1", "fe80::aff:fe00:1", "host0"}) {
      const std::vector<Course> slaves = follow(server);
      for (std::size_t i = 0; i < slaves.size(); ++i) {
        EXPECT_LE(slaves[i].settled_s, 60) << server << more;
        EXPECT_LE(slaves[i].rms_s, kTolerance * expected[i].rms_s) << server << more;
        EXPECT_GE(slaves[i].rms_s, expected[i].rms_s / kTolerance) << server << more;
      }
    }
    EXPECT_THAT(logs(), HasSubstr("Selected source fd00::1"));
  }
}

}  // namespace
}  // namespace simbench::sim

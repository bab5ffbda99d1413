#include "algorithms/host_sync/ntp/ntp_service.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "tests/algorithms/host_sync/script_host.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

std::vector<HostSyncEntry> ntp_host_syncs() {
  std::vector<HostSyncEntry> entries;
  for (const char* name : {"ntp", "ntp_lan", "ntp_daemon_loop", "ntp_broadcast_volley",
                           "ntp_broadcast_fixed", "w32time", "w32time_domain", "chrony"}) {
    entries.push_back(*find_algorithm<HostSyncEntry>(name));
  }
  return entries;
}

std::unique_ptr<HostSync> make_service(const std::string& name, const ParameterValues& given = {}) {
  for (const HostSyncEntry& entry : ntp_host_syncs()) {
    if (entry.info.name == name) return entry.make(check_parameters(entry.info.parameters, given));
  }
  return nullptr;
}

TEST(NtpRegistration, EveryMemberIsAService) {
  for (const HostSyncEntry& entry : nonempty(ntp_host_syncs())) {
    const auto algorithm = entry.make(check_parameters(entry.info.parameters, {}));
    EXPECT_TRUE(algorithm->warm_up()) << entry.info.name;
    const auto short_one =
        entry.make(check_parameters(entry.info.parameters, {{"service_hours", 0.5}}));
    EXPECT_EQ(short_one->warm_up(), from_ms(1800e3)) << entry.info.name;
  }
}

TEST(NtpRegistration, ImpossibleParametersAreRefused) {
  for (const std::string name : {"ntp", "chrony"}) {
    EXPECT_THROW(make_service(name, {{"min_poll", 8.0}, {"max_poll", 7.0}}), ParameterError)
        << name;
    EXPECT_THROW(make_service(name, {{"max_poll", 18.0}}), ParameterError) << name;
    EXPECT_THROW(make_service(name, {{"stamps", std::string("hardware")}}), ParameterError) << name;
  }
  EXPECT_THROW(make_service("ntp_lan", {{"min_poll", 2.0}}), ParameterError);
  EXPECT_THROW(make_service("ntp_lan", {{"min_poll", 3.5}}), ParameterError);
  EXPECT_THROW(make_service("ntp", {{"step_out_s", 299.0}}), ParameterError);
  EXPECT_THROW(make_service("w32time_domain", {{"poll_interval_s", 1.0}}), ParameterError);
}

TEST(NtpRegistration, ParametersReachTheAlgorithm) {
  // An offset that the step limit leaves to the slew.
  ScriptWorld world(2);
  world.connect(from_ms(1));
  world.host(0).offset = from_ms(300);
  world.run(*make_service("ntp", {{"step_ms", 400.0}, {"iburst", true}}), from_ms(30e3));
  EXPECT_TRUE(world.host(1).steps.empty());
  ASSERT_EQ(world.host(1).slews.size(), 1U);
  EXPECT_EQ(world.host(1).slews[0].offset, from_ms(300));
  EXPECT_DOUBLE_EQ(world.host(1).slews[0].rate_ppb, 500e3);
}

TEST(NtpService, AServerThatReturnsIsAskedInABurst) {
  ScriptWorld world(2);
  world.connect(from_ms(1));
  world.script_link(0, 1, [](std::size_t index, const Bytes&) {
    const bool is_down = index >= 10 && index < 25;
    return is_down ? std::vector<Nanoseconds>{} : std::vector{from_ms(1)};
  });
  world.run(*make_service("ntp"), from_ms(1800e3));
  const auto& exchanges = world.host(1).exchanges;
  ASSERT_GE(exchanges.size(), 18U);
  for (std::size_t i = 1; i < 18; ++i) {
    const double gap_s = to_seconds(*exchanges[i].t1 - *exchanges[i - 1].t1);
    const bool in_burst = i < 8 || i > 10;
    if (in_burst) {
      EXPECT_NEAR(gap_s, 2, 0.01) << i;
    } else {
      EXPECT_GT(gap_s, 45) << i;
    }
  }
  EXPECT_EQ(world.host(1).outcomes.size(), 1U);
}

// A packet of a mode that is looked at, from a server that claims to be synchronised.
Bytes service_noise(boost::random::mt19937& engine) {
  boost::random::uniform_int_distribution<int> byte(0, 255);
  boost::random::uniform_int_distribution<int> mode(3, 5);
  Bytes bytes(kNtpPacketBytes);
  for (std::byte& each : bytes) each = static_cast<std::byte>(byte(engine));
  bytes[0] = static_cast<std::byte>(0x20 + mode(engine));
  bytes[1] = std::byte{1};
  return bytes;
}

TEST(NtpFamilyFuzz, NoisePacketsStopNoService) {
  for (const HostSyncEntry& entry : nonempty(ntp_host_syncs())) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      boost::random::mt19937 engine(seed);
      ScriptWorld world(3);
      world.connect(from_ms(1));
      world.host(0).offset = from_ms(700);
      const auto algorithm = entry.make(check_parameters(entry.info.parameters, {}));
      for (int i = 0; i < 2000; ++i) {
        const PeerId to = static_cast<PeerId>(i % 3);
        const PeerId from = to == 0 ? 1 : 0;
        world.call_at(from_ms(i * 1100.0), [&world, to, from, bytes = service_noise(engine)] {
          world.host(to).deliver(from, bytes);
        });
      }
      world.run(*algorithm, from_ms(3600e3));
      for (const PeerId slave : nonempty(world.slaves())) {
        EXPECT_LE(world.host(slave).outcomes.size(), 1U) << entry.info.name << ", seed " << seed;
      }
      EXPECT_GE(world.unfinished(), 1U) << "the server never ends";
      const bool believes_broadcasts = entry.info.name.find("broadcast") != std::string::npos;
      if (believes_broadcasts) continue;
      EXPECT_LT(std::abs(to_ms(world.host(1).lead_over(world.host(0)))), 1)
          << entry.info.name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace simbench

#include "algorithms/host_sync/ptp/ptp.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <string>
#include <vector>

#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/host_sync/ptp/ptp_port.h"
#include "tests/algorithms/host_sync/script_host.h"
#include "tests/algorithms/host_sync/unreliable_link.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

constexpr Nanoseconds kPtpLatency{150'000};

TEST(PtpOffsetTest, EndToEndAndPeerDelayFindTheOffset) {
  // Slave 5000 ahead, delay 300 each way.
  PtpOffset filter(10);
  filter.add_request(0, 0, 1);
  EXPECT_FALSE(filter.offset());
  filter.add_sync(1'000'000, 1'000'300 + 5'000);
  EXPECT_FALSE(filter.offset());
  filter.add_request(1'205'000, 1'200'300, 1);
  EXPECT_EQ(filter.offset(), Nanoseconds(5000));
  PtpOffset peer(10);
  peer.add_peer_delay(1'005'000, 1'000'300, 1'000'700, 1'006'000);
  peer.add_sync(2'000'000, 2'000'300 + 5'000);
  EXPECT_EQ(peer.offset(), Nanoseconds(5000));
  peer.forget_sync();
  EXPECT_FALSE(peer.offset());
}

TEST(PtpOffsetTest, ALateRequestDoesNotCountInTheMedian) {
  PtpOffset filter(3);
  filter.add_sync(1000, 1300);
  for (const std::int64_t late : {0, 90'000, 0}) filter.add_request(2000, 2300 + late, 1);
  EXPECT_EQ(filter.offset(), Nanoseconds(0));
}

TEST(PtpOffsetTest, TheRateRatioTakesTheDriftBetweenSyncAndRequestOut) {
  // The slave's clock gains 1e-4 on the master's; between Sync and request pass 0.5 s.
  PtpOffset filter(10);
  filter.add_sync(1'000'000, 1'000'300);
  filter.add_request(501'050'300, 501'000'300 + 300, 1 - 1e-4);
  // Without the ratio the delay would come out some 25 us too short.
  filter.add_sync(2'000'000, 2'000'300);
  EXPECT_NEAR(static_cast<double>(filter.offset()->count()), 0, 4);
}

class PtpTest : public testing::TestWithParam<bool> {
 protected:
  PtpTest() {
    world_.connect(kPtpLatency);
    for (const PeerId slave : world_.slaves()) {
      world_.host(slave).offset = from_ms(-400.0 * slave);
      world_.host(slave).uniform = 0.4;
    }
    for (PeerId host = 0; host < 3; ++host) world_.host(host).stamps_departures = true;
    settings_.is_peer_delay = GetParam();
  }
  double lead_us(PeerId slave) { return to_ms(world_.host(slave).lead_over(world_.host(0))) * 1e3; }

  ScriptWorld world_{3};
  PtpSettings settings_;
};

TEST_P(PtpTest, StepsTheSlavesToTheMaster) {
  Ptp sync(settings_);
  EXPECT_EQ(sync.warm_up(), from_ms(300e3));
  world_.run(sync, from_ms(60e3));
  EXPECT_EQ(world_.unfinished(), 3u);
  for (const PeerId slave : nonempty(world_.slaves())) {
    EXPECT_NEAR(lead_us(slave), 0, 0.01);
    ASSERT_EQ(world_.host(slave).outcomes.size(), 1u);
    EXPECT_TRUE(world_.host(slave).outcomes[0].synchronised)
        << world_.host(slave).outcomes[0].message;
    ASSERT_FALSE(world_.host(slave).exchanges.empty());
    const Exchange& exchange = world_.host(slave).exchanges.front();
    EXPECT_EQ((*exchange.t2 - *exchange.t1) + (*exchange.t4 - *exchange.t3), 2 * kPtpLatency);
  }
}

TEST_P(PtpTest, AsymmetryIsInTheResultWithItsHalf) {
  world_.set_latency(1, 0, kPtpLatency + from_ms(0.1));
  Ptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  EXPECT_NEAR(lead_us(1), 50, 0.01);
}

// What a transparent clock does: event messages take longer and say so in their correction.
TEST_P(PtpTest, CorrectionsOfTransparentClocksAreTakenOut) {
  ScriptWorld& world = world_;
  const auto deliver_corrected = [&world](PeerId from, PeerId to, Nanoseconds residence) {
    return [&world, from, to, residence](std::size_t, const Bytes& bytes) {
      const auto message = decode_ptp_message(bytes);
      if (!message || static_cast<int>(message->type) > 3) return std::vector{kPtpLatency};
      PtpMessage corrected = *message;
      corrected.correction += residence.count() * 65'536;
      const Bytes changed = encode(corrected);
      world.call_at(world.now() + kPtpLatency + residence,
                    [&world, from, to, changed] { world.host(to).deliver(from, changed); });
      return std::vector<Nanoseconds>{};
    };
  };
  world_.script_link(0, 1, deliver_corrected(0, 1, from_ms(0.7)));
  world_.script_link(1, 0, deliver_corrected(1, 0, from_ms(0.1)));
  Ptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  EXPECT_NEAR(lead_us(1), 0, 0.01);
}

TEST_P(PtpTest, LossDuplicatesReorderingAndGarbageCostMeasurementsOnly) {
  boost::random::mt19937_64 engine(17);
  const LinkScript unreliable = unreliable_link(
      engine, kPtpLatency,
      {.twice_after = from_ms(0.3), .late = {kPtpLatency, kPtpLatency + from_ms(2500)}});
  world_.script_link(0, 1, unreliable);
  world_.script_link(1, 0, unreliable);
  for (int i = 0; i < 1000; ++i) {
    const Bytes bytes = random_bytes(engine, 60);
    world_.call_at(from_ms(60.0 * i), [this, bytes] { world_.host(1).deliver(0, bytes); });
    world_.call_at(from_ms(60.0 * i + 9), [this, bytes] { world_.host(0).deliver(1, bytes); });
  }
  Ptp sync(settings_);
  world_.run(sync, from_ms(120e3));
  // A duplicate that comes later than its like is taken for it where that one was lost.
  EXPECT_NEAR(lead_us(1), 0, 0.5) << "seed 17";
  EXPECT_NEAR(lead_us(2), 0, 0.01);
}

TEST_P(PtpTest, ASilentMasterIsOneOutcome) {
  world_.script_link(0, 2, [](std::size_t, const Bytes&) { return std::vector<Nanoseconds>{}; });
  Ptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  ASSERT_EQ(world_.host(2).outcomes.size(), 1u);
  EXPECT_FALSE(world_.host(2).outcomes[0].synchronised);
  EXPECT_NE(world_.host(2).outcomes[0].message.find("has not locked"), std::string::npos);
  EXPECT_TRUE(world_.host(1).outcomes.at(0).synchronised);
}

TEST_P(PtpTest, StampsThatTheHostDoesNotTakeAreAnOutcomeThatNamesThem) {
  const auto expect_failure = [this](StampSource source, const char* what) {
    settings_.stamps = source;
    Ptp sync(settings_);
    ScriptWorld world(2);
    world.connect(kPtpLatency);
    world.run(sync, from_ms(60e3));
    ASSERT_EQ(world.host(1).outcomes.size(), 1u) << what;
    EXPECT_FALSE(world.host(1).outcomes[0].synchronised) << what;
    EXPECT_NE(world.host(1).outcomes[0].message.find(what), std::string::npos)
        << world.host(1).outcomes[0].message;
    EXPECT_TRUE(world.host(1).steps.empty());
    EXPECT_EQ(world.unfinished(), 0u) << what;
  };
  expect_failure(StampSource::kCard, "Host::hardware_clock");
  expect_failure(StampSource::kKernel, "MessageChannel::transmit_stamp");
}

TEST_P(PtpTest, TheProgramsStampsAreTakenWhereTheyAreAskedFor) {
  for (PeerId host = 0; host < 3; ++host) world_.host(host).stamps_departures = false;
  settings_.stamps = StampSource::kProgram;
  Ptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  EXPECT_NEAR(lead_us(1), 0, 0.01);
}

TEST_P(PtpTest, TheRateOfTheMessagesIsTheSettings) {
  settings_.sync_interval = settings_.delay_interval = from_ms(62.5);
  std::size_t from_master = 0;
  std::size_t from_slave = 0;
  world_.script_link(0, 1, [&from_master](std::size_t, const Bytes&) {
    ++from_master;
    return std::vector{kPtpLatency};
  });
  world_.script_link(1, 0, [&from_slave](std::size_t, const Bytes&) {
    ++from_slave;
    return std::vector{kPtpLatency};
  });
  world_.host(1).uniform = 0.5;  // of an interval that is varied from 0 to twice itself
  Ptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  // Sync and Follow_Up; the answers: Delay_Resp, or Pdelay_Resp and its Follow_Up.
  EXPECT_NEAR(static_cast<double>(from_master), 60 * 16 * (GetParam() ? 4 : 3), 8);
  EXPECT_NEAR(static_cast<double>(from_slave), 60 * 16, 4);
  EXPECT_NEAR(lead_us(1), 0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(EndToEndAndPeerDelay, PtpTest, testing::Bool());

}  // namespace
}  // namespace simbench

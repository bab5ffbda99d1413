// What Algorithms 1 and 2 measure, and the slave's error that follows (yoon2021_rig.h).
#include "algorithms/host_sync/yoon2021/yoon2021.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "algorithms/host_sync/messages.h"
#include "tests/algorithms/host_sync/script_host.h"
#include "tests/algorithms/host_sync/yoon2021/yoon2021_rig.h"

namespace simbench {
namespace {

// How far the slave's clock is ahead after one session over links of this latency.
Nanoseconds lead_after(Yoon2021Settings settings, Nanoseconds latency) {
  ScriptWorld world(2);
  use_common_costs(world, 2, latency);
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  EXPECT_EQ(world.unfinished(), 0U);
  EXPECT_EQ(world.host(0).outcomes.size(), 1U);
  EXPECT_TRUE(world.host(0).outcomes.at(0).synchronised);
  EXPECT_EQ(world.host(0).outcomes.at(0).passes, 1U);
  return world.host(1).lead_over(world.host(0));
}

class Yoon2021AtLatency : public testing::TestWithParam<double> {
 protected:
  Nanoseconds latency() const { return from_ms(GetParam()); }
  Nanoseconds needed() const { return kSend + latency() + kWake + kSetEffective; }
};

INSTANTIATE_TEST_SUITE_P(LatenciesMs, Yoon2021AtLatency, testing::Values(0.1, 1.0, 5.0, 20.0));

TEST_P(Yoon2021AtLatency, LiteralNetworkDelayIsTheSendersOccupancyWhateverTheLatency) {
  EXPECT_EQ(lead_after(settings_for(true, false), latency()), kSend - needed());
}

TEST_P(Yoon2021AtLatency, TimeDelayIsHalfOfGetAndSet) {
  EXPECT_EQ(lead_after(settings_for(false, true), latency()), kSet / 2 - needed());
}

TEST_P(Yoon2021AtLatency, BothAddsThem) {
  EXPECT_EQ(lead_after(settings_for(true, true), latency()), kSend + kSet / 2 - needed());
}

TEST_P(Yoon2021AtLatency, NeitherLagsByTheWholeDelay) {
  EXPECT_EQ(lead_after(settings_for(false, false), latency()), -needed());
}

TEST_P(Yoon2021AtLatency, IntendedNetworkDelayIsTheLatency) {
  Yoon2021Settings settings = settings_for(true, false);
  settings.ask_for_stamps = true;
  EXPECT_EQ(lead_after(settings, latency()), -kSetEffective);
}

TEST(Yoon2021, IntendedNetworkDelayErrsByHalfTheAsymmetry) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  world.set_latency(0, 1, from_ms(1));
  world.set_latency(1, 0, from_ms(3));
  Yoon2021Settings settings = settings_for(true, false);
  settings.ask_for_stamps = true;
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  EXPECT_EQ(world.host(1).lead_over(world.host(0)), from_ms((3.0 - 1.0) / 2) - kSetEffective);
}

TEST(Yoon2021, ASendIntervalBecomesTheNetworkDelay) {
  Yoon2021Settings settings = settings_for(true, false);
  settings.stamps = 10;
  settings.send_interval = from_ms(1);
  // From READY to the last stamp pass 10 intervals and one send.
  const Nanoseconds t_l = from_ms(1) + kSend / 10;
  EXPECT_EQ(lead_after(settings, from_ms(0.2)),
            t_l - (kSend + from_ms(0.2) + kWake + kSetEffective));
}

TEST(Yoon2021, ALeadIsAcceptedWhateverTheThreshold) {
  Yoon2021Settings settings = settings_for(true, false);
  settings.send_interval = from_ms(40);
  settings.threshold = from_ms(6);
  EXPECT_GT(lead_after(settings, from_ms(0.2)), from_ms(38));
}

TEST(Yoon2021, ADelayedAcknowledgementBecomesALead) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(0.2));
  // READY goes out; Nagle holds the stamps until the acknowledgement, 200 ms later.
  world.script_link(0, 1, [&world](std::size_t, const Bytes& bytes) {
    const auto message = decode_session_message(bytes);
    const bool held = message->kind == MessageKind::kStamp && world.now() < from_ms(200);
    return std::vector{held ? from_ms(200.2) - world.now() : from_ms(0.2)};
  });
  Yoon2021Settings settings = settings_for(true, false);
  settings.stamps = 5;
  settings.threshold = from_ms(5);
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  ASSERT_TRUE(world.host(0).outcomes.at(0).synchronised);
  EXPECT_EQ(world.host(0).outcomes.at(0).passes, 1U);
  // READY left at g and was read w after its arrival; the five stamps are read w apart.
  const Nanoseconds t_l = (from_ms(200) - kSend + 4 * kWake) / 5;
  EXPECT_EQ(world.host(1).lead_over(world.host(0)),
            t_l - (kSend + from_ms(0.2) + kWake + kSetEffective));
}

TEST(Yoon2021, TheTimeLoopReallyStepsTheClockBack) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  Yoon2021Settings settings = settings_for(false, true);
  settings.clock_calls = 3;
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  const std::vector<Nanoseconds>& steps = world.host(1).steps;
  ASSERT_EQ(steps.size(), 4U);
  for (int call = 0; call < 3; ++call) EXPECT_EQ(steps[call], -kSetEffective) << call;
}

TEST(Yoon2021, ReportsTheExchangeOnTheClocksThatReadIt) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  world.host(0).offset = from_ms(7000);
  Yoon2021 algorithm(settings_for(false, false));
  world.run(algorithm);
  ASSERT_EQ(world.host(0).exchanges.size(), 1U);
  EXPECT_TRUE(world.host(1).exchanges.empty());
  const Exchange& exchange = world.host(0).exchanges.front();
  const Nanoseconds one_way = kSend + from_ms(1) + kWake;
  EXPECT_EQ(exchange.peer, 1U);
  EXPECT_FALSE(exchange.t2);
  EXPECT_EQ(*exchange.t4 - *exchange.t1, 2 * one_way + kSet);
  // The slave has T_m from a quarter into its call on, and reads its clock at the end of the call.
  EXPECT_EQ(*exchange.t3 - *exchange.t1, kSet - kSetEffective);
}

// One session over a link of this latency; what its slave reports.
SessionDelays delays_of(const Yoon2021Settings& settings, Nanoseconds latency) {
  ScriptWorld world(2);
  use_common_costs(world, 2, latency);
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  EXPECT_TRUE(world.host(0).delays.empty());
  EXPECT_EQ(world.host(1).delays.size(), 1U);
  return world.host(1).delays.at(0);
}

TEST_P(Yoon2021AtLatency, TheSlaveReportsWhatItMeasuredAndAdded) {
  const SessionDelays delays = delays_of(settings_for(true, true), latency());
  EXPECT_EQ(delays.slave, 1U);
  EXPECT_EQ(delays.pass, 1U);
  EXPECT_EQ(delays.t_l, kSend);
  EXPECT_EQ(delays.t_t, kSet / 2);
  EXPECT_EQ(delays.t_d, kSend + kSet / 2);
  EXPECT_EQ(delays.get, Nanoseconds(0));
  EXPECT_EQ(delays.set, kSet);
  const Yoon2021Settings settings;
  // From READY's reading: the stamps, the calls, MEASURED, SET_TIME and the step.
  EXPECT_EQ(delays.end - delays.begin, settings.stamps * kSend + settings.clock_calls * kSet +
                                           2 * (kSend + latency() + kWake) + kSet);
}

TEST_P(Yoon2021AtLatency, TheIntendedDelayIsHalfTheRoundTrip) {
  Yoon2021Settings settings = settings_for(true, false);
  settings.ask_for_stamps = true;
  EXPECT_EQ(delays_of(settings, latency()).t_l, kSend + latency() + kWake);
}

TEST(Yoon2021, WhatIsMeasuredIsReportedWhateverIsAdded) {
  for (const bool network : {false, true}) {
    for (const bool time : {false, true}) {
      const SessionDelays delays = delays_of(settings_for(network, time), from_ms(1));
      EXPECT_EQ(delays.t_l, kSend);
      EXPECT_EQ(delays.t_t, kSet / 2);
      EXPECT_EQ(delays.t_d,
                (network ? kSend : Nanoseconds(0)) + (time ? kSet / 2 : Nanoseconds(0)));
    }
  }
}

// A threshold that is never met: each pass is reported.
TEST(Yoon2021, EachPassIsReported) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(5));
  Yoon2021Settings settings = settings_for(true, true);
  settings.threshold = from_ms(1);
  settings.pass_limit = 3;
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  ASSERT_FALSE(world.host(0).outcomes.at(0).synchronised);
  const std::vector<SessionDelays>& delays = world.host(1).delays;
  ASSERT_EQ(delays.size(), 3U);
  for (std::uint32_t pass = 1; pass <= 3; ++pass) EXPECT_EQ(delays[pass - 1].pass, pass);
  EXPECT_LT(delays[0].end, delays[1].begin);
}

// What is lost before the slave has measured leaves nothing to report.
TEST(Yoon2021, APassThatIsCutOffIsNotReported) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  world.script_link(0, 1, [lost = false](std::size_t, const Bytes& bytes) mutable {
    const auto message = decode_session_message(bytes);
    const bool loses = message->kind == MessageKind::kStamp && !std::exchange(lost, true);
    return loses ? std::vector<Nanoseconds>() : std::vector{from_ms(1)};
  });
  Yoon2021 algorithm(settings_for(true, true));
  world.run(algorithm);
  EXPECT_EQ(world.host(0).outcomes.at(0).passes, 2U);
  ASSERT_EQ(world.host(1).delays.size(), 1U);
  EXPECT_EQ(world.host(1).delays[0].pass, 2U);
}

TEST(Yoon2021, AThresholdOfExactlyTheDelayIsMet) {
  Yoon2021Settings settings = settings_for(true, true);
  settings.threshold = 2 * (kSend + from_ms(1) + kWake) + kSet;
  lead_after(settings, from_ms(1));
}

// A stream, 0.15 ms long, on which 30 % of the messages (and those behind them) are late by up to
// 10 ms: the world "spiky LAN" of docs/reference/calibration.md section 4.
LinkScript spiky_stream(const ScriptWorld& world, std::mt19937_64& random) {
  return [&world, &random, last = Nanoseconds{0}](std::size_t, const Bytes&) mutable {
    const Nanoseconds spike{static_cast<std::int64_t>(random() % 10'000'000)};
    const bool late = random() % 10 < 3;
    last = std::max(last, world.now() + from_ms(0.15) + (late ? spike : Nanoseconds{0}));
    return std::vector{last - world.now()};
  };
}

// An accepted slave lags by no more than T_th; T_th 1.5 ms takes 1.9 passes on average.
TEST(Yoon2021, TheThresholdBoundsTheLagOnASpikyNetwork) {
  constexpr std::uint64_t kSeed = 20210918;
  std::mt19937_64 random(kSeed);
  constexpr int kSessions = 400;
  std::uint32_t passes = 0;
  for (int i = 0; i < kSessions; ++i) {
    ScriptWorld world(2);
    use_common_costs(world, 2, from_ms(1));
    world.host(1).costs.set = from_ms(0.05);
    world.script_link(0, 1, spiky_stream(world, random));
    world.script_link(1, 0, spiky_stream(world, random));
    Yoon2021Settings settings = settings_for(false, true);
    settings.stamps = 1;
    settings.clock_calls = 1;
    settings.threshold = from_ms(1.5);
    Yoon2021 algorithm(settings);
    world.run(algorithm);
    ASSERT_TRUE(world.host(0).outcomes.at(0).synchronised) << "seed " << kSeed << ", run " << i;
    passes += world.host(0).outcomes.at(0).passes;
    const Nanoseconds lead = world.host(1).lead_over(world.host(0));
    EXPECT_GE(lead, -settings.threshold) << "seed " << kSeed << ", run " << i;
    EXPECT_LE(lead, Nanoseconds{0}) << "seed " << kSeed << ", run " << i;
  }
  EXPECT_NEAR(static_cast<double>(passes) / kSessions, 1.87, 0.2) << "seed " << kSeed;
}

}  // namespace
}  // namespace simbench

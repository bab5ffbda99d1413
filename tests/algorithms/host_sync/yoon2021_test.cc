// Algorithms 1 and 2 over scripted hosts: with constant costs and latencies every number is known.
//
// g: occupancy of a send, L: latency, w: wake-up, c: cost of a set, of which the first quarter
// passes before the new value counts. From the reading of T_m to that instant pass g + L + w + c/4:
// the delay really needed. The slave's error is t_d minus that.
#include "algorithms/host_sync/yoon2021.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>

#include "algorithms/host_sync/wire.h"
#include "tests/algorithms/host_sync/script_host.h"

namespace simbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr Nanoseconds kSend{30'000};
constexpr Nanoseconds kWake{20'000};
constexpr Nanoseconds kSet{4'000'000};
constexpr Nanoseconds kSetEffective = kSet / 4;

void use_common_costs(ScriptWorld& world, PeerId hosts, Nanoseconds latency) {
  for (PeerId id = 0; id < hosts; ++id) {
    world.host(id).costs = {.send = kSend, .set = kSet, .set_fraction = 0.25, .wake = kWake};
    world.host(id).offset = from_ms(300) * id;
    if (id == 0) continue;
    world.set_latency(0, id, latency);
    world.set_latency(id, 0, latency);
  }
}

Yoon2021Settings settings_for(bool network, bool time) {
  Yoon2021Settings settings;
  settings.add_network_delay = network;
  settings.add_time_delay = time;
  return settings;
}

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

TEST(Yoon2021, AThresholdBelowTheRoundTripEndsAtThePassLimit) {
  ScriptWorld world(4);
  use_common_costs(world, 4, from_ms(0.6));
  Yoon2021Settings settings = settings_for(true, true);
  settings.threshold = from_ms(1);
  settings.stamps = 2;
  settings.clock_calls = 2;
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  EXPECT_EQ(world.unfinished(), 0U);
  ASSERT_EQ(world.host(0).outcomes.size(), 3U);
  const SyncOutcome& outcome = world.host(0).outcomes.back();
  EXPECT_EQ(outcome.slave, 3U);
  EXPECT_FALSE(outcome.synchronised);
  EXPECT_EQ(outcome.passes, 200U);
  EXPECT_EQ(outcome.message,
            "slave 3: not synchronised after 200 passes: the smallest round trip seen was 5.3 ms, "
            "the threshold is 1 ms; a threshold_ms above the round trip can be met");
}

TEST(Yoon2021, AThresholdOfExactlyTheDelayIsMet) {
  Yoon2021Settings settings = settings_for(true, true);
  settings.threshold = 2 * (kSend + from_ms(1) + kWake) + kSet;
  lead_after(settings, from_ms(1));
}

// A slave that answers at once, always with a clock that stands still.
Task<void> answer_with_a_stopped_clock(Host& host) {
  MessageChannel& channel = host.open_channel(0, Transport::kStream);
  while (true) {
    auto received = co_await channel.receive(host.steady_clock().now() + from_ms(60e3));
    if (!received) co_return;
    SessionMessage message = *decode_session_message(received->bytes);
    const bool last_stamp = message.kind == MessageKind::kStamp && message.index == 1;
    const bool set_time = message.kind == MessageKind::kSetTime;
    if (!last_stamp && !set_time) continue;
    message.kind = last_stamp ? MessageKind::kMeasured : MessageKind::kSlaveTime;
    message.index = 0;
    message.time = HostTime{};
    Bytes answer = encode(message);
    co_await channel.send(std::move(answer));
  }
}

TEST(Yoon2021, ALagBeyondTheThresholdIsNamedAsSuch) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  world.host(0).offset = from_ms(500);
  Yoon2021Settings settings = settings_for(true, true);
  settings.stamps = 2;
  settings.pass_limit = 1;
  Yoon2021 algorithm(settings);
  world.start(answer_with_a_stopped_clock(world.host(1)));
  world.start(algorithm.run_master(world.host(0), {1}));
  world.run();
  ASSERT_EQ(world.host(0).outcomes.size(), 1U);
  EXPECT_FALSE(world.host(0).outcomes.front().synchronised);
  EXPECT_THAT(world.host(0).outcomes.front().message,
              HasSubstr("not synchronised after 1 pass: its clock stayed behind"));
}

TEST(Yoon2021, AHostWithoutAProcessIsGivenUpAndTheOthersAreServed) {
  ScriptWorld world(4);
  use_common_costs(world, 4, from_ms(1));
  Yoon2021Settings settings = settings_for(true, true);
  Yoon2021 algorithm(settings);
  world.start(algorithm.run_slave(world.host(1), 0));
  world.start(algorithm.run_slave(world.host(3), 0));
  world.start(algorithm.run_master(world.host(0), {1, 2, 3}));
  world.run();
  EXPECT_EQ(world.unfinished(), 0U);
  const std::vector<SyncOutcome>& outcomes = world.host(0).outcomes;
  ASSERT_EQ(outcomes.size(), 3U);
  EXPECT_TRUE(outcomes[0].synchronised);
  EXPECT_FALSE(outcomes[1].synchronised);
  EXPECT_EQ(outcomes[1].passes, Yoon2021::kSilentPassLimit);
  EXPECT_EQ(outcomes[1].message,
            "slave 2: no complete answer within 5000 ms in 5 passes in a row; is it running and "
            "reachable, and does the transport lose messages?");
  EXPECT_TRUE(outcomes[2].synchronised);
}

TEST(Yoon2021, ASlaveWhoseTurnNeverComesEnds) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  Yoon2021Settings settings;
  settings.turn_timeout = from_ms(90e3);
  Yoon2021 algorithm(settings);
  world.start(algorithm.run_slave(world.host(1), 0));
  world.run();
  EXPECT_EQ(world.unfinished(), 0U);
  EXPECT_EQ(world.now(), from_ms(90e3));
}

// Whichever message is lost, first time: the session goes on with another pass, or at worst ends.
TEST(Yoon2021, AnyLostMessageCostsAtMostAPass) {
  for (const bool intended : {false, true}) {
    for (const PeerId sender : {0U, 1U}) {
      for (std::size_t lost = 0; lost < 6; ++lost) {
        ScriptWorld world(2);
        use_common_costs(world, 2, from_ms(1));
        world.script_link(sender, 1 - sender, [lost](std::size_t index, const Bytes&) {
          return index == lost ? std::vector<Nanoseconds>{} : std::vector{from_ms(1)};
        });
        Yoon2021Settings settings = settings_for(true, true);
        settings.stamps = 3;
        settings.transport = Transport::kDatagram;
        settings.ask_for_stamps = intended;
        Yoon2021 algorithm(settings);
        world.run(algorithm);
        EXPECT_EQ(world.unfinished(), 0U);
        ASSERT_EQ(world.host(0).outcomes.size(), 1U);
        EXPECT_TRUE(world.host(0).outcomes.front().synchronised)
            << "sender " << sender << ", message " << lost << ", intended " << intended;
        EXPECT_LE(world.host(0).outcomes.front().passes, 2U);
        EXPECT_LT(world.now(), from_ms(60e3));
      }
    }
  }
}

TEST(Yoon2021, EveryMessageTwiceChangesNothingForTheIntendedEstimate) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  const auto twice = [](std::size_t, const Bytes&) {
    return std::vector{from_ms(1), from_ms(1.5)};
  };
  world.script_link(0, 1, twice);
  world.script_link(1, 0, twice);
  Yoon2021Settings settings = settings_for(true, false);
  settings.ask_for_stamps = true;
  Yoon2021 algorithm(settings);
  world.run(algorithm);
  EXPECT_EQ(world.unfinished(), 0U);
  EXPECT_TRUE(world.host(0).outcomes.at(0).synchronised);
  EXPECT_EQ(world.host(0).exchanges.size(), 1U);
  // A late copy may be in the reader's way for one wake-up, never stand for another message.
  EXPECT_LE(abs(world.host(1).lead_over(world.host(0)) + kSetEffective), 2 * kWake);
}

TEST(Yoon2021, ForeignBytesAreIgnored) {
  ScriptWorld world(2);
  use_common_costs(world, 2, from_ms(1));
  for (const Nanoseconds at : {from_ms(0), from_ms(1), from_ms(2), from_ms(500)}) {
    world.call_at(at, [&world] {
      world.host(0).deliver(1, Bytes(20, std::byte{0x59}));
      world.host(1).deliver(0, Bytes{});
    });
  }
  Yoon2021 algorithm(settings_for(true, true));
  world.run(algorithm);
  EXPECT_EQ(world.unfinished(), 0U);
  EXPECT_TRUE(world.host(0).outcomes.at(0).synchronised);
  EXPECT_EQ(world.host(0).outcomes.at(0).passes, 1U);
}

TEST(Yoon2021, SlavesAreServedInTurnWithAGapBetween) {
  ScriptWorld world(4);
  use_common_costs(world, 4, from_ms(1));
  Yoon2021 algorithm(settings_for(true, true));
  world.run(algorithm);
  const std::vector<Nanoseconds>& times = world.host(0).outcome_times;
  ASSERT_EQ(times.size(), 3U);
  const Nanoseconds session = times[0];  // no gap before the first
  EXPECT_EQ(times[1] - times[0], from_ms(1000) + session);
  EXPECT_EQ(times[2] - times[1], from_ms(1000) + session);
}

TEST(Yoon2021, ParallelSessionsServeEverySlaveOnceAndSooner) {
  for (const std::uint32_t groups : {2U, 5U, 64U}) {
    ScriptWorld world(6);
    use_common_costs(world, 6, from_ms(1));
    Yoon2021Settings settings = settings_for(true, true);
    settings.parallel_sessions = groups;
    Yoon2021 algorithm(settings);
    world.run(algorithm);
    EXPECT_EQ(world.unfinished(), 0U);
    std::vector<PeerId> served;
    for (const SyncOutcome& outcome : world.host(0).outcomes) {
      EXPECT_TRUE(outcome.synchronised);
      served.push_back(outcome.slave);
    }
    std::sort(served.begin(), served.end());
    EXPECT_THAT(served, ElementsAre(1, 2, 3, 4, 5));
    EXPECT_LT(world.host(0).outcome_times.back(), from_ms(groups == 2 ? 3300 : 500));
  }
}

TEST(Yoon2021, AFaultInOneParallelSessionIsThrownByTheMaster) {
  ScriptWorld world(4);
  use_common_costs(world, 4, from_ms(1));
  world.host(0).throw_on_outcome = true;
  Yoon2021Settings settings = settings_for(true, true);
  settings.parallel_sessions = 3;
  Yoon2021 algorithm(settings);
  EXPECT_THROW(world.run(algorithm), std::runtime_error);
}

TEST(Yoon2021, NoSlavesNoSessions) {
  ScriptWorld world(1);
  Yoon2021 algorithm(settings_for(true, true));
  world.run(algorithm);
  EXPECT_EQ(world.unfinished(), 0U);
  EXPECT_TRUE(world.host(0).outcomes.empty());
}

// A stream, 0.15 ms long, on which 30 % of the messages (and those behind them) are late by up to
// 10 ms: the world "spiky LAN" of calibration.md section 4.
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

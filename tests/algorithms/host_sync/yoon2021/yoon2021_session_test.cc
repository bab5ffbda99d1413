// How the sessions of Algorithms 1 and 2 end: limits, losses, absent slaves, order and groups.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "algorithms/host_sync/messages.h"
#include "algorithms/host_sync/yoon2021/yoon2021.h"
#include "tests/algorithms/host_sync/script_host.h"
#include "tests/algorithms/host_sync/yoon2021/yoon2021_rig.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Yoon2021Session, AThresholdBelowTheRoundTripEndsAtThePassLimit) {
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

TEST(Yoon2021Session, ALagBeyondTheThresholdIsNamedAsSuch) {
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

TEST(Yoon2021Session, AHostWithoutAProcessIsGivenUpAndTheOthersAreServed) {
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

TEST(Yoon2021Session, ASlaveWhoseTurnNeverComesEnds) {
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
TEST(Yoon2021Session, AnyLostMessageCostsAtMostAPass) {
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

TEST(Yoon2021Session, EveryMessageTwiceChangesNothingForTheIntendedEstimate) {
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

TEST(Yoon2021Session, ForeignBytesAreIgnored) {
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

TEST(Yoon2021Session, SlavesAreServedInTurnWithAGapBetween) {
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

TEST(Yoon2021Session, ParallelSessionsServeEverySlaveOnceAndSooner) {
  for (const std::uint32_t groups : {2U, 5U, 64U}) {
    ScriptWorld world(6);
    use_common_costs(world, 6, from_ms(1));
    Yoon2021Settings settings = settings_for(true, true);
    settings.parallel_sessions = groups;
    Yoon2021 algorithm(settings);
    world.run(algorithm);
    EXPECT_EQ(world.unfinished(), 0U);
    std::vector<PeerId> served;
    for (const SyncOutcome& outcome : nonempty(world.host(0).outcomes)) {
      EXPECT_TRUE(outcome.synchronised);
      served.push_back(outcome.slave);
    }
    std::sort(served.begin(), served.end());
    EXPECT_THAT(served, ElementsAre(1, 2, 3, 4, 5));
    EXPECT_LT(world.host(0).outcome_times.back(), from_ms(groups == 2 ? 3300 : 500));
  }
}

TEST(Yoon2021Session, AFaultInOneParallelSessionIsThrownByTheMaster) {
  ScriptWorld world(4);
  use_common_costs(world, 4, from_ms(1));
  world.host(0).throw_on_outcome = true;
  Yoon2021Settings settings = settings_for(true, true);
  settings.parallel_sessions = 3;
  Yoon2021 algorithm(settings);
  EXPECT_THROW(world.run(algorithm), std::runtime_error);
}

TEST(Yoon2021Session, NoSlavesNoSessions) {
  ScriptWorld world(1);
  Yoon2021 algorithm(settings_for(true, true));
  world.run(algorithm);
  EXPECT_EQ(world.unfinished(), 0U);
  EXPECT_TRUE(world.host(0).outcomes.empty());
}

}  // namespace
}  // namespace simbench

#include "algorithms/host_sync/two_way/two_way.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <memory>

#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "tests/algorithms/host_sync/closed_loop.h"

namespace simbench {
namespace {

constexpr Nanoseconds kTwoWayLatency{150'000};

// The scripted clock slews at once, which no real one does: always step.
TwoWaySettings settings_of_test() {
  TwoWaySettings settings;
  settings.steering.step_threshold = Nanoseconds(0);
  return settings;
}

TwoWay hull_sync(TwoWaySettings settings) {
  return TwoWay(settings, [] { return std::make_unique<TwoWayHull>(TwoWayHull::Settings{}); });
}

void connect(ScriptWorld& world) {
  world.connect(kTwoWayLatency);
  for (const PeerId slave : world.slaves()) {
    world.host(slave).offset = from_ms(300.0 * slave);
    world.host(slave).uniform = 0.5;
  }
}

TEST(TwoWayTest, SetsEverySlaveToTheMastersClock) {
  ScriptWorld world(4);
  connect(world);
  world.host(0).offset = from_ms(-77);
  TwoWay sync = hull_sync(settings_of_test());
  EXPECT_EQ(sync.warm_up(), from_ms(60e3));
  world.run(sync, from_ms(20e3));
  EXPECT_EQ(world.unfinished(), 4u);
  expect_locked(world, {.error_us = 1.5e-3});
  for (const PeerId slave : nonempty(world.slaves())) {
    EXPECT_EQ(world.host(slave).outcomes[0].slave, slave);
    EXPECT_EQ(world.host(slave).outcomes[0].message, "");
  }
}

TEST(TwoWayTest, TheFourStampsOfAnExchangeAreReported) {
  ScriptWorld world(2);
  connect(world);
  world.host(0).offset = from_ms(1000);
  TwoWay sync = hull_sync(settings_of_test());
  world.run(sync, from_ms(100));
  ASSERT_FALSE(world.host(1).exchanges.empty());
  const Exchange& exchange = world.host(1).exchanges.front();
  EXPECT_EQ(exchange.peer, 0u);
  EXPECT_EQ(*exchange.t4 - *exchange.t1, 2 * kTwoWayLatency);
  EXPECT_EQ(*exchange.t2 - *exchange.t1, kTwoWayLatency + from_ms(700));
  EXPECT_EQ(*exchange.t3, *exchange.t2);
}

TEST(TwoWayTest, SenderOccupancyIsInTheNaivePathOnly) {
  for (const bool is_naive : {false, true}) {
    ScriptWorld world(2);
    connect(world);
    world.host(1).costs.send = from_ms(3);  // the master's is 0
    TwoWaySettings settings = settings_of_test();
    settings.is_naive = is_naive;
    TwoWay sync = hull_sync(settings);
    world.run(sync, from_ms(20e3));
    const Nanoseconds expected = is_naive ? from_ms(1.5) : Nanoseconds(0);
    EXPECT_LE(std::abs((world.host(1).lead_over(world.host(0)) - expected).count()), 2);
  }
}

TEST(TwoWayTest, AsymmetryIsInTheResultWithItsHalf) {
  ScriptWorld world(2);
  connect(world);
  world.set_latency(1, 0, kTwoWayLatency + from_ms(0.04));
  TwoWay sync = hull_sync(settings_of_test());
  world.run(sync, from_ms(20e3));
  EXPECT_LE(std::abs((world.host(1).lead_over(world.host(0)) - from_ms(0.02)).count()), 2);
}

TEST(TwoWayTest, LossDuplicatesAndLateMessagesCostExchangesOnly) {
  boost::random::mt19937_64 engine(9);
  const LinkScript unreliable = [&engine](std::size_t, const Bytes&) {
    switch (engine() % 4) {
      case 0:
        return std::vector<Nanoseconds>{};
      case 1:
        return std::vector<Nanoseconds>{kTwoWayLatency, kTwoWayLatency + from_ms(0.1)};
      case 2:
        return std::vector<Nanoseconds>{kTwoWayLatency, kTwoWayLatency + from_ms(900)};
      default:
        return std::vector<Nanoseconds>{kTwoWayLatency};
    }
  };
  ScriptWorld world(2);
  connect(world);
  world.script_link(0, 1, unreliable);
  world.script_link(1, 0, unreliable);
  TwoWay sync = hull_sync(settings_of_test());
  world.run(sync, from_ms(60e3));
  EXPECT_LE(std::abs(world.host(1).lead_over(world.host(0)).count()), 2) << "seed 9";
  EXPECT_EQ(world.host(1).outcomes.size(), 1u);
}

TEST(TwoWayTest, TheDepartureOfALostReplysPredecessorComesWithTheNextOne) {
  ScriptWorld world(2);
  connect(world);
  world.script_link(0, 1, [](std::size_t index, const Bytes&) {
    return index % 2 == 1 ? std::vector<Nanoseconds>{} : std::vector{kTwoWayLatency};
  });
  TwoWay sync = hull_sync(settings_of_test());
  world.run(sync, from_ms(20e3));
  // Half a second for each lost reply: a complete exchange each 0.52 s, less the last one.
  EXPECT_GE(world.host(1).exchanges.size(), 25u);
  EXPECT_LE(std::abs(world.host(1).lead_over(world.host(0)).count()), 2);
}

TEST(TwoWayTest, RandomBytesFromThePeerAreIgnored) {
  boost::random::mt19937_64 engine(4);
  ScriptWorld world(2);
  connect(world);
  TwoWay sync = hull_sync(settings_of_test());
  for (int i = 0; i < 500; ++i) {
    Bytes bytes(engine() % 40);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(engine());
    if (bytes.size() >= 4 && i % 2 == 0) {
      bytes[0] = std::byte{0x54};
      bytes[1] = std::byte{0x57};
      bytes[2] = std::byte{1};
    }
    world.call_at(from_ms(20.0 * i), [&world, bytes] { world.host(1).deliver(0, bytes); });
    world.call_at(from_ms(20.0 * i + 7), [&world, bytes] { world.host(0).deliver(1, bytes); });
  }
  world.run(sync, from_ms(20e3));
  EXPECT_LE(std::abs(world.host(1).lead_over(world.host(0)).count()), 2) << "seed 4";
}

TEST(TwoWayTest, ASilentMasterIsOneOutcomeAndIsAskedOn) {
  ScriptWorld world(3);
  connect(world);
  std::size_t asked = 0;
  world.script_link(2, 0, [&asked](std::size_t, const Bytes&) {
    ++asked;
    return std::vector<Nanoseconds>{};
  });
  TwoWay sync = hull_sync(settings_of_test());
  world.run(sync, from_ms(60e3));
  expect_refused(world, 2, "no reply from host 0");
  EXPECT_GT(asked, TwoWay::kPatience);
  EXPECT_TRUE(world.host(1).outcomes.at(0).synchronised);
  EXPECT_TRUE(world.host(2).steps.empty());
}

TEST(TwoWayTest, EarlyStopMakesOneExchangeARound) {
  ScriptWorld world(2);
  connect(world);
  TwoWaySettings settings = settings_of_test();
  settings.is_naive = true;
  settings.exchanges = 0;
  settings.round_pause = from_ms(10e3);
  TwoWayMinimum::Settings minimum;
  minimum.exchanges = 300;
  minimum.early_stop = from_ms(1);
  minimum.estimate_rate = false;
  TwoWay sync(settings, [minimum] { return std::make_unique<TwoWayMinimum>(minimum); });
  world.run(sync, from_ms(25e3));
  EXPECT_EQ(world.host(1).exchanges.size(), 3u);
  EXPECT_EQ(world.host(1).lead_over(world.host(0)), Nanoseconds(0));
}

}  // namespace
}  // namespace simbench

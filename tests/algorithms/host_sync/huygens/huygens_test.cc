#include "algorithms/host_sync/huygens/huygens.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <vector>

#include "tests/algorithms/host_sync/closed_loop.h"
#include "tests/algorithms/host_sync/unreliable_link.h"

namespace simbench {
namespace {

constexpr PeerId kHosts = 4;
constexpr Nanoseconds kHuygensLatency{100'000};

class HuygensTest : public testing::Test {
 protected:
  HuygensTest() {
    for (PeerId a = 0; a < kHosts; ++a) {
      for (PeerId b = 0; b < kHosts; ++b) {
        if (a != b) world_.set_latency(a, b, kHuygensLatency);
      }
      world_.host(a).stamps_departures = true;
      world_.host(a).uniform = 0.1 + 0.2 * a;
      world_.host(a).offset = from_ms(-70.0 * a);
    }
    // The scripted clock slews at once, which no real one does: always step.
    settings_.steering.step_threshold = Nanoseconds(0);
  }
  void run(Nanoseconds end = from_ms(30e3)) {
    Huygens sync(settings_);
    world_.run(sync, end);
  }
  double lead(PeerId slave) { return lead_us(world_, slave); }

  ScriptWorld world_{kHosts};
  HuygensSettings settings_;
};

TEST_F(HuygensTest, StepsTheSlavesToTheMaster) {
  run();
  EXPECT_EQ(Huygens(settings_).warm_up(), from_ms(60e3));
  EXPECT_EQ(world_.unfinished(), kHosts);
  expect_locked(world_);
}

TEST_F(HuygensTest, AnAsymmetryOfOneLinkIsSharedOut) {
  // Wrong by 60 us on its pair, alone; of four hosts 2/4 of that remain, and 1/4 for the others.
  world_.set_latency(1, 0, kHuygensLatency + from_us(120));
  run();
  EXPECT_NEAR(lead(1), 30, 0.01);
  EXPECT_NEAR(lead(2), 15, 0.01);
  EXPECT_NEAR(lead(3), 15, 0.01);
}

TEST_F(HuygensTest, AnAsymmetryOfAPortStays) {
  for (PeerId other = 0; other < kHosts; ++other) {
    if (other != 1) world_.set_latency(1, other, kHuygensLatency + from_us(120));
  }
  run();
  EXPECT_NEAR(lead(1), 60, 0.01);
  EXPECT_NEAR(lead(2), 0, 0.01);
  EXPECT_NEAR(lead(3), 0, 0.01);
}

TEST_F(HuygensTest, ImpureProbesDoNotCount) {
  // In two pairs of three one probe is late: by less than the other's delay, so a minimum would
  // not notice; all the others from the master are late by 0.3 ms and impure by 20 us.
  world_.script_link(0, 1, [](std::size_t index, const Bytes&) {
    const bool is_pure = index % 6 < 2;
    const Nanoseconds late = index % 2 == 0 ? Nanoseconds(0) : from_us(20);
    return std::vector{kHuygensLatency + (is_pure ? Nanoseconds(0) : late)};
  });
  run();
  EXPECT_NEAR(lead(1), 0, 0.01);
}

TEST_F(HuygensTest, LossDuplicatesReorderingAndGarbageCostProbesOnly) {
  boost::random::mt19937_64 engine(17);
  const LinkScript unreliable =
      unreliable_link(engine, kHuygensLatency,
                      {.twice_after = from_us(300), .late = {kHuygensLatency + from_ms(70)}});
  for (PeerId slave = 1; slave < kHosts; ++slave) {
    world_.script_link(0, slave, unreliable);
    world_.script_link(slave, 0, unreliable);
  }
  for (int i = 0; i < 1'000; ++i) {
    Bytes bytes = random_bytes(engine, 60);
    if (bytes.size() > 4) {
      bytes[0] = std::byte{0x48};
      bytes[1] = std::byte{0x59};
      bytes[2] = std::byte{1};
    }
    world_.call_at(from_ms(50.0 * i), [this, bytes] { world_.host(1).deliver(0, bytes); });
    world_.call_at(from_ms(50.0 * i + 9), [this, bytes] { world_.host(0).deliver(1, bytes); });
  }
  run(from_ms(60e3));
  SCOPED_TRACE("seed 17");
  expect_aligned(world_, {.error_us = 0.5});
}

TEST_F(HuygensTest, AJumpOfTheMastersClockIsFollowed) {
  world_.call_at(from_ms(30e3), [this] { world_.host(0).offset += from_ms(40); });
  run(from_ms(70e3));
  expect_aligned(world_);
}

TEST_F(HuygensTest, WithoutTheMasterEachSlaveReportsIt) {
  for (PeerId slave = 1; slave < kHosts; ++slave) cut(world_, 0, slave);
  run(from_ms(60e3));
  for (const PeerId slave : nonempty(world_.slaves())) {
    expect_refused(world_, slave, "no line from host 0");
    EXPECT_TRUE(world_.host(slave).steps.empty());
  }
}

// Each probe leaves in the instant of its call, where the reading of the system clock is wrong by
// as much as it is coarse: no departure is outside of its call, and none is lost for that.
TEST_F(HuygensTest, CallsThatTakeNoTimeLoseNoDeparture) {
  for (PeerId host = 0; host < kHosts; ++host) world_.host(host).granularity = Nanoseconds(1'000);
  run();
  expect_aligned(world_, {.error_us = 1});
  for (const PeerId slave : nonempty(world_.slaves())) {
    EXPECT_TRUE(world_.host(slave).outcomes.at(0).synchronised);
  }
}

TEST_F(HuygensTest, WhereNoPairIsPureTheOutcomeSaysSo) {
  for (PeerId a = 0; a < kHosts; ++a) {
    for (PeerId b = 0; b < kHosts; ++b) {
      if (a == b) continue;
      world_.script_link(a, b, [](std::size_t index, const Bytes&) {
        return std::vector{kHuygensLatency + from_us(20.0 * static_cast<double>(index % 7))};
      });
    }
  }
  run(from_ms(60e3));
  for (const PeerId slave : nonempty(world_.slaves())) {
    expect_refused(world_, slave, "no line from host 0: 0 of ");
    expect_refused(world_, slave, "Take the load off the network, use the cards' stamps");
  }
}

TEST_F(HuygensTest, StampsThatTheHostDoesNotTakeAreAnOutcomeThatNamesThem) {
  settings_.stamps = StampSource::kCard;
  run(from_ms(60e3));
  for (const PeerId slave : nonempty(world_.slaves())) {
    expect_refused(world_, slave, "Host::hardware_clock");
    EXPECT_TRUE(world_.host(slave).steps.empty());
  }
}

TEST_F(HuygensTest, KernelStampsThatDoNotComeAreTheSame) {
  for (PeerId host = 0; host < kHosts; ++host) world_.host(host).stamps_departures = false;
  run(from_ms(60e3));
  for (const PeerId slave : nonempty(world_.slaves())) {
    expect_refused(world_, slave, "MessageChannel::transmit_stamp");
  }
}

TEST(HuygensAloneTest, AMasterWithoutSlavesHasNothingToDo) {
  ScriptWorld world(1);
  Huygens sync({});
  world.run(sync, from_ms(60e3));
  EXPECT_TRUE(world.host(0).outcomes.empty());
}

}  // namespace
}  // namespace simbench

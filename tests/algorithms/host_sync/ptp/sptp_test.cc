#include "algorithms/host_sync/ptp/sptp.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "algorithms/host_sync/ptp/ptp_message.h"
#include "tests/algorithms/host_sync/script_host.h"
#include "tests/algorithms/host_sync/unreliable_link.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

constexpr Nanoseconds kSptpLatency{150'000};

SptpExchange exchange_of(std::int64_t offset_ns, std::int64_t from_server_ns,
                         std::int64_t to_server_ns) {
  return {.t1 = 1'000'000,
          .t2 = 1'000'000 + from_server_ns + offset_ns,
          .t3 = 500'000 + offset_ns,
          .t4 = 500'000 + to_server_ns};
}

TEST(SptpPathDelayTest, TheOffsetIsTheWayFromTheServerLessTheMedian) {
  SptpPathDelay delay({.length = 3});
  EXPECT_EQ(delay.offset(exchange_of(700, 300, 300)), Nanoseconds(700));
  EXPECT_EQ(delay.offset(exchange_of(700, 300, 340)), Nanoseconds(690));
  // 300, 320 and 900: the median is 320.
  EXPECT_EQ(delay.offset(exchange_of(700, 300, 1500)), Nanoseconds(680));
}

TEST(SptpPathDelayTest, CorrectionsAreTakenOut) {
  SptpPathDelay delay({});
  SptpExchange exchange = exchange_of(700, 5'300, 2'300);
  exchange.sync_correction = Nanoseconds(5'000);
  exchange.request_correction = Nanoseconds(2'000);
  EXPECT_EQ(delay.offset(exchange), Nanoseconds(700));
}

TEST(SptpPathDelayTest, DelaysOutsideTheRangeAreDiscarded) {
  SptpPathDelay delay({.length = 2,
                       .discard_below = Nanoseconds(2'000),
                       .discard_from = Nanoseconds(20'000),
                       .multiplier = 3});
  // The first one counts in any case, long ones until the window is full.
  EXPECT_EQ(delay.offset(exchange_of(0, 1'000, 1'000)), Nanoseconds(0));
  EXPECT_EQ(delay.offset(exchange_of(0, 1'000, 200)), Nanoseconds(0)) << "too short: 1000 stays";
  EXPECT_EQ(delay.offset(exchange_of(0, 11'000, 11'000)), Nanoseconds(5'000)) << "median 6000";
  EXPECT_EQ(delay.offset(exchange_of(0, 21'000, 21'000)), Nanoseconds(15'000)) << "above 3 times";
  EXPECT_EQ(delay.offset(exchange_of(0, 17'000, 17'000)), Nanoseconds(3'000)) << "median 14000";
}

// One exchange a second with a clock that runs `drift_ppb` fast.
struct SptpLoop {
  double drift_ppb = 0;
  double offset_ns = 0;
  double correction_ppb = 0;
  std::int64_t second = 0;
  int steps = 0;

  SptpServo::Answer turn(SptpServo& servo, double noise_ns = 0) {
    offset_ns += drift_ppb - correction_ppb;
    ++second;
    const SptpServo::Answer answer =
        servo.sample(offset_ns + noise_ns, second * 1'000'000'000,
                     SteadyTime(from_ms(1e3 * static_cast<double>(second))));
    if (answer.action == SptpServo::Action::kSetFrequency) correction_ppb = answer.ppb;
    if (answer.action == SptpServo::Action::kStep) {
      ++steps;
      offset_ns = 0;
    }
    return answer;
  }
};

TEST(SptpServoTest, StepsOnceWithoutTheFrequencyThenConverges) {
  SptpServo servo({.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000});
  SptpLoop loop{.drift_ppb = 37'000, .offset_ns = 5e8};
  EXPECT_EQ(loop.turn(servo).action, SptpServo::Action::kNone);
  EXPECT_EQ(loop.turn(servo).action, SptpServo::Action::kStep);
  EXPECT_EQ(loop.correction_ppb, 0);
  // kp = 0.7, ki = 0.3 of the offset of one second, on the frequency found.
  EXPECT_NEAR(loop.turn(servo).ppb, 37'000 + 37'000 * 1.0, 20);
  for (int i = 0; i < 100; ++i) loop.turn(servo);
  EXPECT_EQ(loop.steps, 1);
  EXPECT_NEAR(loop.correction_ppb, 37'000, 1e-3);
  EXPECT_NEAR(loop.offset_ns, 0, 1e-3);
}

TEST(SptpServoTest, ASpikeLeavesTheClockAtItsMeanFrequency) {
  SptpServo servo({.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000});
  SptpLoop loop{.drift_ppb = 2'000};
  for (int i = 0; i < 200; ++i) loop.turn(servo);
  EXPECT_TRUE(loop.turn(servo, 14'900).is_locked) << "below 15 us nothing is a spike";
  for (int i = 0; i < 60; ++i) loop.turn(servo);
  const SptpServo::Answer answer = loop.turn(servo, 15'200);
  EXPECT_EQ(answer.action, SptpServo::Action::kSetFrequency);
  EXPECT_FALSE(answer.is_locked);
  EXPECT_NEAR(answer.ppb, 2'000, 1);
  EXPECT_EQ(servo.hold().ppb, answer.ppb);
}

TEST(SptpServoTest, AfterFifteenSpikesItBeginsAnew) {
  SptpServo servo({.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000});
  SptpLoop loop;
  for (int i = 0; i < 100; ++i) loop.turn(servo);
  loop.offset_ns += 1e6;
  for (int i = 0; i < 16; ++i) EXPECT_FALSE(loop.turn(servo).is_locked) << i;
  EXPECT_EQ(loop.turn(servo).action, SptpServo::Action::kNone) << "the first sample anew";
  for (int i = 0; i < 100; ++i) loop.turn(servo);
  EXPECT_NEAR(loop.offset_ns, 0, 100);
}

TEST(SptpServoTest, WithoutAStableOffsetTheMeanFrequencyIsZero) {
  SptpServo servo({.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000});
  SptpLoop loop{.drift_ppb = 2'000};
  // Noise of software stamps: never within 100 ns.
  for (int i = 0; i < 200; ++i) loop.turn(servo, i % 2 == 0 ? 5'000 : -5'000);
  EXPECT_EQ(servo.hold().ppb, 0);
}

class SptpTest : public testing::Test {
 protected:
  SptpTest() {
    world_.connect(kSptpLatency);
    for (const PeerId slave : world_.slaves()) {
      world_.host(slave).offset = from_ms(-400.0 * slave);
      world_.host(slave).uniform = 0.4;
    }
    for (PeerId host = 0; host < 3; ++host) world_.host(host).stamps_departures = true;
  }
  double lead_us(PeerId slave) { return to_ms(world_.host(slave).lead_over(world_.host(0))) * 1e3; }

  ScriptWorld world_{3};
  SptpSettings settings_{
      .servo_limits = {.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000}};
};

TEST_F(SptpTest, StepsTheSlavesToTheMaster) {
  std::size_t messages = 0;
  world_.script_link(0, 1, [&messages](std::size_t, const Bytes&) {
    ++messages;
    return std::vector{kSptpLatency};
  });
  Sptp sync(settings_);
  EXPECT_EQ(sync.warm_up(), from_ms(60e3));
  world_.run(sync, from_ms(60e3));
  EXPECT_EQ(world_.unfinished(), 3u);
  for (const PeerId slave : nonempty(world_.slaves())) {
    EXPECT_NEAR(lead_us(slave), 0, 0.01);
    ASSERT_EQ(world_.host(slave).outcomes.size(), 1u);
    EXPECT_TRUE(world_.host(slave).outcomes[0].synchronised)
        << world_.host(slave).outcomes[0].message;
    const Exchange& exchange = world_.host(slave).exchanges.front();
    EXPECT_EQ((*exchange.t2 - *exchange.t1) + (*exchange.t4 - *exchange.t3), 2 * kSptpLatency);
  }
  EXPECT_EQ(messages, 2u * 60) << "a Sync and an Announce for each second";
}

TEST_F(SptpTest, AsymmetryIsInTheResultWithItsHalf) {
  world_.set_latency(1, 0, kSptpLatency + from_ms(0.1));
  Sptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  EXPECT_NEAR(lead_us(1), 50, 0.01);
}

TEST_F(SptpTest, CorrectionsOfTransparentClocksAreTakenOut) {
  ScriptWorld& world = world_;
  const auto corrected = [&world](PeerId from, PeerId to, Nanoseconds residence) {
    return [&world, from, to, residence](std::size_t, const Bytes& bytes) {
      const auto message = decode_ptp_message(bytes);
      if (!message || static_cast<int>(message->type) > 3) return std::vector{kSptpLatency};
      PtpMessage changed = *message;
      changed.correction += residence.count() * 65'536;
      world.call_at(world.now() + kSptpLatency + residence,
                    [&world, from, to, changed] { world.host(to).deliver(from, encode(changed)); });
      return std::vector<Nanoseconds>{};
    };
  };
  world_.script_link(0, 1, corrected(0, 1, from_ms(0.7)));
  world_.script_link(1, 0, corrected(1, 0, from_ms(0.1)));
  Sptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  EXPECT_NEAR(lead_us(1), 0, 0.01);
}

TEST_F(SptpTest, LossDuplicatesReorderingAndGarbageCostMeasurementsOnly) {
  boost::random::mt19937_64 engine(17);
  const LinkScript unreliable = unreliable_link(
      engine, kSptpLatency, {.twice_after = from_ms(0.3), .late = {kSptpLatency + from_ms(2500)}});
  world_.script_link(0, 1, unreliable);
  world_.script_link(1, 0, unreliable);
  for (int i = 0; i < 1000; ++i) {
    const Bytes bytes = random_bytes(engine, 70);
    world_.call_at(from_ms(60.0 * i), [this, bytes] { world_.host(1).deliver(0, bytes); });
    world_.call_at(from_ms(60.0 * i + 9), [this, bytes] { world_.host(0).deliver(1, bytes); });
  }
  Sptp sync(settings_);
  world_.run(sync, from_ms(240e3));
  EXPECT_NEAR(lead_us(1), 0, 0.5) << "seed 17";
  EXPECT_NEAR(lead_us(2), 0, 0.01);
}

TEST_F(SptpTest, ASilentMasterIsOneOutcome) {
  world_.script_link(0, 2, [](std::size_t, const Bytes&) { return std::vector<Nanoseconds>{}; });
  Sptp sync(settings_);
  world_.run(sync, from_ms(60e3));
  ASSERT_EQ(world_.host(2).outcomes.size(), 1u);
  EXPECT_NE(world_.host(2).outcomes[0].message.find("has not locked"), std::string::npos);
  EXPECT_TRUE(world_.host(1).outcomes.at(0).synchronised);
}

TEST(SptpStampsTest, StampsThatTheHostDoesNotTakeAreAnOutcomeThatNamesThem) {
  for (const auto& [source, what] : {std::pair{StampSource::kCard, "Host::hardware_clock"},
                                     {StampSource::kKernel, "MessageChannel::transmit_stamp"}}) {
    ScriptWorld world(2);
    world.connect(kSptpLatency);
    Sptp sync({.stamps = source});
    world.run(sync, from_ms(60e3));
    ASSERT_EQ(world.host(1).outcomes.size(), 1u) << what;
    EXPECT_NE(world.host(1).outcomes[0].message.find(what), std::string::npos)
        << world.host(1).outcomes[0].message;
    EXPECT_TRUE(world.host(1).steps.empty());
  }
}

}  // namespace
}  // namespace simbench

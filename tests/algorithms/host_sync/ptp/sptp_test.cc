#include "algorithms/host_sync/ptp/sptp.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/algorithms/host_sync/closed_loop.h"

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

TEST(SptpTest, TheMasterSendsTwoMessagesASecond) {
  ScriptWorld world(2);
  world.connect(kSptpLatency);
  world.host(0).stamps_departures = world.host(1).stamps_departures = true;
  world.host(1).offset = from_ms(-400);
  world.host(1).uniform = 0.4;
  std::size_t messages = 0;
  world.script_link(0, 1, [&messages](std::size_t, const Bytes&) {
    ++messages;
    return std::vector{kSptpLatency};
  });
  Sptp sync({.servo_limits = {.max_frequency_ppb = 5e5, .first_step_threshold_ns = 20'000}});
  world.run(sync, from_ms(60e3));
  expect_locked(world);
  EXPECT_EQ(messages, 2u * 60) << "a Sync and an Announce for each second";
}

}  // namespace
}  // namespace simbench

#include "algorithms/host_sync/ptp/ptp_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "algorithms/host_sync/ptp/ptp_port.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

class PtpVectorTest : public testing::Test {
 protected:
  void expect_agreement(Servo& servo, const char* key) {
    const nlohmann::json& rows = vectors_.at(key);
    ASSERT_EQ(rows.size(), 120u);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& row = rows[i];
      const ServoAnswer answer = servo.sample(row[0].get<double>(), row[1].get<std::int64_t>(), 1);
      EXPECT_EQ(static_cast<int>(answer.state), row[3].get<int>()) << key << " row " << i;
      const double expected = row[2].get<double>();
      // The vectors are printed with 12 digits, the last of a slope near 1 in 10 digits of ppb.
      EXPECT_NEAR(answer.ppb, expected, std::max(1e-9 * std::abs(expected), 1e-6))
          << key << " row " << i;
    }
  }

  const nlohmann::json vectors_ = test_data_json("vectors/linuxptp_golden.json");
};

TEST_F(PtpVectorTest, PiServoWithHardwareStamps) {
  PiServo servo(PiServo::kHardwareStamps, {});
  expect_agreement(servo, "pi_hw_ts");
}

TEST_F(PtpVectorTest, PiServoWithSoftwareStamps) {
  PiServo servo(PiServo::kSoftwareStamps, {});
  expect_agreement(servo, "pi_sw_ts");
}

TEST_F(PtpVectorTest, LinearRegressionServo) {
  LinearRegressionServo servo({});
  expect_agreement(servo, "linreg");
}

TEST_F(PtpVectorTest, MovingMedian) {
  MovingMedian median(10);
  for (const auto& row : vectors_.at("mmedian_len10")) {
    EXPECT_EQ(median.add(Nanoseconds(row[0].get<std::int64_t>())).count(),
              row[1].get<std::int64_t>());
  }
}

// A clock that the servo steers: runs `drift_ppb` fast of the reference.
struct Loop {
  double drift_ppb = 0;
  double offset_ns = 0;
  double correction_ppb = 0;
  std::int64_t local_ns = 0;
  int jumps = 0;

  ServoAnswer turn(Servo& servo, double noise_ns = 0) {
    const double rate_ppb = drift_ppb - correction_ppb;
    offset_ns += rate_ppb;
    local_ns += 1'000'000'000 + std::llround(rate_ppb);
    const ServoAnswer answer = servo.sample(std::round(offset_ns + noise_ns), local_ns, 1);
    if (answer.state != ServoState::kUnlocked) correction_ppb = answer.ppb;
    if (answer.state == ServoState::kJump) {
      ++jumps;
      local_ns -= std::llround(offset_ns);
      offset_ns = 0;
    }
    return answer;
  }
};

class ServoTest : public testing::TestWithParam<int> {
 protected:
  static std::unique_ptr<Servo> make(ServoSettings settings = {}) {
    if (GetParam() == 0) return std::make_unique<PiServo>(PiServo::kHardwareStamps, settings);
    if (GetParam() == 1) return std::make_unique<PiServo>(PiServo::kSoftwareStamps, settings);
    return std::make_unique<LinearRegressionServo>(settings);
  }
};

TEST_P(ServoTest, ConvergesOnADriftingClockAfterOneJump) {
  const auto servo = make();
  Loop loop{.drift_ppb = 37'000, .offset_ns = 5e8};
  for (int i = 0; i < 300; ++i) loop.turn(*servo);
  EXPECT_EQ(loop.jumps, 1);
  EXPECT_NEAR(loop.correction_ppb, 37'000, 5);
  EXPECT_NEAR(loop.offset_ns, 0, 60);
}

TEST_P(ServoTest, NeverAsksForMoreThanTheLargestFrequency) {
  const auto servo = make({.max_frequency_ppb = 10'000});
  Loop loop{.drift_ppb = 37'000};
  for (int i = 0; i < 200; ++i) EXPECT_LE(std::abs(loop.turn(*servo).ppb), 10'000);
  EXPECT_NEAR(loop.correction_ppb, 10'000, 1e-9);
}

TEST_P(ServoTest, WithoutAStepThresholdALaterJumpOfTheReferenceIsNotStepped) {
  const auto servo = make();
  Loop loop;
  for (int i = 0; i < 100; ++i) loop.turn(*servo);
  loop.offset_ns += 1e6;
  for (int i = 0; i < 20; ++i) {
    EXPECT_NE(loop.turn(*servo).state, ServoState::kJump);
  }
}

TEST_P(ServoTest, WithAStepThresholdItIs) {
  const auto servo = make({.step_threshold_ns = 100'000});
  Loop loop;
  for (int i = 0; i < 100; ++i) loop.turn(*servo);
  loop.offset_ns += 1e7;
  for (int i = 0; i < 200; ++i) loop.turn(*servo);
  EXPECT_GE(loop.jumps, 1);
  EXPECT_LT(std::abs(loop.offset_ns), 1e5);
}

TEST_P(ServoTest, AClockThatStandsStillGivesNothingAndNoNaN) {
  const auto servo = make();
  for (int i = 0; i < 20; ++i) {
    const ServoAnswer answer = servo->sample(100, 5'000'000'000, 1);
    EXPECT_TRUE(std::isfinite(answer.ppb));
    EXPECT_EQ(answer.state, ServoState::kUnlocked);
  }
}

INSTANTIATE_TEST_SUITE_P(PiHardwarePiSoftwareRegression, ServoTest, testing::Values(0, 1, 2));

TEST(PiServoTest, TheSecondSampleGivesTheFrequency) {
  PiServo servo(PiServo::kHardwareStamps, {});
  EXPECT_EQ(servo.sample(1000, 1'000'000'000, 1).state, ServoState::kUnlocked);
  const ServoAnswer answer = servo.sample(3000, 2'000'000'000, 1);
  EXPECT_EQ(answer.state, ServoState::kLocked);
  EXPECT_NEAR(answer.ppb, 2000, 1e-9);
  // kp = 0.7, ki = 0.3: drift 2000 + 1.0 * 500.
  EXPECT_NEAR(servo.sample(500, 3'000'000'000, 1).ppb, 2500, 1e-9);
  EXPECT_NEAR(servo.sample(0, 4'000'000'000, 1).ppb, 2150, 1e-9);
  EXPECT_NEAR(servo.sample(500, 5'000'000'000, 0.5).ppb, 2400, 1e-9);
}

TEST(PiServoTest, TheGainsFollowTheInterval) {
  PiServo servo(PiServo::kSoftwareStamps, {.interval_s = 4});
  servo.sample(0, 0, 1);
  servo.sample(0, 100'000'000'000, 1);
  const double kp = 0.1 * std::pow(4, -0.3);
  const double ki = 0.001 * std::pow(4, 0.4);
  EXPECT_NEAR(servo.sample(1000, 104'000'000'000, 1).ppb, (kp + ki) * 1000, 1e-9);
}

TEST(PiServoTest, FasterMessagesHaveAHigherGainASecondAndALowerOneAMessage) {
  // linuxptp at 16 a second: kp = 0.7 16^0.3, ki = 0.3 16^-0.4; the limits are far away.
  PiServo servo(PiServo::kHardwareStamps, {.interval_s = 1.0 / 16});
  servo.sample(0, 0, 1);
  servo.sample(0, 1'000'000'000, 1);
  const double kp = 0.7 * std::pow(16, 0.3);
  const double ki = 0.3 * std::pow(16, -0.4);
  EXPECT_NEAR(servo.sample(1000, 1'062'500'000, 1).ppb, (kp + ki) * 1000, 1e-9);
  EXPECT_NEAR(servo.first_frequency_s(), 0.016 / ki, 1e-12);
}

TEST(PiServoTest, ASampleAThousandthEarlyGivesTheFrequency) {
  PiServo servo(PiServo::kSoftwareStamps, {});
  servo.sample(0, 1, 1);
  EXPECT_EQ(servo.sample(0, 15'983'000'001, 1).state, ServoState::kUnlocked);
  EXPECT_EQ(servo.sample(0, 15'985'000'001, 1).state, ServoState::kLocked);
}

TEST(LinearRegressionServoTest, ItsRateRatioIsWhatItLeavesOfTheSlope) {
  LinearRegressionServo servo({});
  Loop loop{.drift_ppb = 37'000};
  for (int i = 0; i < 100; ++i) loop.turn(servo);
  EXPECT_NEAR(servo.rate_ratio(), 1, 1e-9);
  loop.offset_ns += 20'000;
  const ServoAnswer answer = loop.turn(servo);
  // The clock is slowed below the reference, to lose its lead: the reference gains on it.
  EXPECT_GT(answer.ppb, 37'000);
  EXPECT_NEAR((servo.rate_ratio() - 1) * 1e9, answer.ppb - 37'000, 2'000);
  EXPECT_EQ(PiServo(PiServo::kHardwareStamps, {}).rate_ratio(), 1);
}

TEST(MovingMedianTest, OddIsTheMiddleEvenTheMeanOfTwoTowardsZero) {
  MovingMedian median(3);
  EXPECT_EQ(median.add(Nanoseconds(7)).count(), 7);
  EXPECT_EQ(median.add(Nanoseconds(2)).count(), 4);
  EXPECT_EQ(median.add(Nanoseconds(100)).count(), 7);
  EXPECT_EQ(median.add(Nanoseconds(-100)).count(), 2);
  median.clear();
  EXPECT_EQ(median.add(Nanoseconds(-5)).count(), -5);
  EXPECT_EQ(median.add(Nanoseconds(-2)).count(), -3);
}

}  // namespace
}  // namespace simbench

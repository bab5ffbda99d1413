#include "hardware/camera/played_steering.h"

#include <gmock/gmock.h>

#include <vector>

#include "tests/hardware/camera/steering_values.h"

namespace simbench::hardware {
namespace {

using testing::Each;
using testing::ElementsAre;

// Passes the frames of these counters; by how much each was later, in ms.
std::vector<double> shifts_of(PlayedSteering& steering, std::uint32_t first, std::uint32_t count) {
  std::vector<double> shifts_ms;
  for (std::uint32_t counter = first; counter != first + count; ++counter) {
    shifts_ms.push_back(to_ms(steering.shift(counter)));
    steering.pass(counter);
  }
  return shifts_ms;
}

TEST(PlayedSteering, WithoutControlsFramesStayWhereTheyAre) {
  PlayedSteering steering(steering_settings());
  EXPECT_THAT(shifts_of(steering, 100, 50), Each(0));
}

TEST(PlayedSteering, AnAdjustmentMovesAllFramesAfterTheLatencyByWholeGranules) {
  PlayedSteering steering(steering_settings(2));
  shifts_of(steering, 100, 3);
  EXPECT_EQ(steering.control(FrameControlKind::kAdjustFrame, from_us(1234)).length, from_us(5230));
  // Frame 104 is two after the one that was passed last: the next one is the first to come later.
  EXPECT_THAT(shifts_of(steering, 103, 5), ElementsAre(0, 0, 1.23, 1.23, 1.23));
  steering.control(FrameControlKind::kAdjustFrame, from_us(-1230));
  EXPECT_THAT(shifts_of(steering, 108, 4), ElementsAre(1.23, 1.23, 0, 0));
}

TEST(PlayedSteering, WithoutLatencyTheNextFrameStillStaysWhereItIs) {
  PlayedSteering steering(steering_settings(0));
  shifts_of(steering, 1, 1);
  steering.control(FrameControlKind::kAdjustFrame, from_ms(-1));
  EXPECT_THAT(shifts_of(steering, 2, 3), ElementsAre(0, -1, -1));
}

TEST(PlayedSteering, AFrameLengthAddsUp) {
  PlayedSteering steering(steering_settings(1));
  shifts_of(steering, 1, 1);
  steering.control(FrameControlKind::kFrameLength, from_ms(4.5));
  EXPECT_THAT(shifts_of(steering, 2, 4), ElementsAre(0, 0.5, 1, 1.5));
}

TEST(PlayedSteering, AMissingFrameHadItsLength) {
  PlayedSteering steering(steering_settings(1));
  shifts_of(steering, 1, 1);
  steering.control(FrameControlKind::kFrameLength, from_ms(4.5));
  steering.pass(3);
  EXPECT_EQ(steering.shift(6), from_ms(2));
  EXPECT_EQ(steering.shift(0), from_ms(1)) << "the counter has begun anew: the next frame";
}

TEST(PlayedSteering, AnInsertedFrameIsExposedForItsLengthLessAGranule) {
  FrameSteering settings = steering_settings(1);
  settings.insert_stretches = 2;
  PlayedSteering steering(settings);
  shifts_of(steering, 1, 1);
  steering.control(FrameControlKind::kInsertFrame, from_ms(6));
  EXPECT_EQ(steering.exposure(2), std::nullopt);
  EXPECT_THAT(shifts_of(steering, 2, 1), ElementsAre(0));
  EXPECT_EQ(steering.exposure(3), from_ms(6) - from_us(10));
  EXPECT_THAT(shifts_of(steering, 3, 3), ElementsAre(2, 4, 4));
}

TEST(PlayedSteering, WhatIsRefusedChangesNothing) {
  PlayedSteering steering(steering_settings(1));
  shifts_of(steering, 1, 1);
  for (const FrameControlKind kind :
       {FrameControlKind::kInsertFrame, FrameControlKind::kFrameLength}) {
    EXPECT_FALSE(steering.control(kind, from_ms(21)).is_accepted());
  }
  EXPECT_FALSE(steering.control(FrameControlKind::kAdjustFrame, from_ms(-2.1)).is_accepted());
  EXPECT_THAT(shifts_of(steering, 2, 5), Each(0));
}

TEST(PlayedSteering, AStartMovesTheNextFrameAndThoseAfterIt) {
  PlayedSteering steering(steering_settings(1));
  shifts_of(steering, 1, 1);
  EXPECT_TRUE(steering.restart(2, from_us(1234)).is_accepted());
  EXPECT_THAT(shifts_of(steering, 2, 2), ElementsAre(1.234, 1.234));
  FrameSteering unable = steering_settings();
  unable.limits.allowed = {true, true, true, false};
  PlayedSteering fixed(unable);
  EXPECT_FALSE(fixed.restart(0, from_ms(1)).is_accepted());
  EXPECT_EQ(fixed.shift(0), Nanoseconds(0));
}

}  // namespace
}  // namespace simbench::hardware

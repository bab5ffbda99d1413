#include "algorithms/capture_alignment/frame_clock.h"

#include <gtest/gtest.h>

namespace simbench {
namespace {

constexpr Nanoseconds kExposureToArrival =
    from_ms(12);  // from the middle of the exposure to the arrival

// Frame k of a camera at 10 fps whose system clock leads its steady clock.
FrameArrival delivered_frame(std::uint32_t k, Nanoseconds system_lead, Nanoseconds late) {
  const Nanoseconds middle = from_ms(1000 + 100.0 * k);
  FrameArrival frame;
  frame.counter = k;
  frame.sensor.us = static_cast<std::uint32_t>((middle + from_ms(4'294'900)).count() / 1000);
  frame.arrival_steady = SteadyTime(middle + kExposureToArrival + late);
  frame.arrival = HostTime(middle + kExposureToArrival + late + system_lead);
  return frame;
}

TEST(FrameClockTest, AStampOfTheHostsSteadyClockIsTaken) {
  FrameClock clock;
  FrameArrival frame = delivered_frame(7, from_ms(500), from_ms(3));
  frame.sensor_steady = SteadyTime(from_ms(1700));
  const ExposedFrame exposed = clock.at(frame);
  EXPECT_EQ(exposed.exposed, HostTime(from_ms(2200)));
  EXPECT_EQ(exposed.exposed_steady, SteadyTime(from_ms(1700)));
  EXPECT_EQ(exposed.arrival_steady, frame.arrival_steady);
  EXPECT_EQ(exposed.counter, 7u);
}

// Each third frame is not delayed: the hull's line is through those, late by the constant delay.
// The register of the camera's clock begins anew within the test.
TEST(FrameClockTest, ACamerasOwnClockIsMappedThroughItsLeastDelayedFrames) {
  FrameClock clock;
  for (std::uint32_t k = 0; k < 100; ++k) {
    const Nanoseconds late = from_ms(k % 3 == 0 ? 0 : 5);
    const ExposedFrame exposed = clock.at(delivered_frame(k, from_ms(500), late));
    if (k < 10) continue;
    const HostTime expected(from_ms(1500 + 100.0 * k) + kExposureToArrival);
    EXPECT_LE(std::abs((exposed.exposed - expected).count()), 1000) << k;
  }
}

TEST(FrameClockTest, AStepOfTheSystemClockMovesTheStampsByItAndNothingElse) {
  FrameClock clock;
  for (std::uint32_t k = 0; k < 200; ++k) {
    const Nanoseconds lead = from_ms(k < 100 ? 500 : -40);
    const Nanoseconds late = from_ms(k % 3 == 0 ? 0 : 5);
    const ExposedFrame exposed = clock.at(delivered_frame(k, lead, late));
    if (k < 10) continue;
    const HostTime expected(from_ms(1000 + 100.0 * k) + kExposureToArrival + lead);
    EXPECT_LE(std::abs((exposed.exposed - expected).count()), 1000) << k;
  }
}

// Stamps by arrivals are late by kExposureToArrival; from the third reading on they are not.
TEST(FrameClockTest, TellsWhereReadingsTakeOver) {
  FrameClock clock;
  int changes = 0;
  for (std::uint32_t k = 0; k < 20; ++k) {
    FrameArrival frame = delivered_frame(k, Nanoseconds(0), Nanoseconds(0));
    if (k >= 5) {
      const SteadyTime read = frame.arrival_steady;
      const auto device = (read.time_since_epoch() + from_ms(4'294'900)).count() / 1000;
      frame.reading = {.device = {static_cast<std::uint32_t>(device)},
                       .t0_steady = read - from_us(10),
                       .t1_steady = read + from_us(10)};
    }
    const ExposedFrame exposed = clock.at(frame);
    if (exposed.has_new_source) ++changes;
    EXPECT_EQ(exposed.has_new_source, k == 7) << k;
    const Nanoseconds late = k < 7 ? kExposureToArrival : Nanoseconds(0);
    EXPECT_NEAR(to_ms(exposed.exposed - HostTime(from_ms(1000 + 100.0 * k) + late)), 0, 0.02) << k;
  }
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace simbench

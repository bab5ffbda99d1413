#include "sim/camera/device_clock.h"

#include <gtest/gtest.h>

namespace simbench::sim {
namespace {

TEST(DeviceClock, CountsMicrosecondsRoundedDown) {
  DeviceClock clock(OscillatorModel(0.0), 2.0, TrueTime{});
  EXPECT_EQ(clock.stamp(TrueTime{}, 0).us, 2000u);
  EXPECT_EQ(clock.stamp(TrueTime(Nanoseconds(999)), 0).us, 2000u);
  EXPECT_EQ(clock.stamp(TrueTime(Nanoseconds(1000)), 0).us, 2001u);
  EXPECT_EQ(clock.stamp(TrueTime(Nanoseconds(1000)), -1).us, 2000u);
  EXPECT_EQ(clock.stamp(TrueTime(Nanoseconds(1000)), 1500).us, 2002u);
}

TEST(DeviceClock, RunsAtItsSkew) {
  DeviceClock clock(OscillatorModel(20e-6), 0, TrueTime{});
  // 100 s at +20 ppm: 2 ms ahead.
  EXPECT_EQ(clock.stamp(TrueTime(std::chrono::seconds(100)), 0).us, 100'002'000u);
  EXPECT_DOUBLE_EQ(clock.true_per_device(), 1 / 1.00002);
}

TEST(DeviceClock, WrapsAt32Bits) {
  const double wrap_ms = 4294967.296;
  DeviceClock clock(OscillatorModel(0.0), wrap_ms - 1, TrueTime{});
  EXPECT_EQ(clock.stamp(TrueTime{}, 0).us, 4294966296u);
  EXPECT_EQ(clock.stamp(TrueTime(from_ms(0.999)), 0).us, 4294967295u);
  EXPECT_EQ(clock.stamp(TrueTime(from_ms(1)), 0).us, 0u);
  EXPECT_EQ(clock.stamp(TrueTime(from_ms(1 + wrap_ms)), 0).us, 0u);
}

}  // namespace
}  // namespace simbench::sim

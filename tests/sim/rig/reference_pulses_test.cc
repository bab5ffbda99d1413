#include "sim/rig/reference_pulses.h"

#include <gtest/gtest.h>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr Nanoseconds kPulsePeriod = std::chrono::milliseconds(30);

TEST(ReferencePulses, CountFromTheNearestSlot) {
  ReferencePulses reference(at_ms(10), kPulsePeriod);
  EXPECT_EQ(reference.pulse_of(at_ms(10)), kNoPulse);
  reference.add(at_ms(104));  // slot 3 is due at 100 ms
  reference.add(at_ms(134));
  EXPECT_EQ(reference.pulse_of(at_ms(104)), 3);
  EXPECT_EQ(reference.pulse_of(at_ms(134)), 4);
}

TEST(ReferencePulses, AnExposureBelongsToTheNearest) {
  ReferencePulses reference(at_ms(0), kPulsePeriod);
  reference.add(at_ms(30));
  reference.add(at_ms(60));
  EXPECT_EQ(reference.pulse_of(at_ms(44)), 1);
  EXPECT_EQ(reference.pulse_of(at_ms(46)), 2);
  // Before the first and after the last they go on.
  EXPECT_EQ(reference.pulse_of(at_ms(2)), 0);
  EXPECT_EQ(reference.pulse_of(at_ms(-29)), kNoPulse);
  EXPECT_EQ(reference.pulse_of(at_ms(106)), 4);
}

TEST(ReferencePulses, ALongFrameLeavesSlotsOut) {
  ReferencePulses reference(at_ms(0), kPulsePeriod);
  reference.add(at_ms(0));
  reference.add(at_ms(40));   // one period and a third
  reference.add(at_ms(120));  // two and two thirds later
  EXPECT_EQ(reference.pulse_of(at_ms(40)), 1);
  EXPECT_EQ(reference.pulse_of(at_ms(120)), 4);
}

}  // namespace
}  // namespace simbench::sim

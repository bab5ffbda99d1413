// Captures of hours: counters that wrap, skews that add up.
#include <gtest/gtest.h>

#include <vector>

#include "algorithms/device_time/unwrap.h"
#include "tests/sim/rig/captured_frames.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

// A frame every 5 s for 2.5 hours, in which a register of 71.6 minutes wraps twice.
TEST(Hours, StampsOfCamerasWrapAndAreUnwrapped) {
  constexpr double kPeriodUs = 5e6;
  scenarios::Scenario s = ideal_scenario();
  s.trigger.rate_hz = 1e6 / kPeriodUs;
  s.timeline = {.wait_before_capture_ms = 100, .warm_up_ms = 0, .frames = 1800};
  s.cameras.skew_of_camera_ppm = {30, -200};
  s.cameras.clock_epoch_max_ms = 4294967.296;
  const CapturedFrames captured = capture(s, 3);
  for (std::uint32_t camera = 0; camera < 2; ++camera) {
    const std::vector<CapturedFrames::Frame> frames = captured.of(camera);
    ASSERT_EQ(frames.size(), 1800U);
    DeviceStampUnwrapper unwrapper;
    const DeviceTime first = unwrapper.unwrap(frames[0].record.sensor);
    int wraps = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      if (frames[i].record.sensor.us < frames[i - 1].record.sensor.us) ++wraps;
      const Microseconds passed = unwrapper.unwrap(frames[i].record.sensor) - first;
      const double expected_us =
          static_cast<double>(i) * kPeriodUs * (1 + s.cameras.skew_of_camera_ppm[camera] * 1e-6);
      EXPECT_NEAR(static_cast<double>(passed.count()), expected_us, 1.01) << "frame " << i;
    }
    EXPECT_GE(wraps, 2) << "camera " << camera;
  }
}

}  // namespace
}  // namespace simbench::sim

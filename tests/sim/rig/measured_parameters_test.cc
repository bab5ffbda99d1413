// Captures of a world with measured parameters: tables and skews in place of the parametric model.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/nonempty.h"
#include "tests/sim/rig/captured_frames.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

// From the end of the exposure to the arrival.
double delay_ms(const CapturedFrames::Frame& frame) {
  return host_ms_of(frame.record.arrival) - to_ms(frame.truth.exposure_end.time_since_epoch());
}

TEST(MeasuredParameters, ADelayFromTheTableComesOnTopOfPipelineAndTransfer) {
  scenarios::Scenario s = ideal_scenario();
  s.usb.delivery_jitter_transfers = 5;
  s.usb.delivery_quantiles_ms = {0.5, 1.5};
  double least = 1e9;
  double largest = 0;
  for (const auto& frame : capture(s).frames) {
    least = std::min(least, delay_ms(frame));
    largest = std::max(largest, delay_ms(frame));
  }
  // Pipeline 8 ms, transfer 2 ms; some 270 draws come within 5 % of both ends.
  EXPECT_GE(least, 10.5 - 2e-6);
  EXPECT_LT(least, 10.55);
  EXPECT_LE(largest, 11.5 + 2e-6);
  EXPECT_GT(largest, 11.45);
}

TEST(MeasuredParameters, TheBackEndStampIsTheEndOfTheTransfer) {
  scenarios::Scenario s = ideal_scenario();
  s.usb.delivery_quantiles_ms = {0.5, 1.5};
  for (const auto& frame : nonempty(capture(s).frames)) {
    EXPECT_NEAR(
        host_ms_of(frame.record.backend) - to_ms(frame.truth.exposure_end.time_since_epoch()), 10,
        2e-6);
  }
}

TEST(MeasuredParameters, FramesOfAStreamDoNotOvertakeWhateverTheTable) {
  scenarios::Scenario s = ideal_scenario();
  s.usb.delivery_quantiles_ms = {0, 100};  // a period is 22 ms
  const auto frames = capture(s).of(0);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GE(frames[i].record.arrival, frames[i - 1].record.arrival);
    EXPECT_EQ(frames[i].record.counter, frames[i - 1].record.counter + 1);
  }
}

TEST(MeasuredParameters, EachCameraHasItsOwnSkew) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.oscillator.skew_sigma_ppm = 500;
  s.cameras.skew_of_camera_ppm = {40, -215};
  const CapturedFrames result = capture(s);
  for (const std::uint32_t camera : {0u, 1u}) {
    const auto frames = result.of(camera);
    const double elapsed_us =
        to_ms(frames.back().truth.exposure_end - frames.front().truth.exposure_end) * 1e3;
    const double counted_us =
        static_cast<double>(frames.back().record.frame.us - frames.front().record.frame.us);
    // Two readings of whole microseconds over 3 s.
    EXPECT_NEAR((counted_us / elapsed_us - 1) * 1e6, s.cameras.skew_of_camera_ppm[camera], 0.7);
  }
}

TEST(MeasuredParameters, ASkewOfItsOwnMovesNoOtherDraw) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.clock_epoch_max_ms = 1e6;
  s.cameras.exposure_camera_periods = 0.2;
  s.usb.delivery_jitter_transfers = 0.5;
  const CapturedFrames drawn = capture(s);
  s.cameras.skew_of_camera_ppm = {0, 0};  // as drawn: the ideal oscillator has no skew
  const CapturedFrames stated = capture(s);
  ASSERT_EQ(drawn.frames.size(), stated.frames.size());
  for (std::size_t i = 0; i < drawn.frames.size(); ++i) {
    EXPECT_EQ(drawn.frames[i].record.frame.us, stated.frames[i].record.frame.us);
    EXPECT_EQ(drawn.frames[i].record.arrival, stated.frames[i].record.arrival);
  }
}

}  // namespace
}  // namespace simbench::sim

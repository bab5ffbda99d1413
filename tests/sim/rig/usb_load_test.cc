// What three, four and six D455 on a controller do: frames lost, frames complete and how late,
// against what the bandwidth tells (docs/reference/d455.md section 3).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "sim/rig/camera_world.h"

namespace simbench::sim {
namespace {

using scenarios::Override;
using scenarios::Scenario;

struct Profile {
  std::vector<Override> changes;
  double bytes = 0;         // of a pulse's frames of a camera
  double largest = 0;       // of a frame
  double period_ms = 0;     // of the pulses
  double mode_rate_hz = 0;  // of each stream
};

// The paper's: depth of 848x480 in the 90 Hz mode, genlock at 45 Hz.
const Profile kPaper = {.changes = {{"/usb/sharing", "fair"}},
                        .bytes = 814'080,
                        .largest = 814'080,
                        .period_ms = 1e3 / 45,
                        .mode_rate_hz = 90};

// Depth and colour of 1280x720 at 30 Hz, both triggered: 885 Mbit/s in Intel's table.
Profile depth_and_colour() {
  const std::string stream =
      R"({"kind": "KIND", "width": 1280, "height": 720, "bytes_per_pixel": 2, "mode_rate_hz": 30,
          "pipeline_latency_ms": 8, "latency_mode_periods": 0, "shutter": "global",
          "readout_ms": 0})";
  const auto of = [&stream](const char* kind) {
    std::string text = stream;
    return text.replace(text.find("KIND"), 4, kind);
  };
  return {.changes = {{"/usb/sharing", "fair"},
                      {"/trigger/rate_hz", "30"},
                      {"/cameras/sync_mode", "full_slave"},
                      {"/cameras/streams", "[" + of("depth") + ", " + of("colour") + "]"}},
          .bytes = 2 * 1'843'200,
          .largest = 1'843'200,
          .period_ms = 1e3 / 30,
          .mode_rate_hz = 30};
}

Scenario on_one_controller(const Profile& profile, int cameras,
                           const std::vector<Override>& more = {}) {
  const std::string count = std::to_string(cameras);
  std::vector<Override> all = {{"/cameras/count", count},
                               {"/cameras/cameras_per_host", count},
                               {"/usb/cameras_per_controller", count},
                               {"/hosts/count", "1"},
                               {"/cameras/exposure_host_periods", "0"},
                               {"/usb/delivery_jitter_transfers", "0"}};
  all.insert(all.end(), profile.changes.begin(), profile.changes.end());
  all.insert(all.end(), more.begin(), more.end());
  return load_scenario("18cam_6host_45fps", all);
}

struct Outcome {
  double lost_share = 0;
  double latest_ms = 0;  // the largest from a frame's offer to the end of its transfer
  std::map<std::uint32_t, double> lost_of_camera;
};

Outcome outcome_of(const Scenario& scenario) {
  CameraWorld world(scenario, 1);
  Outcome outcome;
  std::map<std::uint32_t, double> frames_of_camera;
  double frames = 0;
  double lost = 0;
  for (std::size_t i = 0; const CameraPeriod* period = world.period(i); ++i) {
    for (const SimFrame& frame : period->frames) {
      ++frames;
      ++frames_of_camera[frame.camera];
      if (frame.fate == FrameFate::kLostOnUsb) {
        ++lost;
        ++outcome.lost_of_camera[frame.camera];
        continue;
      }
      outcome.latest_ms = std::max(outcome.latest_ms, to_ms(frame.transferred - frame.offered));
    }
  }
  EXPECT_GT(frames, 1000);
  outcome.lost_share = lost / frames;
  for (auto& [camera, share] : outcome.lost_of_camera) share /= frames_of_camera[camera];
  return outcome;
}

// As many of the frames that come together get through as fit into a period of the mode.
double share_refused(const Profile& profile, int cameras, double mb_per_s) {
  const double fit = std::floor(mb_per_s * 1e6 / profile.mode_rate_hz / profile.largest);
  return std::max(0.0, 1 - fit * profile.largest / (profile.bytes * cameras));
}

// What a fluid would lose.
double fluid_share(const Profile& profile, int cameras, double mb_per_s) {
  return std::max(0.0, 1 - mb_per_s * 1e6 / (profile.bytes * profile.mode_rate_hz * cameras));
}

TEST(UsbLoad, ThePapersProfile) {
  // 73.27 MB/s a camera while it reads out: 220, 293 and 440 MB/s.
  EXPECT_EQ(share_refused(kPaper, 6, 350), 1 - 4.0 / 6);
  EXPECT_EQ(share_refused(kPaper, 6, 400), 1 - 5.0 / 6);
  EXPECT_NEAR(fluid_share(kPaper, 6, 350), 0.204, 5e-4);
  for (const double mb_per_s : {350.0, 400.0}) {
    for (const int cameras : {3, 4, 6}) {
      SCOPED_TRACE(testing::Message() << cameras << " cameras, " << mb_per_s << " MB/s");
      const Outcome outcome = outcome_of(on_one_controller(
          kPaper, cameras, {{"/usb/bandwidth_mb_per_s", std::to_string(mb_per_s)}}));
      const double expected = share_refused(kPaper, cameras, mb_per_s);
      EXPECT_NEAR(outcome.lost_share, expected, 1e-9);
      EXPECT_GE(outcome.lost_share, fluid_share(kPaper, cameras, mb_per_s));
      // What gets through shares the bus fairly, so all of it ends together.
      const double through = cameras * (1 - expected);
      EXPECT_NEAR(outcome.latest_ms, through * kPaper.bytes / mb_per_s * 1e-3, 1e-3);
    }
  }
}

TEST(UsbLoad, DepthAndColourAreWhatThreeCamerasOnAControllerMayHave) {
  const Profile profile = depth_and_colour();
  // 110.6 MB/s a camera: 332, 442 and 664 MB/s of 400.
  EXPECT_EQ(fluid_share(profile, 3, 400), 0);
  EXPECT_NEAR(fluid_share(profile, 4, 400), 0.0958, 1e-4);
  EXPECT_NEAR(fluid_share(profile, 6, 400), 0.397, 1e-3);
  for (const int cameras : {3, 4, 6}) {
    SCOPED_TRACE(testing::Message() << cameras << " cameras");
    const Outcome outcome =
        outcome_of(on_one_controller(profile, cameras, {{"/usb/bandwidth_mb_per_s", "400"}}));
    EXPECT_NEAR(outcome.lost_share, share_refused(profile, cameras, 400), 1e-9);
    EXPECT_GE(outcome.lost_share, fluid_share(profile, cameras, 400));
  }
}

// Cameras that could keep their frames: what counts is the average, and the overload's share is
// exactly the fluid's.
TEST(UsbLoad, WithMemoryInTheCamerasTheAverageDecides) {
  const std::vector<Override> without_limit = {{"/usb/hold_mode_periods", "0"},
                                               {"/usb/bandwidth_mb_per_s", "400"},
                                               {"/timeline/frames", "3000"}};
  EXPECT_EQ(outcome_of(on_one_controller(kPaper, 6, without_limit)).lost_share, 0)
      << "220 MB/s on average";
  const Profile profile = depth_and_colour();
  EXPECT_EQ(outcome_of(on_one_controller(profile, 3, without_limit)).lost_share, 0);
  for (const int cameras : {4, 6}) {
    EXPECT_NEAR(outcome_of(on_one_controller(profile, cameras, without_limit)).lost_share,
                fluid_share(profile, cameras, 400), 0.003)
        << cameras << " cameras";
  }
}

TEST(UsbLoad, DedicatedBusesLoseNothing) {
  EXPECT_EQ(outcome_of(on_one_controller(kPaper, 6, {{"/usb/sharing", "dedicated"}})).lost_share,
            0);
}

}  // namespace
}  // namespace simbench::sim

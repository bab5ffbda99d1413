#include "hardware/camera/drivers.h"

#include <gmock/gmock.h>

#include <utility>
#include <vector>

#include "tests/hardware/camera/camera_values.h"
#include "tests/hardware/camera/seen_frames.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kCsv =
    "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\nDepth,0,7,1000,12\n";

RigHost rig_host(std::vector<RigCamera> cameras) {
  RigHost result;
  result.cameras = std::move(cameras);
  return result;
}

TEST(CameraDrivers, ARecordedCameraIsPlayed) {
  const ScratchFolder folder;
  Rig rig;
  rig.hosts = {rig_host({recorded("real", "")}),
               rig_host({recorded("left", folder.write("a.csv", kCsv))})};
  const auto driver = make_camera_driver(rig, 1);
  ASSERT_EQ(driver->list().size(), 1U);
  EXPECT_EQ(driver->list()[0].serial, "left");
  const auto camera = driver->open("left");
  EXPECT_EQ(camera->info().serial, "left");
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  ASSERT_TRUE(seen.wait_for_frames(1));
  EXPECT_EQ(seen.frames()[0].counter, 7U);
}

TEST(CameraDrivers, AnotherHostsCameraIsRefused) {
  const ScratchFolder folder;
  Rig rig;
  rig.hosts = {rig_host({recorded("left", folder.write("a.csv", kCsv))}), rig_host({})};
  EXPECT_THAT([&] { make_camera_driver(rig, 0)->open("right"); },
              ThrowsMessage<CameraError>("camera right: not of this host, whose cameras are left"));
  EXPECT_THAT([&] { make_camera_driver(rig, 1)->open("left"); },
              ThrowsMessage<CameraError>("camera left: not of this host, whose cameras are none"));
}

#ifndef SIMBENCH_HAS_REALSENSE
TEST(CameraDrivers, ARealCameraNeedsTheLibrary) {
  Rig rig;
  rig.file = "rig.json";
  rig.hosts = {rig_host({recorded("018322071234", "")})};
  EXPECT_THAT([&] { make_camera_driver(rig, 0); },
              ThrowsMessage<CameraError>(
                  AllOf(HasSubstr("camera 018322071234: "), HasSubstr("without librealsense2"),
                        HasSubstr("docs/rigs.md"), HasSubstr("\"recording\" in rig.json"))));
}
#endif

}  // namespace
}  // namespace simbench::hardware

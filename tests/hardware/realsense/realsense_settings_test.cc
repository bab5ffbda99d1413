#include "hardware/realsense/realsense_settings.h"

#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "hardware/realsense/realsense_camera.h"
#include "tests/hardware/camera/camera_values.h"
#include "tests/hardware/realsense/software_camera.h"

namespace simbench::hardware {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

CameraSettings exposed(CameraSettings settings, double exposure_ms) {
  settings.exposure_ms = exposure_ms;
  return settings;
}

CameraSettings depth_at(const std::string& sync_mode, double trigger_rate_hz = 0) {
  return exposed(settings(sync_mode, {stream("depth", 60)}, trigger_rate_hz), 8);
}

void configure(const SoftwareCamera& camera, const CameraSettings& wanted) {
  RealsenseCamera(camera.device).configure(wanted);
}

TEST(RealsenseSettings, TheSyncModeIsItsNumber) {
  SoftwareCamera camera;
  const std::vector<std::pair<const char*, float>> modes = {
      {"genlock", 4.F}, {"full_slave", 3.F}, {"slave", 2.F}, {"master", 1.F}, {"default", 0.F}};
  for (const auto& [mode, value] : modes) {
    configure(camera, depth_at(mode, 30));
    EXPECT_EQ(camera.depth.get_option(RS2_OPTION_INTER_CAM_SYNC_MODE), value) << mode;
  }
}

TEST(RealsenseSettings, AModeThatTheFirmwareHasNotIsRefusedWithTheOneThatHas) {
  SoftwareCamera camera("old", 2);
  EXPECT_THAT([&] { configure(camera, depth_at("genlock", 30)); },
              ThrowsMessage<CameraError>(AllOf(HasSubstr("camera old: sync mode genlock is 4"),
                                               HasSubstr("firmware 5.12.3.0 allows 0 to 2"),
                                               HasSubstr("needs firmware 5.12.4.0 or newer"))));
  EXPECT_NO_THROW(configure(camera, depth_at("slave", 60)));
}

TEST(RealsenseSettings, ACameraWithoutTheOptionRunsFreeOnly) {
  SoftwareCamera camera = SoftwareCamera::bare();
  camera.depth.add_option(RS2_OPTION_EXPOSURE, {1, 200'000, 33'000, 1});
  EXPECT_NO_THROW(configure(camera, depth_at("default")));
  EXPECT_THAT([&] { configure(camera, depth_at("slave")); },
              ThrowsMessage<CameraError>(AllOf(HasSubstr("no option Inter Cam Sync Mode"),
                                               HasSubstr("firmware 5.9.15.1 or newer"))));
}

TEST(RealsenseSettings, AProfileIsChosenOrTheNearestAreNamed) {
  SoftwareCamera camera;
  const auto chosen =
      choose_sensors(camera.device, "s",
                     settings("default", {stream("depth", 90, 848, 480), stream("colour", 30)}));
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_EQ(chosen[0].profiles[0].as<rs2::video_stream_profile>().width(), 848);
  EXPECT_EQ(chosen[0].exposure_unit_us, 1);
  EXPECT_EQ(chosen[1].profiles[0].format(), RS2_FORMAT_YUYV);
  EXPECT_EQ(chosen[1].exposure_unit_us, 100);
  EXPECT_THAT(
      [&] { choose_sensors(camera.device, "s", settings("default", {stream("depth", 45)})); },
      ThrowsMessage<CameraError>(
          "camera s: no depth profile 640x480 at 45 Hz, the nearest it has: 640x480 at 60 Hz, "
          "640x480 at 30 Hz, 640x480 at 90 Hz, 848x480 at 90 Hz"));
  EXPECT_THAT([&] { choose_sensors(camera.device, "s", settings("default", {})); },
              ThrowsMessage<CameraError>("camera s: no stream is wanted"));
}

TEST(RealsenseSettings, AStreamThatTheCameraHasNotIsRefused) {
  rs2::software_device device;
  device.add_sensor("empty");
  EXPECT_THAT([&] { choose_sensors(device, "s", settings("default", {stream("colour", 30)})); },
              ThrowsMessage<CameraError>(HasSubstr("it has no colour stream")));
}

TEST(RealsenseSettings, GenlockTakesHalfTheModesRate) {
  SoftwareCamera camera;
  EXPECT_NO_THROW(configure(camera, depth_at("genlock", 30)));
  EXPECT_NO_THROW(configure(camera, depth_at("genlock", 30.015)));  // as the vendor advises
  EXPECT_THAT([&] { configure(camera, depth_at("genlock", 45)); },
              ThrowsMessage<CameraError>(HasSubstr(
                  "found triggers at 45 Hz, allowed in genlock: at most 30 Hz, half of the depth "
                  "mode's 60 Hz")));
  EXPECT_NO_THROW(configure(camera, depth_at("slave", 60)));
}

TEST(RealsenseSettings, ExposureIsSetInTheUnitOfTheSensor) {
  SoftwareCamera camera;
  configure(camera, exposed(settings("default", {stream("depth", 30), stream("colour", 30)}), 8.3));
  EXPECT_EQ(camera.depth.get_option(RS2_OPTION_EXPOSURE), 8300.F);
  EXPECT_EQ(camera.colour.get_option(RS2_OPTION_EXPOSURE), 83.F);
  EXPECT_EQ(camera.depth.get_option(RS2_OPTION_ENABLE_AUTO_EXPOSURE), 0.F);
  EXPECT_EQ(camera.colour.get_option(RS2_OPTION_ENABLE_AUTO_EXPOSURE), 0.F);
  EXPECT_THAT([&] { configure(camera, exposed(depth_at("default"), 201)); },
              ThrowsMessage<CameraError>(HasSubstr("found exposure 201 ms, allowed 0.001 to 200")));
}

TEST(RealsenseSettings, AutoExposureIsSwitchedOnWhereThereIsSuchASwitch) {
  SoftwareCamera camera;
  CameraSettings wanted = depth_at("default");
  configure(camera, wanted);
  wanted.auto_exposure = true;
  configure(camera, wanted);
  EXPECT_EQ(camera.depth.get_option(RS2_OPTION_ENABLE_AUTO_EXPOSURE), 1.F);
  EXPECT_EQ(camera.depth.get_option(RS2_OPTION_EXPOSURE), 8000.F);
  const SoftwareCamera bare = SoftwareCamera::bare();
  EXPECT_THAT([&] { configure(bare, wanted); },
              ThrowsMessage<CameraError>(HasSubstr("auto exposure is wanted")));
  EXPECT_THAT([&] { configure(bare, depth_at("default")); },
              ThrowsMessage<CameraError>(HasSubstr("an exposure of 8 ms is wanted")));
}

TEST(RealsenseSettings, GlobalTimeIsSwitchedOff) {
  SoftwareCamera camera;
  ASSERT_EQ(camera.depth.get_option(RS2_OPTION_GLOBAL_TIME_ENABLED), 1.F);
  configure(camera, depth_at("default"));
  EXPECT_EQ(camera.depth.get_option(RS2_OPTION_GLOBAL_TIME_ENABLED), 0.F);
}

TEST(RealsenseSettings, AnOptionThatCannotBeWrittenIsACameraError) {
  SoftwareCamera camera = SoftwareCamera::bare();
  camera.depth.add_option(RS2_OPTION_INTER_CAM_SYNC_MODE, {0, 260, 0, 1}, false);
  EXPECT_THAT([&] { configure(camera, depth_at("slave")); },
              ThrowsMessage<CameraError>(HasSubstr("sync mode slave cannot be set now")));
  SoftwareCamera fixed = SoftwareCamera::bare();
  fixed.depth.add_option(RS2_OPTION_EXPOSURE, {1, 200'000, 33'000, 1}, false);
  EXPECT_THAT([&] { configure(fixed, depth_at("default")); },
              ThrowsMessage<CameraError>(HasSubstr("camera bare: setting its exposure: "
                                                   "librealsense2 says: ")));
}

}  // namespace
}  // namespace simbench::hardware

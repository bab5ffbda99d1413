#include "hardware/realsense/realsense_camera.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <string>

#include "hardware/realsense/realsense_driver.h"
#include "tests/hardware/camera/camera_values.h"
#include "tests/hardware/camera/seen_frames.h"
#include "tests/hardware/realsense/software_camera.h"

namespace simbench::hardware {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;
using Kind = CameraEvent::Kind;

CameraSettings wanted(const std::string& sync_mode = "default") {
  CameraSettings result = settings(sync_mode, {stream("depth", 30)}, 15);
  result.exposure_ms = 8;
  return result;
}

TEST(RealsenseCamera, SaysWhatItIs) {
  const SoftwareCamera software;
  const RealsenseCamera camera(software.device);
  EXPECT_EQ(camera.info().serial, "018322071234");
  EXPECT_EQ(camera.info().model, "Intel RealSense D455");
  EXPECT_EQ(camera.info().firmware, "5.12.3.0");
  EXPECT_EQ(camera.info().connection, "USB 3.2");
}

TEST(RealsenseCamera, WithoutANameItIsKnownByItsSerialNumber) {
  SoftwareCamera software;
  software.set_name("");
  RealsenseCamera camera(software.device);
  EXPECT_EQ(camera.info().model, "");
  SeenFrames seen;
  EXPECT_THAT([&] { camera.start(seen.on_frame(), seen.on_event()); },
              ThrowsMessage<CameraError>(HasSubstr("camera 018322071234: started before")));
}

TEST(RealsenseCamera, HandsOnFramesAcrossTheWrapWithoutAnEvent) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  camera.configure(wanted());
  SeenFrames seen;
  const MonotonicTime before = monotonic_now();
  camera.start(seen.on_frame(), seen.on_event());
  for (std::int64_t i = 0; i < 8; ++i) {
    const std::int64_t us = 0xffff'ffff - 100'000 + 33'333 * i;
    software.set_all(i, us - 20'000, us);
    software.inject();
  }
  camera.stop();
  software.inject();
  const auto frames = seen.frames();
  ASSERT_EQ(frames.size(), 8U);
  for (std::size_t i = 1; i < 8; ++i) {
    EXPECT_EQ(frames[i].frame.us - frames[i - 1].frame.us, 33'333U);
    EXPECT_EQ(frames[i].sensor.us - frames[i - 1].sensor.us, 33'333U);
    EXPECT_GE(frames[i].arrived, frames[i - 1].arrived);
  }
  EXPECT_GE(frames[0].arrived, before);
  EXPECT_LE(frames[7].arrived, monotonic_now());
  EXPECT_THAT(seen.events(), IsEmpty());
}

TEST(RealsenseCamera, DepthAndColourAreToldApart) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  CameraSettings both = wanted();
  both.streams.push_back(stream("colour", 30));
  camera.configure(both);
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  software.set_all(5, 1000, 2000);
  software.inject();
  software.colour.set_metadata(RS2_FRAME_METADATA_ACTUAL_EXPOSURE, 83);
  software.inject_colour(9);
  const auto frames = seen.frames();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].stream, StreamKind::kDepth);
  EXPECT_EQ(frames[0].exposure_us, 6951U);
  EXPECT_EQ(frames[1].stream, StreamKind::kColour);
  EXPECT_EQ(frames[1].counter, 9U);
  EXPECT_EQ(frames[1].exposure_us, 8300U);
}

TEST(RealsenseCamera, MissingMetadataIsToldOnce) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  camera.configure(wanted());
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  for (int i = 0; i < 3; ++i) software.inject(33.0 * i, RS2_TIMESTAMP_DOMAIN_SYSTEM_TIME, i);
  EXPECT_EQ(seen.frames().size(), 3U);
  ASSERT_EQ(seen.events().size(), 1U);
  EXPECT_EQ(seen.events()[0].kind, Kind::kMissingMetadata);
  EXPECT_THAT(seen.events()[0].text, HasSubstr("SENSOR_TIMESTAMP"));
}

TEST(RealsenseCamera, AGapOfTheCounterIsReported) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  camera.configure(wanted());
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  software.set_all(3, 1000, 2000);
  software.inject();
  software.set_all(6, 101'000, 102'000);
  software.inject();
  ASSERT_EQ(seen.events().size(), 1U);
  EXPECT_THAT(seen.events()[0].text, HasSubstr("from 3 to 6: 2 frames lost"));
}

TEST(RealsenseCamera, AStreamThatStallsIsToldWhileNoFrameComes) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  camera.configure(wanted());
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  software.set_all(1, 1000, 2000);
  software.inject();
  EXPECT_TRUE(seen.wait_for_event(Kind::kStalled, "depth: no frame for"));
  software.set_all(2, 1'200'000, 1'201'000);
  software.inject();
  EXPECT_TRUE(seen.wait_for_event(Kind::kNote, "frames come again"));
}

TEST(RealsenseCamera, MisuseIsOneClearError) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  SeenFrames seen;
  EXPECT_THAT([&] { camera.start(seen.on_frame(), seen.on_event()); },
              ThrowsMessage<CameraError>(HasSubstr("018322071234: started before it was config")));
  camera.configure(wanted());
  camera.start(seen.on_frame(), seen.on_event());
  EXPECT_THAT([&] { camera.start(seen.on_frame(), seen.on_event()); },
              ThrowsMessage<CameraError>(HasSubstr("started twice")));
  EXPECT_THAT([&] { camera.configure(wanted()); },
              ThrowsMessage<CameraError>(HasSubstr("configured while it is started")));
  camera.stop();
  camera.stop();
  EXPECT_NO_THROW(camera.configure(wanted()));
}

TEST(RealsenseCamera, ASensorThatSomebodyElseStreamsFromIsACameraErrorAndCanBeTriedAgain) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  CameraSettings both = wanted();
  both.streams.push_back(stream("colour", 30));
  camera.configure(both);
  software.colour.open(software.colour_profiles.front());
  SeenFrames seen;
  EXPECT_THAT([&] { camera.start(seen.on_frame(), seen.on_event()); },
              ThrowsMessage<CameraError>(HasSubstr("does another program use it?")));
  software.colour.close();
  camera.start(seen.on_frame(), seen.on_event());  // the depth sensor was let go
  software.set_all(1, 1000, 2000);
  software.inject();
  EXPECT_EQ(seen.frames().size(), 1U);
}

TEST(RealsenseCamera, NoHandlerRunsAfterStopAndStartStreamsAgain) {
  SoftwareCamera software;
  RealsenseCamera camera(software.device);
  camera.configure(wanted());
  software.set_all(1, 1000, 2000);
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  software.inject();
  camera.stop();
  software.inject();
  EXPECT_EQ(seen.frames().size(), 1U);
  SeenFrames again;
  camera.start(again.on_frame(), again.on_event());
  software.inject();
  EXPECT_EQ(again.frames().size(), 1U);
}

TEST(RealsenseCamera, ACameraThatIsPluggedInAgainStreamsAgainAsItWasSet) {
  SoftwareCamera first;
  SoftwareCamera second;
  RealsenseCamera camera(first.device);
  camera.configure(wanted("slave"));
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  camera.unplugged();
  camera.unplugged();
  EXPECT_EQ(seen.events_of(Kind::kDisconnected), 1U);
  first.set_all(1, 1000, 2000);
  first.inject();
  EXPECT_THAT(seen.frames(), IsEmpty());
  camera.plugged_in(second.device);
  EXPECT_EQ(seen.events_of(Kind::kReturned), 1U);
  EXPECT_EQ(second.depth.get_option(RS2_OPTION_INTER_CAM_SYNC_MODE), 2.F);
  second.set_all(1, 1000, 2000);
  second.inject();
  EXPECT_EQ(seen.frames().size(), 1U);
}

TEST(RealsenseCamera, AnUnpluggedCameraIsNotStartedAndOneThatCannotGoOnSaysWhy) {
  SoftwareCamera first;
  const SoftwareCamera old("018322071234", 2);
  RealsenseCamera camera(first.device);
  camera.configure(wanted("genlock"));
  SeenFrames seen;
  camera.start(seen.on_frame(), seen.on_event());
  camera.unplugged();
  camera.plugged_in(old.device);
  EXPECT_TRUE(seen.wait_for_event(Kind::kNote, "plugged in again, but: camera 018322071234"));
  EXPECT_EQ(seen.events_of(Kind::kReturned), 0U);
  camera.stop();
  camera.unplugged();
  EXPECT_THAT([&] { camera.start(seen.on_frame(), seen.on_event()); },
              ThrowsMessage<CameraError>(HasSubstr("unplugged")));
}

TEST(RealsenseDriver, FindsCamerasBySerialAndToldOfTheirReturn) {
  SoftwareCamera right("right");
  SoftwareCamera left("left");
  const rs2::device_list right_plugged_in = plug_in(right);
  const rs2::device_list left_plugged_in = plug_in(left);
  RealsenseDriver driver(shared_context());
  ASSERT_EQ(driver.list().size(), 2U);
  EXPECT_EQ(driver.list()[0].serial, "left");
  EXPECT_EQ(driver.list()[1].serial, "right");
  EXPECT_EQ(driver.list()[1].firmware, "5.12.3.0");
  EXPECT_THAT([&] { driver.open("middle"); },
              ThrowsMessage<CameraError>(
                  "camera middle: not plugged in; RealSense cameras found: left, right"));
  const auto camera = driver.open("right");
  camera->configure(wanted());
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  right.set_all(1, 1000, 2000);
  right.inject();
  EXPECT_TRUE(seen.wait_for_frames(1));
  SoftwareCamera returned("right");
  returned.device.add_to(shared_context());
  EXPECT_TRUE(seen.wait_for_event(Kind::kReturned, "plugged in again"));
  returned.set_all(7, 1000, 2000);
  returned.inject();
  EXPECT_TRUE(seen.wait_for_frames(2));
  EXPECT_EQ(seen.frames().back().counter, 7U);
}

}  // namespace
}  // namespace simbench::hardware

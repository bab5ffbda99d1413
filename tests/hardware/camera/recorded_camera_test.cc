#include "hardware/camera/recorded_camera.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/hardware/camera/camera_values.h"
#include "tests/hardware/camera/seen_frames.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kHeader =
    "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";

// `count` frames of camera `name`, each 4 ms, the first arriving at `first_ms`.
std::string lines(const std::string& name, int count, int first_ms = 100,
                  const std::string& stream = "Depth") {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += fmt::format("{},0,{},{},{},{},h\n", stream, i, 5000 + 4 * i, first_ms + 4 * i, name);
  }
  return text;
}

std::vector<std::uint32_t> counters(const std::vector<CameraFrame>& frames) {
  std::vector<std::uint32_t> result;
  result.reserve(frames.size());
  for (const CameraFrame& frame : frames) result.push_back(frame.counter);
  return result;
}

std::string instant(MonotonicTime at) { return std::to_string(nanoseconds_of(at)) + "\n"; }

TEST(RecordedCamera, PlaysEveryFrameAsRecordedAndNeverEarly) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 20));
  RecordedCameraDriver driver({recorded("left", csv)});
  const auto camera = driver.open("left");
  SeenFrames seen;
  const MonotonicTime before = monotonic_now();
  camera->start(seen.on_frame(), seen.on_event());
  ASSERT_TRUE(seen.wait_for_frames(20));
  ASSERT_TRUE(seen.wait_for_event(CameraEvent::Kind::kEnded, "the recording is over"));
  camera->stop();
  const auto frames = seen.frames();
  ASSERT_EQ(frames.size(), 20U);
  for (std::uint32_t i = 0; i < 20; ++i) {
    EXPECT_EQ(frames[i].counter, i);
    EXPECT_EQ(frames[i].sensor, DeviceStamp{5'000'000 + 4000 * i});
    EXPECT_EQ(frames[i].frame, frames[i].sensor);
    EXPECT_FALSE(frames[i].backend);
    EXPECT_GE(frames[i].arrived, before + from_ms(20 + 4.0 * i));
  }
}

TEST(RecordedCamera, NotesALastLineThatMayBeCut) {
  const ScratchFolder folder;
  std::string text = kHeader + lines("front", 3) + lines("back", 3);
  text.pop_back();
  const std::string csv = folder.write("a.csv", text);
  RecordedCameraDriver driver({recorded("front", csv), recorded("back", csv)});
  SeenFrames front;
  SeenFrames back;
  const auto first = driver.open("front");
  const auto second = driver.open("back");
  first->start(front.on_frame(), front.on_event());
  second->start(back.on_frame(), back.on_event());
  ASSERT_TRUE(front.wait_for_event(CameraEvent::Kind::kNote,
                                   csv + ":7: the last line has no line end and may be cut"));
  ASSERT_TRUE(back.wait_for_event(CameraEvent::Kind::kEnded, "the recording is over"));
  EXPECT_EQ(back.frames().size(), 2U);
  EXPECT_EQ(back.events_of(CameraEvent::Kind::kNote), 0U);  // said once for the file
}

TEST(RecordedCamera, ListsWhatItPlays) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 1) + lines("back", 1));
  RecordedCameraDriver driver(
      {recorded("one", csv, "back"), recorded("front", csv), recorded("three", csv, "1")});
  const auto list = driver.list();
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].serial, "one");
  EXPECT_EQ(list[0].model, "recording of back (" + csv + ")");
  EXPECT_EQ(list[1].model, "recording of front (" + csv + ")");
  EXPECT_EQ(list[2].model, list[0].model);
}

TEST(RecordedCamera, CamerasOfOneTriggerShareTheRecordingsZero) {
  const ScratchFolder folder;
  const std::string csv =
      folder.write("a.csv", kHeader + lines("front", 5, 100) + lines("back", 5, 150));
  const std::string trigger = folder / "trigger";
  RecordedCameraDriver driver(
      {recorded("front", csv, "", trigger), recorded("back", csv, "", trigger)});
  SeenFrames front;
  SeenFrames back;
  const auto front_camera = driver.open("front");
  const auto back_camera = driver.open("back");
  front_camera->start(front.on_frame(), front.on_event());
  back_camera->start(back.on_frame(), back.on_event());
  const MonotonicTime zero = monotonic_now() + from_ms(30);
  folder.write("trigger", instant(zero));
  ASSERT_TRUE(front.wait_for_frames(5));
  ASSERT_TRUE(back.wait_for_frames(5));
  EXPECT_GE(front.frames()[0].arrived, zero);
  EXPECT_GE(back.frames()[0].arrived, zero + from_ms(50));
}

TEST(RecordedCamera, RemovingTheTriggerEndsPlayingAndTheNextBeginsAnew) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 2000));
  const std::string trigger = folder / "trigger";
  RecordedCameraDriver driver({recorded("front", csv, "", trigger)});
  const auto camera = driver.open("front");
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  folder.write("trigger", instant(monotonic_now()));
  ASSERT_TRUE(seen.wait_for_frames(3));
  std::filesystem::remove(trigger);
  // Far more than a look at the file takes; what is handed over until then is not limited.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const std::size_t played = seen.frames().size();
  const MonotonicTime again = monotonic_now();
  folder.write("trigger", instant(again));
  ASSERT_TRUE(seen.wait_for_frames(played + 3));
  camera->stop();
  const auto frames = seen.frames();
  EXPECT_LT(played, 2000U);
  EXPECT_EQ(frames[played].counter, 0U);
  EXPECT_GE(frames[played].arrived, again);
}

TEST(RecordedCamera, ATriggerOfLongAgoIsNoTrigger) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 1000));
  RecordedCameraDriver driver({recorded(
      "front", csv, "", folder.write("trigger", instant(monotonic_now() - from_ms(1500))))});
  const auto camera = driver.open("front");
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  // Were it one, the recording would be in its second second.
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const MonotonicTime zero = monotonic_now() + from_ms(50);
  folder.write("trigger", instant(zero));
  ASSERT_TRUE(seen.wait_for_frames(3));
  EXPECT_GE(seen.frames()[0].arrived, zero);
  EXPECT_EQ(seen.frames()[0].counter, 0U);
}

TEST(RecordedCamera, WhatWasDueBeforeTheCameraWasOnIsNotPlayed) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 300));
  const MonotonicTime zero = monotonic_now() - from_ms(600);
  RecordedCameraDriver driver({recorded("front", csv, "", folder.write("trigger", instant(zero)))});
  const auto camera = driver.open("front");
  SeenFrames seen;
  const MonotonicTime before = monotonic_now();
  camera->start(seen.on_frame(), seen.on_event());
  ASSERT_TRUE(seen.wait_for_frames(1));
  EXPECT_GE(zero + from_ms(4.0 * seen.frames()[0].counter), before);
}

TEST(RecordedCamera, ATriggerFileWithoutAnInstantIsReported) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 3));
  RecordedCameraDriver driver({recorded("front", csv, "", folder.write("trigger", "soon\x01"))});
  const auto camera = driver.open("front");
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  EXPECT_TRUE(seen.wait_for_event(CameraEvent::Kind::kNote, "found 'soon?', allowed: nanoseconds"));
  folder.write("trigger", instant(monotonic_now() + from_ms(4e6)));  // over an hour ahead
  folder.write("trigger", instant(monotonic_now()));
  EXPECT_TRUE(seen.wait_for_frames(3));
}

TEST(RecordedCamera, NoHandlerRunsAfterStopAndStartPlaysAgain) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 1000));
  RecordedCameraDriver driver({recorded("front", csv)});
  const auto camera = driver.open("front");
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  ASSERT_TRUE(seen.wait_for_frames(5));
  camera->stop();
  camera->stop();
  const std::size_t played = seen.frames().size();
  EXPECT_LT(played, 1000U);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // a dozen frames
  EXPECT_EQ(seen.frames().size(), played);
  SeenFrames again;
  camera->start(again.on_frame(), again.on_event());
  ASSERT_TRUE(again.wait_for_frames(2));
  EXPECT_EQ(again.frames()[0].counter, 0U);
}

TEST(RecordedCamera, OutlivesItsDriver) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 3));
  std::unique_ptr<Camera> camera;
  {
    RecordedCameraDriver driver({recorded("front", csv)});
    camera = driver.open("front");
  }
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  EXPECT_TRUE(seen.wait_for_frames(3));
}

TEST(RecordedCamera, PlaysTheStreamsThatAreWantedAndRefusesThoseItHasNot) {
  const ScratchFolder folder;
  const std::string csv = folder.write(
      "a.csv", kHeader + lines("front", 4) + lines("front", 4, 100, "Color") + lines("mono", 4));
  RecordedCameraDriver driver({recorded("front", csv), recorded("mono", csv)});
  const auto camera = driver.open("front");
  camera->configure(settings("genlock", {stream("colour", 90)}));
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  ASSERT_TRUE(seen.wait_for_event(CameraEvent::Kind::kEnded, "the recording is over"));
  EXPECT_EQ(counters(seen.frames()), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  for (const CameraFrame& frame : seen.frames()) EXPECT_EQ(frame.stream, StreamKind::kColour);
  EXPECT_THAT([&] { driver.open("mono")->configure(settings("genlock", {stream("colour", 90)})); },
              ::testing::ThrowsMessage<CameraError>(AllOf(
                  HasSubstr("camera mono: recording of mono"), HasSubstr("has no colour stream"))));
}

TEST(RecordedCamera, MisuseIsOneClearError) {
  const ScratchFolder folder;
  const std::string csv = folder.write("a.csv", kHeader + lines("front", 3));
  RecordedCameraDriver driver({recorded("front", csv)});
  EXPECT_THAT([&] { driver.open("back"); },
              ::testing::ThrowsMessage<CameraError>(
                  "camera back: not among the recorded cameras, which are front"));
  const auto camera = driver.open("front");
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  EXPECT_THROW(camera->start(seen.on_frame(), seen.on_event()), CameraError);
  EXPECT_THROW(camera->configure({}), CameraError);
}

TEST(RecordedCamera, AStreamThatStallsInTheRecordingIsToldLikeARealOne) {
  const ScratchFolder folder;
  const std::string csv =
      folder.write("a.csv", kHeader + lines("front", 3) + "Depth,0,9,6700,1600,front,h\n");
  RecordedCameraDriver driver({recorded("front", csv)});
  const auto camera = driver.open("front");
  camera->configure(settings("default", {stream("depth", 90)}));
  SeenFrames seen;
  camera->start(seen.on_frame(), seen.on_event());
  ASSERT_TRUE(seen.wait_for_event(CameraEvent::Kind::kEnded, "the recording is over"));
  EXPECT_EQ(seen.events_of(CameraEvent::Kind::kStalled), 1U);
  EXPECT_TRUE(seen.wait_for_event(CameraEvent::Kind::kNote, "from 2 to 9: 6 frames lost"));
}

}  // namespace
}  // namespace simbench::hardware

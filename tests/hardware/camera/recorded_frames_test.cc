#include "hardware/camera/recorded_frames.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "hardware/camera/camera.h"
#include "recording/event.h"
#include "recording/recording_folder.h"
#include "tests/hardware/camera/camera_values.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr const char* kFramesHeader =
    "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";

FrameEvent frame(std::uint32_t camera, std::uint32_t counter, double arrival_ms) {
  FrameEvent event;
  event.record = {.camera = camera,
                  .stream = StreamKind::kColour,
                  .domain = StampDomain::kGlobalTime,
                  .counter = counter,
                  .exposure_us = 8000,
                  .sensor = {1000 + counter},
                  .frame = {2000 + counter},
                  .backend = HostTime(from_ms(arrival_ms - 0.5)),
                  .arrival = HostTime(from_ms(arrival_ms)),
                  .arrival_steady = SteadyTime(from_ms(arrival_ms + 777))};
  return event;
}

// Exposed for 8 ms from `exposed_ms`; had by the host `delay_ms` after mid-exposure.
FrameEvent true_frame(std::uint32_t camera, std::uint32_t counter, std::int64_t pulse,
                      double exposed_ms, double delay_ms) {
  FrameEvent event = frame(camera, counter, 5e6 + exposed_ms);
  FrameTruth truth;
  truth.pulse = pulse;
  truth.exposure_start = TrueTime(from_ms(exposed_ms));
  truth.exposure_end = TrueTime(from_ms(exposed_ms + 8));
  truth.own_steady = event.record.arrival_steady - from_ms(delay_ms);
  event.truth = truth;
  return event;
}

std::string folder_of(const ScratchFolder& folder, const std::vector<FrameEvent>& frames,
                      const std::vector<std::string>& pipelines = {"both"}) {
  RecordingDescription description;
  description.backend = "sim";
  description.scenario_json = "{}";
  description.cameras = {"left", "right"};
  RecordingWriter writer(folder / "recording", description);
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    RecordingSink& sink = writer.begin(pipelines[i], 7);
    RigLayout layout;
    layout.hosts = 1;
    layout.frame_rate_hz = 50;
    layout.cameras.resize(2);
    sink.on_start(layout);
    for (const FrameEvent& event : frames) {
      FrameEvent each = event;
      each.record.counter += 100 * static_cast<std::uint32_t>(i);
      sink.on_frame(each.record, each.truth ? &*each.truth : nullptr);
    }
    writer.end({});
  }
  return folder / "recording";
}

std::vector<std::int64_t> due(const PlayedCamera& camera) {
  std::vector<std::int64_t> result;
  result.reserve(camera.frames.size());
  for (const PlayedFrame& frame : camera.frames) result.push_back(frame.due_ns);
  return result;
}

TEST(RecordedFrames, AFrameIsSmall) { EXPECT_LE(sizeof(PlayedFrame), 40U); }

TEST(RecordedFrames, WithTruthTheZeroIsTheFirstTriggeredExposureOfAnyCamera) {
  const ScratchFolder folder;
  const std::string path =
      folder_of(folder, {true_frame(0, 0, -1, 900, 30),  // free-running: before the zero
                         true_frame(1, 0, 0, 1000, 31), true_frame(0, 1, 0, 1002, 30),
                         true_frame(0, 2, 1, 1022, 45)});
  const auto cameras = load_played_cameras(path, {recorded("left", path)});
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras[0]->name, "left");
  // Mid-exposure after 1000 ms, and the delay.
  EXPECT_EQ(due(*cameras[0]),
            (std::vector<std::int64_t>{(-100 + 4 + 30) * 1'000'000, (2 + 4 + 30) * 1'000'000,
                                       (22 + 4 + 45) * 1'000'000}));
}

TEST(RecordedFrames, WithoutTruthTheZeroIsTheFirstArrivalOfAnyCamera) {
  const ScratchFolder folder;
  const std::string path =
      folder_of(folder, {frame(1, 0, 500), frame(0, 0, 503), frame(0, 1, 523)});
  const auto cameras = load_played_cameras(path, {recorded("a", path, "left"),  //
                                                  recorded("b", path, "1")});
  EXPECT_EQ(due(*cameras[0]), (std::vector<std::int64_t>{3'000'000, 23'000'000}));
  EXPECT_EQ(due(*cameras[1]), (std::vector<std::int64_t>{0}));
}

TEST(RecordedFrames, WhereNoPulseExposedTheZeroIsTheFirstDelivery) {
  const ScratchFolder folder;
  const std::string path =
      folder_of(folder, {true_frame(1, 0, -1, 100, 20), true_frame(0, 0, -1, 103, 30)});
  const auto cameras = load_played_cameras(path, {recorded("left", path)});
  EXPECT_EQ(due(*cameras[0]), (std::vector<std::int64_t>{13'000'000}));
}

TEST(RecordedFrames, StampsAreAsRecorded) {
  const ScratchFolder folder;
  const std::string path = folder_of(folder, {frame(0, 5, 10)});
  const PlayedFrame played = load_played_cameras(path, {recorded("left", path)})[0]->frames[0];
  EXPECT_EQ(played.counter, 5U);
  EXPECT_EQ(played.exposure_us, 8000U);
  EXPECT_EQ(played.sensor, DeviceStamp{1005});
  EXPECT_EQ(played.frame, DeviceStamp{2005});
  EXPECT_EQ(played.stream, StreamKind::kColour);
  EXPECT_EQ(played.domain, StampDomain::kGlobalTime);
  EXPECT_EQ(played.backend_lead_ns, 500'000);
}

TEST(RecordedFrames, ABackendStampOfAnotherTimeIsNone) {
  const ScratchFolder folder;
  FrameEvent without = frame(0, 5, 10'000);
  without.record.backend = HostTime{};
  const std::string path = folder_of(folder, {without});
  EXPECT_EQ(load_played_cameras(path, {recorded("left", path)})[0]->frames[0].backend_lead_ns,
            kNoBackend);
}

TEST(RecordedFrames, ACaptureIsChosenByNameAndSeed) {
  const ScratchFolder folder;
  const std::string path = folder_of(folder, {frame(0, 0, 1)}, {"both", "ntp"});
  const auto counter = [&](const std::string& recording) {
    return load_played_cameras(recording, {recorded("left", recording)})[0]->frames[0].counter;
  };
  EXPECT_EQ(counter(path), 0U);
  EXPECT_EQ(counter(path + "#both"), 0U);
  EXPECT_EQ(counter(path + "#ntp"), 100U);
  EXPECT_EQ(counter(path + "#ntp/7"), 100U);
  EXPECT_THAT([&] { counter(path + "#ntp/8"); },
              ThrowsMessage<CameraError>(AllOf(HasSubstr("camera left: "),
                                               HasSubstr("found capture 'ntp/8'"),
                                               HasSubstr("allowed both/7, ntp/7"))));
}

TEST(RecordedFrames, BadRecordingsAreOneClearError) {
  const ScratchFolder folder;
  const auto load = [](const std::string& path, const std::string& camera = "") {
    return load_played_cameras(path, {recorded("left", path, camera)});
  };
  EXPECT_THAT([&] { load(folder / "none"); },
              ThrowsMessage<CameraError>(
                  AllOf(HasSubstr("camera left: "), HasSubstr("none: no such recording"))));
  EXPECT_THAT([&] { load(folder.write("empty.csv", "")); },
              ThrowsMessage<CameraError>(
                  AllOf(HasSubstr("camera left: "), HasSubstr("empty.csv:1: the file is empty"))));
  const std::string csv = folder.write(
      "two.csv", std::string(kFramesHeader) + "Depth,0,1,10,20,a,h\nDepth,0,1,10,20,b,h\n");
  EXPECT_THAT([&] { load(csv, "c"); },
              ThrowsMessage<CameraError>(
                  HasSubstr("found recorded_camera 'c', allowed a, b or a number below 2")));
  EXPECT_THAT([&] { load(csv, "2"); }, ThrowsMessage<CameraError>(HasSubstr("'2'")));
  const std::string one = folder_of(folder, {frame(1, 0, 1)});
  EXPECT_THAT([&] { load(one); }, ThrowsMessage<CameraError>(HasSubstr("no frame of camera left")));
}

TEST(RecordedFrames, FramesWithAndWithoutTruthDoNotMix) {
  const ScratchFolder folder;
  const std::string path = folder_of(folder, {frame(0, 0, 1), true_frame(0, 1, 0, 10, 20)});
  EXPECT_THAT([&] { load_played_cameras(path, {recorded("left", path)}); },
              ThrowsMessage<CameraError>(HasSubstr("with and without truth")));
}

TEST(RecordedFrames, ACsvsDepthIsPlayedElseItsFirstInfrared) {
  const ScratchFolder folder;
  const std::string csv = folder.write(
      "a.csv", std::string(kFramesHeader) +
                   "Infrared,1,10,10,20,both,h\nDepth,0,20,10,21,both,h\nColor,0,30,10,22,both,h\n"
                   "Infrared,1,40,10,23,mono,h\nInfrared,2,50,10,24,mono,h\n");
  const auto cameras = load_played_cameras(csv, {recorded("both", csv), recorded("mono", csv)});
  ASSERT_EQ(cameras[0]->frames.size(), 2U);
  EXPECT_EQ(cameras[0]->frames[0].counter, 20U);
  EXPECT_EQ(cameras[0]->frames[0].due_ns, 1'000'000);
  EXPECT_EQ(cameras[0]->frames[1].counter, 30U);
  EXPECT_EQ(cameras[0]->frames[1].stream, StreamKind::kColour);
  ASSERT_EQ(cameras[1]->frames.size(), 1U);
  EXPECT_EQ(cameras[1]->frames[0].counter, 40U);
}

TEST(RecordedFrames, AStampBeyondTheRegisterIsWrapped) {
  const ScratchFolder folder;
  const std::string csv =
      folder.write("a.csv", std::string(kFramesHeader) + "Depth,0,1,4294968.296,20,a,h\n");
  EXPECT_EQ(load_played_cameras(csv, {recorded("a", csv)})[0]->frames[0].sensor, DeviceStamp{1000});
}

}  // namespace
}  // namespace simbench::hardware

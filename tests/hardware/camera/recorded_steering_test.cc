// Cameras that play a recording, under controls of their frames.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "hardware/camera/recorded_camera.h"
#include "recording/recording_folder.h"
#include "tests/hardware/camera/camera_values.h"
#include "tests/hardware/camera/seen_frames.h"
#include "tests/hardware/camera/steering_values.h"
#include "tests/scratch_folder.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;

constexpr std::size_t kFrames = 40;

// Frames each 4 ms from one camera.
std::string csv(const ScratchFolder& folder) {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n";
  for (std::size_t i = 0; i < kFrames; ++i) {
    text += fmt::format("Depth,0,{},{},{}\n", i, 5000 + 4 * i, 100 + 4 * i);
  }
  return folder.write("a.csv", text);
}

// A camera that is started with these settings of its steering.
struct Steered {
  Steered(const std::string& recording, const std::optional<FrameSteering>& how)
      : driver({recorded("a", recording)}), camera(driver.open("a")) {
    CameraSettings given = settings("default", {stream("depth", 90)});
    given.steering = how;
    camera->configure(given);
    steering = camera->steering();
    camera->start(seen.on_frame(), seen.on_event());
  }
  // All of them, after their end.
  std::vector<CameraFrame> frames() {
    EXPECT_TRUE(seen.wait_for_event(CameraEvent::Kind::kEnded, "the recording is over"));
    return seen.frames();
  }

  RecordedCameraDriver driver;
  std::unique_ptr<Camera> camera;
  std::shared_ptr<CameraSteering> steering;
  SeenFrames seen;
};

// Asks a camera that has played so many frames. Where that came too late, since the test was woken
// when the recording was all but over, it is played again.
template <class Ask>
std::unique_ptr<Steered> asked_while_it_plays(const std::string& recording,
                                              const FrameSteering& how, std::size_t frames,
                                              const Ask& ask) {
  constexpr std::size_t kLeft = 5;
  constexpr int kMostTries = 50;
  std::unique_ptr<Steered> steered;
  for (int i = 0; i < kMostTries; ++i) {
    steered = std::make_unique<Steered>(recording, how);
    EXPECT_TRUE(steered->seen.wait_for_frames(frames));
    ask(*steered->steering);
    if (steered->seen.frames().size() + kLeft <= kFrames) return steered;
  }
  ADD_FAILURE() << "always too late";
  return steered;
}

TEST(RecordedSteering, ACameraHasNoneUnlessItsSettingsSayHow) {
  const ScratchFolder folder;
  EXPECT_EQ(Steered(csv(folder), std::nullopt).steering, nullptr);
}

TEST(RecordedSteering, AnAdjustmentMovesAllLaterStampsAndArrivalsByTheRoundedAmount) {
  const ScratchFolder folder;
  FrameControlReply reply;
  const auto steered =
      asked_while_it_plays(csv(folder), steering_settings(2), 3, [&](CameraSteering& steering) {
        reply = steering.control(FrameControlKind::kAdjustFrame, from_us(1234));
      });
  EXPECT_EQ(reply.length, from_us(5230));
  const std::size_t after = steered->seen.frames().size();
  const std::vector<CameraFrame> frames = steered->frames();
  ASSERT_EQ(frames.size(), kFrames);
  std::vector<std::size_t> longer;
  for (std::size_t i = 1; i < kFrames; ++i) {
    const std::uint32_t length_us = frames[i].sensor.us - frames[i - 1].sensor.us;
    EXPECT_EQ(frames[i].frame, frames[i].sensor);
    EXPECT_EQ(frames[i].arrived - frames[i - 1].arrived, Microseconds(length_us));
    if (length_us == 4000) continue;
    EXPECT_EQ(length_us, 5230U);
    longer.push_back(i);
  }
  ASSERT_EQ(longer.size(), 1U);
  // Three frames were there at least, and `after` at most, when the control came.
  EXPECT_GE(longer[0], 5U);
  EXPECT_LE(longer[0], after + 2);
}

TEST(RecordedSteering, ARefusedLengthChangesNothing) {
  const ScratchFolder folder;
  FrameControlReply length, start;
  const auto steered =
      asked_while_it_plays(csv(folder), steering_settings(), 1, [&](CameraSteering& steering) {
        length = steering.control(FrameControlKind::kFrameLength, from_ms(1.9));
        start = steering.start_at(monotonic_now() + from_ms(50));
      });
  EXPECT_THAT(length.refused, HasSubstr("allowed: 2"));
  EXPECT_THAT(start.refused, HasSubstr("no control start_at"))
      << "a CSV does not say when exposures begin";
  const std::vector<CameraFrame> frames = steered->frames();
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sensor.us - frames[i - 1].sensor.us, 4000U);
  }
}

TEST(RecordedSteering, AnInsertedFrameTellsItsExposure) {
  const ScratchFolder folder;
  FrameControlReply reply;
  const auto steered =
      asked_while_it_plays(csv(folder), steering_settings(), 1, [&](CameraSteering& steering) {
        reply = steering.control(FrameControlKind::kInsertFrame, from_ms(6));
      });
  EXPECT_TRUE(reply.is_accepted());
  std::size_t inserted = 0;
  for (const CameraFrame& frame : steered->frames()) inserted += frame.exposure_us == 5990 ? 1 : 0;
  EXPECT_EQ(inserted, 1U);
}

TEST(RecordedSteering, ACameraThatDoesNotRunRefusesAndMayBeGone) {
  const ScratchFolder folder;
  std::shared_ptr<CameraSteering> kept;
  {
    Steered steered(csv(folder), steering_settings());
    kept = steered.steering;
    steered.camera->stop();
    EXPECT_THAT(kept->control(FrameControlKind::kAdjustFrame, from_ms(1)).refused,
                HasSubstr("not play"));
  }
  EXPECT_THAT(kept->start_at(monotonic_now()).refused, HasSubstr("not play"));
  EXPECT_EQ(kept->limits().latency_frames, 2U);
}

// A recording with truth: exposures of 1 ms each 4 ms, delivered 3.5 ms after their begin.
std::string recording_with_truth(const ScratchFolder& folder) {
  RecordingDescription description;
  description.backend = "sim";
  description.scenario_json = "{}";
  description.cameras = {"a"};
  RecordingWriter writer(folder / "recording", description);
  RecordingSink& sink = writer.begin("free", 1);
  RigLayout layout;
  layout.hosts = 1;
  layout.frame_rate_hz = 250;
  layout.cameras.resize(1);
  sink.on_start(layout);
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const double begin_ms = 1000 + 4.0 * i;
    FrameRecord frame;
    frame.counter = i;
    frame.sensor.us = 5'000'000 + 4000 * i;
    frame.arrival_steady = SteadyTime(from_ms(begin_ms + 3.5));
    FrameTruth truth;
    truth.pulse = i;
    truth.exposure_start = TrueTime(from_ms(begin_ms));
    truth.exposure_end = TrueTime(from_ms(begin_ms + 1));
    truth.own_steady = SteadyTime(from_ms(begin_ms + 0.5));
    sink.on_frame(frame, &truth);
  }
  writer.end({});
  return folder / "recording";
}

TEST(RecordedSteering, AStartIsTheBeginOfTheNextExposure) {
  const ScratchFolder folder;
  MonotonicTime at;
  FrameControlReply reply;
  const auto steered = asked_while_it_plays(recording_with_truth(folder), steering_settings(), 3,
                                            [&](CameraSteering& steering) {
                                              at = monotonic_now() + std::chrono::milliseconds(50);
                                              reply = steering.start_at(at);
                                            });
  EXPECT_TRUE(reply.is_accepted());
  const std::vector<CameraFrame> frames = steered->frames();
  ASSERT_EQ(frames.size(), kFrames);
  std::vector<MonotonicTime> exposed;
  for (std::size_t i = 1; i < kFrames; ++i) {
    const Nanoseconds gap = frames[i].arrived - frames[i - 1].arrived;
    EXPECT_EQ(Microseconds(frames[i].sensor.us - frames[i - 1].sensor.us),
              std::chrono::round<Microseconds>(gap));
    if (gap > from_ms(5)) exposed.push_back(frames[i].arrived - from_ms(3.5));
  }
  ASSERT_EQ(exposed.size(), 1U);
  EXPECT_EQ(exposed[0], at);
}

}  // namespace
}  // namespace simbench::hardware

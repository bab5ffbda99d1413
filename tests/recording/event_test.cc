#include "recording/event.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "recording/event_text.h"
#include "tests/recording/test_sink.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;

// Writes what it is given as lines, so that order and values can be compared.
class Transcript final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override {
    lines.push_back("start " + std::to_string(layout.cameras.size()));
  }
  void on_event(const RecordingEvent& event) override { lines.push_back(to_line(event)); }

  std::vector<std::string> lines;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    lines.push_back("frame " + std::to_string(frame.camera) + " " +
                    std::to_string(nanoseconds_of(frame.arrival)) + " " +
                    (truth != nullptr ? std::to_string(truth->pulse) : "-"));
  }
};

FrameRecord frame_of(std::uint32_t camera, std::uint32_t sensor_us, std::int64_t arrival_ns) {
  FrameRecord frame;
  frame.camera = camera;
  frame.sensor.us = sensor_us;
  frame.arrival = HostTime(Nanoseconds(arrival_ns));
  return frame;
}

void record_something(RecordingSink& sink) {
  sink.on_start({.hosts = 2, .cameras = {{0}, {1}}, .frame_rate_hz = 50});
  sink.on_event(ExchangeEvent{
      .host = 1,
      .exchange = {.peer = 0, .t1 = {}, .t2 = HostTime(Nanoseconds(7)), .t3 = {}, .t4 = {}}});
  sink.on_event(
      ClockAdjustment{.host = 1, .at = {}, .before = {}, .after = HostTime(Nanoseconds(9))});
  sink.on_event(DevicePoll{.camera = 1,
                           .device = {77},
                           .t0 = HostTime(Nanoseconds(3)),
                           .t1 = HostTime(Nanoseconds(4)),
                           .t0_steady = {},
                           .t1_steady = {}});
  sink.on_event(SyncOutcome{1, false, 200, "no answer"});
  sink.on_event(AlignmentReport{1, true, 12, "near"});
  FrameTruth truth;
  truth.pulse = 4;
  sink.on_frame(frame_of(1, 100, 2000), &truth);
  // Whoever reports pulses may change one event for the next.
  RecordingEvent pulse = PulseTruth{4, {}, {Nanoseconds(0), Nanoseconds(-5)}};
  sink.on_event(pulse);
  std::get<PulseTruth>(pulse).pulse = 5;
  std::get<PulseTruth>(pulse).host_errors[1] = Nanoseconds(6);
  sink.on_event(pulse);
  sink.on_frame(frame_of(0, 101, 1999), nullptr);
  sink.on_event(LedSighting{.camera = 0, .sensor = {101}, .led_start_ns = -2, .led_end_ns = 5});
}

TEST(KeptRecordingTest, PlaysEverythingBackInOrder) {
  KeptRecording kept;
  record_something(kept);
  Transcript played;
  kept.play(played);
  EXPECT_THAT(
      played.lines,
      ElementsAre("start 2", "exchange,1,0,,7,,", "adjustment,1,0,0,9,0", "poll,1,77,3,4,0,0",
                  "outcome,1,false,200,no answer", "alignment,1,true,12,near", "frame 1 2000 4",
                  "pulse,4,0,0;-5", "pulse,5,0,0;6", "frame 0 1999 -", "led,0,101,-2,5"));
}

TEST(KeptRecordingTest, PlaysTheSameTwice) {
  KeptRecording kept;
  record_something(kept);
  Transcript once;
  Transcript twice;
  kept.play(once);
  kept.play(twice);
  EXPECT_EQ(once.lines, twice.lines);
}

TEST(KeptRecordingTest, BeginsAnewWithTheNextCapture) {
  KeptRecording kept;
  record_something(kept);
  EXPECT_EQ(kept.events().size(), 10U);
  kept.on_start({.hosts = 1, .cameras = {{0}}, .frame_rate_hz = 50});
  EXPECT_EQ(kept.events().size(), 0U);
  EXPECT_EQ(kept.layout().cameras.size(), 1U);
}

TEST(KeptRecordingTest, KeepsABlockFrameByFrame) {
  std::vector<FrameRecord> frames(2);
  frames[1].camera = 3;
  std::vector<FrameTruth> truths(2);
  truths[1].pulse = 8;
  KeptRecording kept;
  kept.on_frames(frames, truths);
  kept.on_frames(frames, {});
  Transcript played;
  kept.play(played);
  EXPECT_THAT(played.lines,
              ElementsAre("start 0", "frame 0 0 -1", "frame 3 0 8", "frame 0 0 -", "frame 3 0 -"));
}

TEST(KeptEventTest, IsOneOfItsTypes) {
  const KeptEvent frame = FrameEvent{};
  EXPECT_NE(event_as<FrameEvent>(frame), nullptr);
  EXPECT_EQ(event_as<DevicePoll>(frame), nullptr);
  DevicePoll of_camera_4;
  of_camera_4.camera = 4;
  const KeptEvent poll = of_camera_4;
  ASSERT_NE(event_as<DevicePoll>(poll), nullptr);
  EXPECT_EQ(event_as<DevicePoll>(poll)->camera, 4U);
  EXPECT_EQ(event_as<SyncOutcome>(poll), nullptr);
  EXPECT_EQ(event_as<FrameEvent>(poll), nullptr);
}

}  // namespace
}  // namespace simbench

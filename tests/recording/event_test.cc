#include "recording/event.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace simbench {
namespace {

using ::testing::ElementsAre;

// Writes what it is given as lines, so that order and values can be compared.
class Transcript final : public RecordingSink {
 public:
  void on_start(const RigLayout& layout) override { add("start", layout.cameras.size()); }
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    add("frame", frame.camera, frame.sensor.us, nanoseconds_of(frame.arrival),
        truth != nullptr ? truth->pulse : -1);
  }
  void on_pulse(const PulseTruth& truth) override {
    add("pulse", truth.pulse, truth.host_errors[0].count(), truth.host_errors[1].count());
  }
  void on_adjustment(const ClockAdjustment& adjustment) override {
    add("adjustment", adjustment.host, nanoseconds_of(adjustment.after));
  }
  void on_poll(const DevicePoll& poll) override {
    add("poll", poll.camera, poll.device.us, nanoseconds_of(poll.t0), nanoseconds_of(poll.t1));
  }
  void on_exchange(std::uint32_t host, const Exchange& exchange) override {
    add("exchange", host, exchange.peer, exchange.t1 ? "t1" : "", exchange.t2 ? "t2" : "");
  }
  void on_outcome(const SyncOutcome& outcome) override { add("outcome", outcome.message); }
  void on_alignment(const AlignmentReport& report) override {
    add("alignment", report.camera, report.aligned, report.controls, report.message);
  }
  void on_led_sighting(const LedSighting& sighting) override {
    add("led", sighting.camera, sighting.sensor.us, sighting.led_start_ns, sighting.led_end_ns);
  }

  std::vector<std::string> lines;

 private:
  template <class... Values>
  void add(const Values&... values) {
    std::ostringstream line;
    ((line << values << ' '), ...);
    lines.push_back(line.str());
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
  sink.on_exchange(1, {.peer = 0, .t1 = {}, .t2 = HostTime(Nanoseconds(7)), .t3 = {}, .t4 = {}});
  sink.on_adjustment({.host = 1, .at = {}, .before = {}, .after = HostTime(Nanoseconds(9))});
  sink.on_poll({.camera = 1,
                .device = {77},
                .t0 = HostTime(Nanoseconds(3)),
                .t1 = HostTime(Nanoseconds(4)),
                .t0_steady = {},
                .t1_steady = {}});
  sink.on_outcome({.slave = 1, .synchronised = false, .passes = 200, .message = "no answer"});
  sink.on_alignment({.camera = 1, .aligned = true, .controls = 12, .message = "near"});
  FrameTruth truth;
  truth.pulse = 4;
  sink.on_frame(frame_of(1, 100, 2000), &truth);
  // A sink may reuse the memory of the errors for the next pulse.
  std::vector<Nanoseconds> errors = {Nanoseconds(0), Nanoseconds(-5)};
  sink.on_pulse({.pulse = 4, .at = {}, .host_errors = errors});
  errors[1] = Nanoseconds(6);
  sink.on_pulse({.pulse = 5, .at = {}, .host_errors = errors});
  sink.on_frame(frame_of(0, 101, 1999), nullptr);
  sink.on_led_sighting({.camera = 0, .sensor = {101}, .led_start_ns = -2, .led_end_ns = 5});
}

TEST(KeptRecordingTest, PlaysEverythingBackInOrder) {
  KeptRecording kept;
  record_something(kept);
  Transcript played;
  kept.play(played);
  EXPECT_THAT(
      played.lines,
      ElementsAre("start 2 ", "exchange 1 0  t2 ", "adjustment 1 9 ", "poll 1 77 3 4 ",
                  "outcome no answer ", "alignment 1 1 12 near ", "frame 1 100 2000 4 ",
                  "pulse 4 0 -5 ", "pulse 5 0 6 ", "frame 0 101 1999 -1 ", "led 0 101 -2 5 "));
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

TEST(RecordingSinkTest, TakesABlockFrameByFrame) {
  std::vector<FrameRecord> frames(2);
  frames[1].camera = 3;
  std::vector<FrameTruth> truths(2);
  truths[1].pulse = 8;
  Transcript simulated;
  simulated.on_frames(frames, truths);
  EXPECT_THAT(simulated.lines, ElementsAre("frame 0 0 0 -1 ", "frame 3 0 0 8 "));
  Transcript of_a_rig;
  of_a_rig.on_frames(frames, {});
  EXPECT_THAT(of_a_rig.lines, ElementsAre("frame 0 0 0 -1 ", "frame 3 0 0 -1 "));
}

}  // namespace
}  // namespace simbench

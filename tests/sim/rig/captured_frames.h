// Runs a capture by itself and keeps its frames.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "sim/rig/capture.h"
#include "tests/recording/test_sink.h"

namespace simbench::sim {

// Keeps what a capture hands over, in the simplest form.
class CapturedFrames final : public TestSink {
 public:
  struct Frame {
    FrameRecord record;
    FrameTruth truth;
  };
  void on_start(const RigLayout& layout) override { layout_ = layout; }
  void on_event(const RecordingEvent& event) override {
    if (const auto* pulse = std::get_if<PulseTruth>(&event)) pulses.push_back(pulse->pulse);
  }

  std::vector<Frame> of(std::uint32_t camera, StreamKind kind = StreamKind::kDepth) const {
    std::vector<Frame> found;
    for (const Frame& f : frames) {
      if (f.record.camera == camera && f.record.stream == kind) found.push_back(f);
    }
    return found;
  }
  const RigLayout& layout() const { return layout_; }

  std::vector<Frame> frames;
  std::vector<std::int64_t> pulses;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    frames.push_back({frame, *truth});
  }

  RigLayout layout_;
};

// Runs a capture that starts at true zero, with exact host clocks.
inline CapturedFrames capture(const scenarios::Scenario& scenario, std::uint64_t seed = 1) {
  Engine engine;
  std::vector<std::unique_ptr<SystemClock>> clocks;
  std::vector<SystemClock*> views;
  for (std::uint32_t host = 0; host < static_cast<std::uint32_t>(scenario.hosts.count); ++host) {
    clocks.push_back(std::make_unique<SystemClock>(host, OscillatorModel(0.0)));
    views.push_back(clocks.back().get());
  }
  CapturedFrames frames;
  Outages outages(scenario.faults);
  outages.start(TrueTime{});
  Capture capture(scenario, engine, views, outages, CaptureReports(frames));
  frames.on_start(capture.layout());
  CameraWorld world(scenario, seed);
  CameraStamps stamps(scenario, world, TrueTime{});
  bool ended = false;
  capture.start(world, stamps, [&] { ended = true; });
  engine.run();
  EXPECT_TRUE(ended);
  return frames;
}

inline double host_ms_of(HostTime t) { return to_ms(t.time_since_epoch()); }

}  // namespace simbench::sim

// A sink that ignores whatever a test does not override.
#pragma once

#include <span>

#include "recording/recording.h"

namespace simbench {

class TestSink : public RecordingSink {
 public:
  void on_start(const RigLayout& /*layout*/) override {}
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) final {
    for_each_frame(frames, truths, [this](const FrameRecord& frame, const FrameTruth* truth) {
      frame_came(frame, truth);
    });
  }
  void on_event(const RecordingEvent& /*event*/) override {}

 protected:
  virtual void frame_came(const FrameRecord& /*frame*/, const FrameTruth* /*truth*/) {}
};

}  // namespace simbench

// A recording as text, with all that is in it and in its order: for comparing whole recordings.
#pragma once

#include <fmt/format.h>

#include <string>

#include "recording/event_text.h"
#include "tests/recording/test_sink.h"

namespace simbench::sim {

class WrittenRecording final : public TestSink {
 public:
  void on_start(const RigLayout& layout) override {
    text += fmt::format("start {} {} {} {} {}\n", layout.hosts, layout.cameras.size(),
                        layout.frame_rate_hz, layout.first_pulse, layout.pulses);
  }
  void on_event(const RecordingEvent& event) override {
    append_event(text, event);
    text += '\n';
  }

  std::string text;

 private:
  void frame_came(const FrameRecord& frame, const FrameTruth* truth) override {
    append_frame(text, frame);
    append_truth(text, *truth);
    text += '\n';
  }
};

}  // namespace simbench::sim

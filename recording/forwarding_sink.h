// A sink that passes everything on, as a base of sinks that change or watch some of it.
//
//   class WithoutPolls final : public ForwardingSink {
//    public:
//     using ForwardingSink::ForwardingSink;
//     void on_event(const RecordingEvent& event) override {
//       if (!std::holds_alternative<DevicePoll>(event)) sink().on_event(event);
//     }
//   };
#pragma once

#include <span>

#include "recording/recording.h"

namespace simbench {

class ForwardingSink : public RecordingSink {
 public:
  // `sink` must outlive this.
  explicit ForwardingSink(RecordingSink& sink) : sink_(sink) {}

  void on_start(const RigLayout& layout) override { sink_.on_start(layout); }
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    sink_.on_frames(frames, truths);
  }
  void on_event(const RecordingEvent& event) override { sink_.on_event(event); }

 protected:
  RecordingSink& sink() { return sink_; }

 private:
  RecordingSink& sink_;
};

}  // namespace simbench

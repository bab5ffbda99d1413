// A sink that passes everything on, as a base of sinks that change or watch some of it.
//
// A block of frames passes one by one through on_frame(), so that a sink which overrides that alone
// misses none. One that can take a block overrides on_frames() too.
//
//   class Doubled final : public ForwardingSink {
//    public:
//     using ForwardingSink::ForwardingSink;
//     void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
//       sink().on_frame(frame, truth);
//       sink().on_frame(frame, truth);
//     }
//   };
#ifndef SIMBENCH_RECORDING_FORWARDING_SINK_H_
#define SIMBENCH_RECORDING_FORWARDING_SINK_H_

#include <cstdint>

#include "recording/recording.h"

namespace simbench {

class ForwardingSink : public RecordingSink {
 public:
  // `sink` must outlive this.
  explicit ForwardingSink(RecordingSink& sink) : sink_(sink) {}

  void on_start(const RigLayout& layout) override { sink_.on_start(layout); }
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    sink_.on_frame(frame, truth);
  }
  void on_pulse(const PulseTruth& truth) override { sink_.on_pulse(truth); }
  void on_adjustment(const ClockAdjustment& adjustment) override {
    sink_.on_adjustment(adjustment);
  }
  void on_poll(const DevicePoll& poll) override { sink_.on_poll(poll); }
  void on_exchange(std::uint32_t host, const Exchange& exchange) override {
    sink_.on_exchange(host, exchange);
  }
  void on_outcome(const SyncOutcome& outcome) override { sink_.on_outcome(outcome); }
  void on_alignment(const AlignmentReport& report) override { sink_.on_alignment(report); }
  void on_led_sighting(const LedSighting& sighting) override { sink_.on_led_sighting(sighting); }

 protected:
  RecordingSink& sink() { return sink_; }

 private:
  RecordingSink& sink_;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_FORWARDING_SINK_H_

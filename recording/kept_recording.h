// A recording held in memory, to be played again as often as needed.
//
// Keeps everything a backend hands over and gives it back in the same order, across all kinds of
// events; truth is given back where there was truth. About 110 bytes a frame: for captures of many
// cameras, score the stream itself instead of keeping it.
//
//   KeptRecording kept;
//   source.record(request, kept);
//   kept.play(first_scorer);
//   kept.play(second_scorer);
#ifndef SIMBENCH_RECORDING_KEPT_RECORDING_H_
#define SIMBENCH_RECORDING_KEPT_RECORDING_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recording/event.h"

namespace simbench {

class KeptRecording final : public RecordingSink {
 public:
  // Begins anew: what was kept before is forgotten.
  void on_start(const RigLayout& layout) override;
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override;
  void on_pulse(const PulseTruth& truth) override;
  void on_adjustment(const ClockAdjustment& adjustment) override;
  void on_poll(const DevicePoll& poll) override;
  void on_exchange(std::uint32_t host, const Exchange& exchange) override;
  void on_outcome(const SyncOutcome& outcome) override;

  // The same calls with the same values in the same order, on_start first.
  void play(RecordingSink& sink) const;

  const RigLayout& layout() const { return layout_; }
  const std::vector<RecordingEvent>& events() const { return events_; }

 private:
  RigLayout layout_;
  std::vector<RecordingEvent> events_;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_KEPT_RECORDING_H_

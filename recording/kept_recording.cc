#include "recording/kept_recording.h"

namespace simbench {

void KeptRecording::on_start(const RigLayout& layout) {
  layout_ = layout;
  events_.clear();
}

void KeptRecording::on_frame(const FrameRecord& frame, const FrameTruth* truth) {
  events_.emplace_back(
      FrameEvent{frame, truth != nullptr ? std::optional<FrameTruth>(*truth) : std::nullopt});
}

void KeptRecording::on_pulse(const PulseTruth& truth) {
  events_.emplace_back(
      PulseEvent{truth.pulse, truth.at, {truth.host_errors.begin(), truth.host_errors.end()}});
}

void KeptRecording::on_adjustment(const ClockAdjustment& adjustment) {
  events_.emplace_back(adjustment);
}

void KeptRecording::on_poll(const DevicePoll& poll) { events_.emplace_back(poll); }

void KeptRecording::on_exchange(std::uint32_t host, const Exchange& exchange) {
  events_.emplace_back(ExchangeEvent{host, exchange});
}

void KeptRecording::on_outcome(const SyncOutcome& outcome) { events_.emplace_back(outcome); }

void KeptRecording::play(RecordingSink& sink) const {
  sink.on_start(layout_);
  for (const RecordingEvent& event : events_) tell(event, sink);
}

}  // namespace simbench

#include "recording/kept_recording.h"

namespace simbench {

void KeptRecording::on_start(const RigLayout& layout) {
  layout_ = layout;
  events_.clear();
}

void KeptRecording::on_frame(const FrameRecord& frame, const FrameTruth* truth) {
  events_.emplace_back(
      Frame{frame, truth != nullptr ? std::optional<FrameTruth>(*truth) : std::nullopt});
}

void KeptRecording::on_pulse(const PulseTruth& truth) {
  events_.emplace_back(
      Pulse{truth.pulse, truth.at, {truth.host_errors.begin(), truth.host_errors.end()}});
}

void KeptRecording::on_adjustment(const ClockAdjustment& adjustment) {
  events_.emplace_back(adjustment);
}

void KeptRecording::on_poll(const DevicePoll& poll) { events_.emplace_back(poll); }

void KeptRecording::on_exchange(std::uint32_t host, const Exchange& exchange) {
  events_.emplace_back(HostExchange{host, exchange});
}

void KeptRecording::on_outcome(const SyncOutcome& outcome) { events_.emplace_back(outcome); }

void KeptRecording::play(RecordingSink& sink) const {
  sink.on_start(layout_);
  for (const Event& event : events_) {
    std::visit([&sink](const auto& kept) { give(kept, sink); }, event);
  }
}

void KeptRecording::give(const Frame& frame, RecordingSink& sink) {
  sink.on_frame(frame.record, frame.truth ? &*frame.truth : nullptr);
}

void KeptRecording::give(const Pulse& pulse, RecordingSink& sink) {
  sink.on_pulse({pulse.pulse, pulse.at, pulse.host_errors});
}

void KeptRecording::give(const ClockAdjustment& adjustment, RecordingSink& sink) {
  sink.on_adjustment(adjustment);
}

void KeptRecording::give(const DevicePoll& poll, RecordingSink& sink) { sink.on_poll(poll); }

void KeptRecording::give(const HostExchange& exchange, RecordingSink& sink) {
  sink.on_exchange(exchange.host, exchange.exchange);
}

void KeptRecording::give(const SyncOutcome& outcome, RecordingSink& sink) {
  sink.on_outcome(outcome);
}

}  // namespace simbench

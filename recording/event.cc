#include "recording/event.h"

namespace simbench {
namespace {

struct Notifier {
  RecordingSink& sink;
  void operator()(const FrameEvent& frame) const {
    sink.on_frame(frame.record, frame.truth ? &*frame.truth : nullptr);
  }
  void operator()(const PulseEvent& pulse) const {
    sink.on_pulse({pulse.pulse, pulse.at, pulse.host_errors});
  }
  void operator()(const ClockAdjustment& adjustment) const { sink.on_adjustment(adjustment); }
  void operator()(const DevicePoll& poll) const { sink.on_poll(poll); }
  void operator()(const ExchangeEvent& exchange) const {
    sink.on_exchange(exchange.host, exchange.exchange);
  }
  void operator()(const SyncOutcome& outcome) const { sink.on_outcome(outcome); }
  void operator()(const AlignmentReport& report) const { sink.on_alignment(report); }
  void operator()(const LedSighting& sighting) const { sink.on_led_sighting(sighting); }
};

}  // namespace

void notify(const RecordingEvent& event, RecordingSink& sink) { std::visit(Notifier{sink}, event); }

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

void KeptRecording::on_alignment(const AlignmentReport& report) { events_.emplace_back(report); }

void KeptRecording::on_led_sighting(const LedSighting& sighting) { events_.emplace_back(sighting); }

void KeptRecording::play(RecordingSink& sink) const {
  sink.on_start(layout_);
  for (const RecordingEvent& event : events_) notify(event, sink);
}

}  // namespace simbench

#include "recording/event.h"

namespace simbench {
namespace {

struct Teller {
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
};

}  // namespace

void tell(const RecordingEvent& event, RecordingSink& sink) { std::visit(Teller{sink}, event); }

}  // namespace simbench

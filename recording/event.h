// The events of a recording as values, a type for each call of a RecordingSink.
//
// A frame or a pulse has truth only if it was simulated (or measured where truth is known).
//
//   RecordingEvent event = FrameEvent{record, truth};
//   notify(event, sink);
//
//   KeptRecording kept;
//   source.record(request, kept);
//   kept.play(first_scorer);
//   kept.play(second_scorer);
#ifndef SIMBENCH_RECORDING_EVENT_H_
#define SIMBENCH_RECORDING_EVENT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "recording/recording.h"

namespace simbench {

struct FrameEvent {
  FrameRecord record;
  std::optional<FrameTruth> truth;
};

struct PulseEvent {
  std::int64_t pulse = 0;
  TrueTime at{};
  std::vector<Nanoseconds> host_errors;
};

struct ExchangeEvent {
  std::uint32_t host = 0;
  Exchange exchange;
};

using RecordingEvent = std::variant<FrameEvent, PulseEvent, ClockAdjustment, DevicePoll,
                                    ExchangeEvent, SyncOutcome, AlignmentReport, LedSighting>;

// Calls the member of `sink` for this event.
void notify(const RecordingEvent& event, RecordingSink& sink);

// Keeps a whole recording in memory and plays it as often as needed, in the same order across all
// kinds of events. About 110 bytes a frame: for captures of many cameras, score the stream itself
// instead of keeping it.
class KeptRecording final : public RecordingSink {
 public:
  // Discards what was kept before.
  void on_start(const RigLayout& layout) override;
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override;
  void on_pulse(const PulseTruth& truth) override;
  void on_adjustment(const ClockAdjustment& adjustment) override;
  void on_poll(const DevicePoll& poll) override;
  void on_exchange(std::uint32_t host, const Exchange& exchange) override;
  void on_outcome(const SyncOutcome& outcome) override;
  void on_alignment(const AlignmentReport& report) override;
  void on_led_sighting(const LedSighting& sighting) override;

  // The same calls with the same values in the same order, on_start first.
  void play(RecordingSink& sink) const;

  const RigLayout& layout() const { return layout_; }
  const std::vector<RecordingEvent>& events() const { return events_; }

 private:
  RigLayout layout_;
  std::vector<RecordingEvent> events_;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_EVENT_H_

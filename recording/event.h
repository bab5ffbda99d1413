// The events of a recording as values: what a RecordingSink is told, one type each.
//
// A frame or a pulse has truth only if it was simulated (or measured where truth is known).
//
//   RecordingEvent event = FrameEvent{record, truth};
//   tell(event, sink);
#ifndef SIMBENCH_RECORDING_EVENT_H_
#define SIMBENCH_RECORDING_EVENT_H_

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

using RecordingEvent =
    std::variant<FrameEvent, PulseEvent, ClockAdjustment, DevicePoll, ExchangeEvent, SyncOutcome>;

// Calls the member of `sink` that is for this event.
void tell(const RecordingEvent& event, RecordingSink& sink);

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_EVENT_H_

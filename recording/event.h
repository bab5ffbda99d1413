// A recording as values: each frame, with its truth, and each other event, in one order.
//
//   KeptRecording kept;
//   source.record(request, kept);
//   kept.play(first_scorer);
//   kept.play(second_scorer);
//
//   for (const KeptEvent& event : kept.events()) {
//     if (const auto* poll = event_as<DevicePoll>(event)) sink.on_event(*poll);
//   }
#pragma once

#include <optional>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "recording/recording.h"

namespace simbench {

// A frame has truth only if it was simulated (or measured where truth is known).
struct FrameEvent {
  FrameRecord record;
  std::optional<FrameTruth> truth;
};

using KeptEvent = std::variant<FrameEvent, RecordingEvent>;

// The event as one of a type, FrameEvent or one of RecordingEvent; null if it is another.
template <class Event>
const Event* event_as(const KeptEvent& event) {
  if constexpr (std::is_same_v<Event, FrameEvent>) {
    return std::get_if<FrameEvent>(&event);
  } else {
    const auto* other = std::get_if<RecordingEvent>(&event);
    return other != nullptr ? std::get_if<Event>(other) : nullptr;
  }
}

// Hands the event to `sink`, a frame as a block of one.
void notify(const KeptEvent& event, RecordingSink& sink);

// Keeps a whole recording in memory and plays it as often as needed, in the same order across all
// kinds of events. About 120 bytes a frame: for captures of many cameras, score the stream itself
// instead of keeping it.
class KeptRecording final : public RecordingSink {
 public:
  // Discards what was kept before.
  void on_start(const RigLayout& layout) override;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override { events_.emplace_back(event); }

  // The same frames and events with the same values in the same order, on_start first.
  void play(RecordingSink& sink) const;

  const RigLayout& layout() const { return layout_; }
  const std::vector<KeptEvent>& events() const { return events_; }

 private:
  RigLayout layout_;
  std::vector<KeptEvent> events_;
};

}  // namespace simbench

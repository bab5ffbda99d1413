#include "recording/event.h"

namespace simbench {

void notify(const KeptEvent& event, RecordingSink& sink) {
  if (const auto* frame = std::get_if<FrameEvent>(&event)) {
    sink.on_frame(frame->record, frame->truth ? &*frame->truth : nullptr);
  } else {
    sink.on_event(std::get<RecordingEvent>(event));
  }
}

void KeptRecording::on_start(const RigLayout& layout) {
  layout_ = layout;
  events_.clear();
}

void KeptRecording::on_frames(std::span<const FrameRecord> frames,
                              std::span<const FrameTruth> truths) {
  for_each_frame(frames, truths, [this](const FrameRecord& frame, const FrameTruth* truth) {
    events_.emplace_back(
        FrameEvent{frame, truth != nullptr ? std::optional<FrameTruth>(*truth) : std::nullopt});
  });
}

void KeptRecording::play(RecordingSink& sink) const {
  sink.on_start(layout_);
  for (const KeptEvent& event : events_) notify(event, sink);
}

}  // namespace simbench

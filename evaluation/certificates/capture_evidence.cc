#include "evaluation/certificates/capture_evidence.h"

#include <variant>

namespace simbench::evaluation {

CaptureEvidence::CaptureEvidence(const Assumptions& assumptions, StreamKind stream)
    : assumptions_(assumptions), stream_(stream) {}

void CaptureEvidence::on_start(const RigLayout& layout) {
  layout_ = layout;
  registers_.assign(layout.cameras.size(), {});
  std::optional<Nanoseconds> estimate_error;
  if (assumptions_.estimated_stamp_ms) estimate_error = from_ms(*assumptions_.estimated_stamp_ms);
  facts_.emplace(layout.hosts, from_ms(assumptions_.host_stamp_ms), estimate_error);
}

void CaptureEvidence::on_frames(std::span<const FrameRecord> frames,
                                std::span<const FrameTruth> truths) {
  for_each_frame(frames, truths, [&](const FrameRecord& frame, const FrameTruth* truth) {
    const DeviceTime sensor = registers_[frame.camera].unwrap(frame.sensor);
    if (frame.stream != stream_) return;
    FrameEvidence& kept = frames_.emplace_back();
    kept.camera = frame.camera;
    kept.exposure_us = frame.exposure_us;
    kept.sensor = sensor;
    kept.arrival = frame.arrival_steady;
    if (truth != nullptr) kept.truth = truth->mid_exposure();
  });
}

void CaptureEvidence::on_event(const RecordingEvent& event) {
  std::visit(
      Overloaded{
          [&](const ClockAdjustment& adjustment) { facts_->add(adjustment); },
          [&](const DevicePoll& poll) {
            polls_.push_back({poll.camera, registers_[poll.camera].unwrap(poll.device),
                              poll.t0_steady, poll.t1_steady});
          },
          [&](const ExchangeEvent& reported) { add_exchange(reported.host, reported.exchange); },
          [](const auto&) {}},
      event);
}

void CaptureEvidence::add_exchange(std::uint32_t host, const Exchange& exchange) {
  const ExchangeMessages found = facts_->messages_of(host, exchange);
  unusable_messages_ += found.unusable;
  if (found.is_left_out) ++estimated_exchanges_;
  for (const std::optional<HostMessage>& message : found.usable) {
    if (message) messages_.push_back(*message);
  }
}

}  // namespace simbench::evaluation

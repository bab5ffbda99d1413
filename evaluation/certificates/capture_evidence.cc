#include "evaluation/certificates/capture_evidence.h"

#include <variant>

namespace simbench::evaluation {

CaptureEvidence::CaptureEvidence(const Assumptions& assumptions, StreamKind stream)
    : assumptions_(assumptions), stream_(stream) {}

void CaptureEvidence::on_start(const RigLayout& layout) {
  layout_ = layout;
  registers_.assign(layout.cameras.size(), {});
  readings_.assign(layout.hosts, {});
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
          [&](const ClockAdjustment& adjustment) { readings_[adjustment.host].add(adjustment); },
          [&](const DevicePoll& poll) {
            polls_.push_back({poll.camera, registers_[poll.camera].unwrap(poll.device),
                              poll.t0_steady, poll.t1_steady});
          },
          [&](const ExchangeEvent& reported) { add_exchange(reported.host, reported.exchange); },
          [](const auto&) {}},
      event);
}

// Between t1 and t4 the peer may have told but one of its two stamps, which then stands for both.
void CaptureEvidence::add_exchange(std::uint32_t host, const Exchange& exchange) {
  const std::optional<HostTime>& came = exchange.t2 ? exchange.t2 : exchange.t3;
  const std::optional<HostTime>& left = exchange.t3 ? exchange.t3 : exchange.t2;
  add_message(host, exchange.t1, exchange.peer, came);
  add_message(exchange.peer, left, host, exchange.t4);
}

void CaptureEvidence::add_message(std::uint32_t from, const std::optional<HostTime>& sent,
                                  std::uint32_t to, const std::optional<HostTime>& received) {
  if (!sent || !received) return;
  const Nanoseconds error = from_ms(assumptions_.host_stamp_ms);
  const auto left = readings_[from].when(*sent - error, *sent + error);
  const auto came = readings_[to].when(*received - error, *received + error);
  if (!left || !came) {
    ++unusable_messages_;
    return;
  }
  messages_.push_back({from, to, left->first, came->last});
}

}  // namespace simbench::evaluation

// What a capture tells a WorldObserver of its frames; the rest of it is in capture.cc.
#include "sim/rig/capture.h"

namespace simbench::sim {

void Capture::tell_lost(const Stream& stream, std::uint32_t counter,
                        const Exposure& exposure) const {
  if (observer_ == nullptr) return;
  observer_->on_frame({.camera = stream.camera,
                       .host = stream.host,
                       .stream = stream.kind,
                       .counter = counter,
                       .pulse = exposure.pulse,
                       .fate = FrameFate::kLostInCamera,
                       .exposure_start = exposure.start,
                       .exposure_end = exposure.end});
}

// The frame's way ends now.
void Capture::tell(const FrameInFlight& frame, FrameFate fate) const {
  if (observer_ == nullptr) return;
  const Stream& stream = streams_[frame.stream];
  ObservedFrame told = {.camera = stream.camera,
                        .host = stream.host,
                        .stream = stream.kind,
                        .counter = frame.record.counter,
                        .pulse = frame.truth.pulse,
                        .fate = fate,
                        .exposure_start = frame.truth.exposure_start,
                        .exposure_end = frame.truth.exposure_end,
                        .offered = frame.offered};
  if (fate == FrameFate::kDelivered) {
    told.transferred = frame.transferred;
    told.copied = frame.copied;
    told.delivered = engine_.now();
  }
  observer_->on_frame(told);
}

}  // namespace simbench::sim

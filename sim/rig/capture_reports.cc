#include "sim/rig/capture_reports.h"

#include "sim/host/host_group.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

ObservedFrame observed_frame(const CameraFrame& frame, Nanoseconds shift) {
  ObservedFrame observed{.camera = frame.camera,
                         .host = frame.host,
                         .stream = frame.kind,
                         .counter = frame.counter,
                         .pulse = frame.pulse,
                         .fate = frame.fate,
                         .exposure_start = frame.exposure_start + shift,
                         .exposure_end = frame.exposure_end + shift};
  if (frame.fate == FrameFate::kLostInCamera) return observed;
  observed.offered = frame.offered + shift;
  if (frame.fate == FrameFate::kLostOnUsb) return observed;
  observed.transferred = frame.transferred + shift;
  observed.copied = frame.copied + shift;
  observed.delivered = frame.at + shift;
  return observed;
}

}  // namespace

FrameFeeds::FrameFeeds(const scenarios::Scenario& scenario, HostGroup& hosts)
    : hosts_(hosts),
      scored_(scenario.evaluation.stream),
      traffic_share_(scenario.network.capture_traffic_share) {}

bool FrameFeeds::is_open() const { return hosts_.frames().is_open(); }

bool FrameFeeds::is_awaited() const {
  if (!is_open()) return false;
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    const SimFrameFeed* feed = hosts_.host(host).opened_frame_feed();
    if (feed != nullptr && feed->is_awaited()) return true;
  }
  return false;
}

void FrameFeeds::on_delivery(const FrameRecord& record, const CameraStream& stream, TrueTime at) {
  if (has_traffic()) {
    hosts_.network().send_capture_traffic(stream.host, traffic_share_ * stream.bytes, at);
  }
  if (record.stream != scored_) return;
  SimFrameFeed* feed = hosts_.host(stream.host).opened_frame_feed();
  if (feed == nullptr) return;
  feed->push({.camera = record.camera,
              .counter = record.counter,
              .exposure_us = record.exposure_us,
              .sensor = record.sensor,
              .arrival = record.arrival,
              .arrival_steady = record.arrival_steady});
}

void CaptureReports::start(TrueTime at) const {
  if (observer_ != nullptr) observer_->on_capture_start(at);
}

void CaptureReports::pulse(std::int64_t slot, TrueTime at) const {
  if (observer_ == nullptr) return;
  observer_->sample_until(at);
  observer_->on_pulse({.pulse = slot, .at = at});
}

void CaptureReports::observed(const CameraFrame& frame, Nanoseconds shift) const {
  if (observer_ == nullptr) return;
  observer_->sample_until(frame.at + shift);
  observer_->on_frame(observed_frame(frame, shift));
}

}  // namespace simbench::sim

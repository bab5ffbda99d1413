#include "sim/rig/capture_reports.h"

#include "sim/host/host_group.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

ObservedFrame observed(const CapturedFrame& frame) {
  return {.camera = frame.record.camera,
          .host = frame.host,
          .stream = frame.record.stream,
          .counter = frame.record.counter,
          .pulse = frame.truth.pulse,
          .fate = frame.fate,
          .exposure_start = frame.truth.exposure_start,
          .exposure_end = frame.truth.exposure_end,
          .offered = frame.offered,
          .transferred = frame.transferred,
          .copied = frame.copied,
          .delivered = frame.delivered};
}

}  // namespace

FrameFeeds::FrameFeeds(const scenarios::Scenario& scenario, HostGroup& hosts)
    : hosts_(hosts),
      scored_(scenario.evaluation.stream),
      traffic_share_(scenario.network.capture_traffic_share) {}

void FrameFeeds::on_delivery(const CapturedFrame& frame) {
  if (traffic_share_ > 0) {
    hosts_.network().send_capture_traffic(frame.host, traffic_share_ * frame.bytes);
  }
  const FrameRecord& record = frame.record;
  if (record.stream != scored_) return;
  SimFrameFeed* feed = hosts_.host(frame.host).opened_frame_feed();
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
  if (observer_ != nullptr) observer_->on_pulse({.pulse = slot, .at = at});
}

void CaptureReports::frame(const CapturedFrame& frame) const {
  if (frame.fate == FrameFate::kDelivered) {
    sink_.on_frame(frame.record, &frame.truth);
    if (feeds_ != nullptr) feeds_->on_delivery(frame);
  }
  if (observer_ != nullptr) observer_->on_frame(observed(frame));
}

}  // namespace simbench::sim

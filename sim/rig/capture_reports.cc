#include "sim/rig/capture_reports.h"

#include "sim/host/host_group.h"
#include "sim/host/sim_frame_control.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

ObservedFrame observed_frame(const SimFrame& frame, Nanoseconds shift) {
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
      traffic_share_(scenario.network.capture_traffic_share),
      stamps_on_host_(scenario.cameras.stamp_clock == scenarios::ClockOwner::kHost) {}

bool FrameFeeds::is_open() const { return hosts_.frames().is_open(); }

bool FrameFeeds::is_awaited() const {
  if (!is_open()) return false;
  for (std::size_t host = 0; host < hosts_.size(); ++host) {
    if (hosts_.host(host).awaits_frame()) return true;
  }
  return false;
}

void FrameFeeds::on_delivery(const FrameRecord& record, const SimStream& stream, TrueTime at) {
  if (has_traffic()) {
    hosts_.network().send_capture_traffic(stream.host, traffic_share_ * stream.bytes, at);
  }
  if (record.stream != scored_) return;
  SimHost& host = hosts_.host(stream.host);
  SimFrameFeed* const feed = host.opened_frame_feed();
  SimFrameControl* const control = host.frame_control(record.camera);
  if (feed == nullptr && control == nullptr) return;
  FrameArrival frame{.camera = record.camera,
                     .counter = record.counter,
                     .exposure_us = record.exposure_us,
                     .sensor = record.sensor,
                     .arrival = record.arrival,
                     .arrival_steady = record.arrival_steady};
  if (stamps_on_host_) frame.sensor_steady = steady_of(record.sensor, record.arrival_steady);
  if (feed != nullptr) feed->push(frame);
  if (control != nullptr) control->push(frame);
}

void FrameFeeds::on_poll(const DevicePoll& poll, std::uint32_t host) {
  if (!is_open()) return;
  SimFrameControl* const control = hosts_.host(host).frame_control(poll.camera);
  if (control == nullptr) return;
  control->read_clock(
      {.device = poll.device, .t0_steady = poll.t0_steady, .t1_steady = poll.t1_steady});
}

void CaptureReports::start(TrueTime at) const {
  if (observer_ != nullptr) observer_->on_capture_start(at);
}

void CaptureReports::pulse(std::int64_t slot, TrueTime at) const {
  if (observer_ == nullptr) return;
  observer_->sample_until(at);
  observer_->on_pulse({.pulse = slot, .at = at});
}

void CaptureReports::observed(const SimFrame& frame, Nanoseconds shift) const {
  if (observer_ == nullptr) return;
  observer_->sample_until(frame.at + shift);
  observer_->on_frame(observed_frame(frame, shift));
}

}  // namespace simbench::sim

#include "sim/rig/capture.h"

#include <algorithm>
#include <cmath>

#include "sim/clock/clock_interface.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kLateFrame("host: late delivery of a frame");

}  // namespace

void Capture::handle(const Event& event) {
  switch (event.kind) {
    case kPulse:
      return on_pulse(event.subject);
    case kShutterTimer:
      return on_shutter_timer(event.subject);
    case kReadout:
      return on_readout(event.subject);
    case kTransferDone:
      return on_transfer_done(event.subject);
    case kDelivery:
      return on_delivery(event.subject);
    case kFault:
      return on_fault(scenario_.faults[event.subject]);
    default:
      pulses_over_ = true;
      return end_if_done();
  }
}

// Schedules the event of `slot`; a slot without a pulse still has one, which keeps the chain going.
void Capture::schedule_pulse(std::int64_t slot) {
  const TrueTime at = trigger_.pulse(slot).value_or(trigger_.due(slot));
  engine_.schedule(std::max(at, engine_.now()), id_, kPulse, static_cast<std::uint32_t>(slot));
}

void Capture::on_pulse(std::int64_t slot) {
  if (trigger_.pulse(slot)) {
    if (slot >= first_slot_) report_pulse(slot);
    const TrueTime now = engine_.now();
    if (observer_ != nullptr) observer_->on_pulse({.pulse = slot, .at = now});
    for (const std::uint32_t id : triggered_streams_) {
      Stream& stream = streams_[id];
      const TrueTime at_camera = now + trigger_.delay_to(stream.camera);
      stream.shutter.set_exposure(exposures_[stream.camera].at(at_camera));
      const auto exposure = stream.shutter.on_pulse(at_camera, slot);
      if (exposure) expose(id, *exposure);
    }
  }
  if (slot < last_slot_) schedule_pulse(slot + 1);
}

void Capture::report_pulse(std::int64_t slot) {
  const TrueTime now = engine_.now();
  const HostTime master = clocks_[0]->read(now);
  for (std::size_t host = 0; host < clocks_.size(); ++host) {
    host_errors_[host] = clocks_[host]->read(now) - master;
  }
  sink_.on_pulse({.pulse = slot, .at = now, .host_errors = host_errors_});
}

void Capture::on_shutter_timer(std::uint32_t stream_id) {
  if (engine_.now() >= end_) return;
  Shutter& shutter = streams_[stream_id].shutter;
  shutter.set_exposure(exposures_[streams_[stream_id].camera].at(engine_.now()));
  const auto exposure = shutter.on_timer(engine_.now());
  if (exposure) expose(stream_id, *exposure);
  engine_.schedule(shutter.next_timer(), id_, kShutterTimer, stream_id);
}

void Capture::expose(std::uint32_t stream_id, const Exposure& planned) {
  Stream& stream = streams_[stream_id];
  const scenarios::Cameras& cameras = scenario_.cameras;
  const FrameDelays::Draw delays = stream.delays.draw(stream.transfer_ns);
  const double stamp_noise_ns =
      stream.stamp_noise.normal(cameras.sensor_stamp_jitter_sigma_us * 1e3);
  Exposure exposure = planned;
  if (exposure.start - stream.started < from_ms(cameras.unstable_start_ms)) {
    const double late_ms =
        std::abs(stream.unsteadiness.normal(cameras.unstable_start_jitter_sigma_ms));
    exposure.start += from_ms(late_ms);
    exposure.end += from_ms(late_ms);
  }
  if (vanished(stream.camera, exposure.start)) return;
  const std::uint32_t counter = stream.counter++;
  if (cameras.drop_probability > 0 && stream.loss.chance(cameras.drop_probability)) {
    return tell_lost(stream, counter, exposure);
  }

  const std::uint32_t frame_id = new_frame();
  FrameInFlight& frame = frames_[frame_id];
  DeviceClock& clock = device_clocks_[stream.camera];
  frame.stream = stream_id;
  frame.kernel_copy_ns = delays.kernel_copy_ns;
  frame.delivery_ns = delays.delivery_ns + late_first_frame_ns(stream.camera, exposure.start);
  frame.truth.pulse = exposure.pulse;
  frame.truth.exposure_start = exposure.start;
  frame.truth.exposure_end = exposure.end;
  frame.record.camera = stream.camera;
  frame.record.stream = stream.kind;
  frame.record.counter = counter;
  frame.record.exposure_us =
      static_cast<std::uint32_t>((exposure.end - stream.readout - exposure.start).count() / 1000);
  frame.record.sensor = clock.stamp(frame.truth.mid_exposure(), stamp_noise_ns);
  // Readout begins with the first row.
  frame.record.frame = clock.stamp(exposure.end - stream.readout, stamp_noise_ns);
  engine_.schedule(exposure.end + stream.latency, id_, kReadout, frame_id);
}

bool Capture::vanished(std::uint32_t camera, TrueTime at) const {
  return std::any_of(scenario_.faults.begin(), scenario_.faults.end(), [&](const auto& fault) {
    const double since_start_ms = to_ms(at - start_);
    return fault.kind == "camera_vanishes" && fault.camera == camera &&
           since_start_ms >= fault.at_ms && since_start_ms < fault.at_ms + fault.duration_ms;
  });
}

double Capture::late_first_frame_ns(std::uint32_t camera, TrueTime at) {
  double late_ns = 0;
  for (std::size_t i = 0; i < scenario_.faults.size(); ++i) {
    const scenarios::Fault& fault = scenario_.faults[i];
    if (fault.kind != "late_first_frame" || fault.camera != camera || late_frame_seen_[i]) continue;
    if (to_ms(at - start_) < fault.at_ms) continue;
    late_frame_seen_[i] = true;
    late_ns += fault.duration_ms * 1e6;
  }
  return late_ns;
}

void Capture::on_readout(std::uint32_t frame_id) {
  FrameInFlight& frame = frames_[frame_id];
  const Stream& stream = streams_[frame.stream];
  frame.offered = engine_.now();
  UsbController& bus = controllers_[stream.controller].bus;
  if (bus.submit(engine_.now(), stream.index_on_controller, stream.bytes, frame_id)) {
    wake_controller(stream.controller);
  } else {
    tell(frame, FrameFate::kLostOnUsb);
    release_frame(frame_id);
  }
}

void Capture::on_transfer_done(std::uint32_t controller_id) {
  Controller& controller = controllers_[controller_id];
  if (controller.wake_up != engine_.now()) return;
  controller.wake_up = TrueTime::max();
  while (const auto frame_id = controller.bus.take_completed(engine_.now())) {
    deliver_later(*frame_id);
  }
  wake_controller(controller_id);
}

// Sees to it that an event comes at the controller's next completion. Under fair sharing a new
// frame puts completions off; the event that then comes too early only asks again.
void Capture::wake_controller(std::uint32_t controller_id) {
  Controller& controller = controllers_[controller_id];
  const TrueTime next = controller.bus.next_completion();
  if (next >= controller.wake_up) return;
  controller.wake_up = next;
  engine_.schedule(next, id_, kTransferDone, controller_id);
}

void Capture::deliver_later(std::uint32_t frame_id) {
  FrameInFlight& frame = frames_[frame_id];
  Stream& stream = streams_[frame.stream];
  const TrueTime now = engine_.now();
  const double host_jitter_ns = host_jitter_[stream.host].at(now) * stream.transfer_ns;
  frame.transferred = now;
  frame.copied = now + Nanoseconds(std::llround(frame.kernel_copy_ns));
  TrueTime arrival = frame.copied + Nanoseconds(std::llround(frame.delivery_ns + host_jitter_ns));
  arrival +=
      host_loads_[stream.host].delay(arrival, kLateFrame, frame.stream, frame.record.counter);
  stream.last_arrival = std::max(stream.last_arrival, arrival);
  engine_.schedule(stream.last_arrival, id_, kDelivery, frame_id);
}

void Capture::on_delivery(std::uint32_t frame_id) {
  FrameInFlight& frame = frames_[frame_id];
  const Stream& stream = streams_[frame.stream];
  SystemClock& clock = *clocks_[stream.host];
  const TrueTime now = engine_.now();
  if (outages_.host_stopped(stream.host, now)) {
    release_frame(frame_id);
    return end_if_done();
  }
  const TrueTime middle = frame.truth.mid_exposure();
  frame.record.backend = round_down(clock.read(frame.copied), arrival_quantum_);
  frame.record.arrival = round_down(clock.read(now), arrival_quantum_);
  frame.record.arrival_steady = round_down(clock.steady(now), arrival_quantum_);
  frame.truth.own_host = clock.read(middle);
  frame.truth.own_steady = clock.steady(middle);
  frame.truth.reference = clocks_[0]->read(middle);
  frame.truth.delivered = clocks_[0]->read(now);
  sink_.on_frame(frame.record, &frame.truth);
  if (frame_observer_ != nullptr) {
    frame_observer_->on_delivery(stream.host, frame.record, stream.bytes);
  }
  tell(frame, FrameFate::kDelivered);
  release_frame(frame_id);
  end_if_done();
}

void Capture::on_fault(const scenarios::Fault& fault) {
  if (fault.kind != "clock_step") return;
  SystemClock& clock = *clocks_[static_cast<std::size_t>(fault.host)];
  clock.set(engine_.now(), clock.read(engine_.now()) + from_ms(fault.step_ms));
}

std::uint32_t Capture::new_frame() {
  if (free_frames_.empty()) {
    frames_.emplace_back();
    return static_cast<std::uint32_t>(frames_.size() - 1);
  }
  const std::uint32_t id = free_frames_.back();
  free_frames_.pop_back();
  return id;
}

void Capture::release_frame(std::uint32_t frame_id) { free_frames_.push_back(frame_id); }

void Capture::end_if_done() {
  if (pulses_over_ && free_frames_.size() == frames_.size() && on_end_) {
    std::exchange(on_end_, nullptr)();
  }
}

}  // namespace simbench::sim

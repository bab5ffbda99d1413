#include "sim/rig/capture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/clock/clock_interface.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kLateFrame("host: late delivery of a frame");

// A late first frame is late from the start.
double begin_ms(const scenarios::Fault& fault) {
  return std::visit(
      [](const auto& each) {
        if constexpr (requires { each.at_ms; }) {
          return each.at_ms;
        } else {
          return 0.0;
        }
      },
      fault);
}

}  // namespace

Capture::Capture(const scenarios::Scenario& scenario, std::uint64_t seed, Engine& engine,
                 std::vector<SystemClock*> clocks, const Outages& outages,
                 const CaptureReports& reports)
    : scenario_(scenario),
      seed_(seed),
      engine_(engine),
      id_(engine.attach(*this)),
      clocks_(std::move(clocks)),
      reports_(reports),
      trigger_(scenario.trigger, static_cast<std::size_t>(scenario.cameras.count), seed),
      cameras_(scenario, seed),
      outages_(outages),
      camera_faults_(scenario.faults),
      host_errors_(clocks_.size()),
      arrival_quantum_(from_ms(scenario.hosts.clock.arrival_quantum_ms)),
      backend_stamps_(scenario.usb.backend_stamp, arrival_quantum_) {
  first_slot_ = trigger_.first_slot_from(TrueTime(from_ms(scenario.timeline.warm_up_ms)));
  last_slot_ = first_slot_ + scenario.timeline.frames - 1;
}

RigLayout Capture::layout() const {
  RigLayout layout{.hosts = static_cast<std::uint32_t>(clocks_.size()),
                   .cameras = {},
                   .frame_rate_hz = scenario_.trigger.rate_hz,
                   .first_pulse = first_slot_,
                   .pulses = scenario_.timeline.frames};
  for (std::int64_t camera = 0; camera < scenario_.cameras.count; ++camera) {
    layout.cameras.push_back({static_cast<std::uint32_t>(scenario_.host_of(camera))});
  }
  return layout;
}

void Capture::start(TrueTime at, std::function<void()> on_end) {
  reports_.start(at);
  start_ = at;
  on_end_ = std::move(on_end);
  trigger_.start(at);
  camera_faults_.start(at);
  cameras_.start(at);
  controllers_ = cameras_.make_controllers();
  for (std::size_t host = 0; host < clocks_.size(); ++host) {
    host_sides_.push_back({HostJitter(scenario_.usb, seed_, host, at, trigger_.period_ns()),
                           HostLoad(scenario_.hosts.load_burst, seed_, static_cast<PeerId>(host))});
  }
  end_ = trigger_.due(last_slot_ + 2);

  schedule_pulse(0);
  for (std::uint32_t id = 0; id < cameras_.streams().size(); ++id) {
    const TrueTime timer = cameras_.stream(id).shutter.next_timer();
    if (timer != TrueTime::max()) engine_.schedule(timer, id_, kShutterTimer, id);
  }
  for (std::uint32_t i = 0; i < scenario_.faults.size(); ++i) {
    engine_.schedule(at + from_ms(begin_ms(scenario_.faults[i])), id_, kFault, i);
  }
  engine_.schedule(end_, id_, kEnd, 0);
}

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
    if (slot >= first_slot_) record_pulse(slot);
    const TrueTime now = engine_.now();
    reports_.pulse(slot, now);
    for (const std::uint32_t id : cameras_.triggered_streams()) {
      CameraStream& stream = cameras_.stream(id);
      const TrueTime at_camera = now + trigger_.delay_to(stream.camera);
      stream.shutter.set_exposure(cameras_.exposure(stream.camera, at_camera));
      const auto exposure = stream.shutter.on_pulse(at_camera, slot);
      if (exposure) expose(id, *exposure);
    }
  }
  if (slot < last_slot_) schedule_pulse(slot + 1);
}

void Capture::record_pulse(std::int64_t slot) {
  const TrueTime now = engine_.now();
  read_errors(clocks_, now, host_errors_);
  reports_.recorded_pulse({.pulse = slot, .at = now, .host_errors = host_errors_});
}

void Capture::on_shutter_timer(std::uint32_t stream_id) {
  const TrueTime now = engine_.now();
  if (now >= end_) return;
  CameraStream& stream = cameras_.stream(stream_id);
  stream.shutter.set_exposure(cameras_.exposure(stream.camera, now));
  const auto exposure = stream.shutter.on_timer(now);
  if (exposure) expose(stream_id, *exposure);
  engine_.schedule(stream.shutter.next_timer(), id_, kShutterTimer, stream_id);
}

// Soon after its start a camera may expose late.
Exposure Capture::with_unsteady_start(CameraStream& stream, const Exposure& planned) const {
  const scenarios::Cameras& cameras = scenario_.cameras;
  if (planned.start - stream.started >= from_ms(cameras.unstable_start_ms)) return planned;
  const Nanoseconds late =
      from_ms(std::abs(stream.unsteadiness.normal(cameras.unstable_start_jitter_sigma_ms)));
  return {planned.pulse, planned.start + late, planned.end + late};
}

void Capture::expose(std::uint32_t stream_id, const Exposure& planned) {
  CameraStream& stream = cameras_.stream(stream_id);
  const scenarios::Cameras& cameras = scenario_.cameras;
  const FrameDelays::Draw delays = stream.delays.draw(stream.transfer_ns);
  const double stamp_noise_ns =
      stream.stamp_noise.normal(cameras.sensor_stamp_jitter_sigma_us * 1e3);
  const Exposure exposure = with_unsteady_start(stream, planned);
  if (camera_faults_.vanished(stream.camera, exposure.start)) return;

  const std::uint32_t id = frames_.add();
  FrameInFlight& way = frames_[id];
  CapturedFrame& frame = way.frame = {.host = stream.host, .bytes = stream.bytes};
  frame.record.camera = stream.camera;
  frame.record.stream = stream.kind;
  frame.record.counter = stream.counter++;
  frame.truth.pulse = exposure.pulse;
  frame.truth.exposure_start = exposure.start;
  frame.truth.exposure_end = exposure.end;
  if (cameras.drop_probability > 0 && stream.loss.chance(cameras.drop_probability)) {
    frame.fate = FrameFate::kLostInCamera;
    reports_.frame(frame);
    return frames_.release(id);
  }
  const Nanoseconds exposed = exposure.end - stream.readout - exposure.start;
  DeviceClock& clock = cameras_.clock(stream.camera);
  frame.record.exposure_us = static_cast<std::uint32_t>(exposed.count() / 1000);
  frame.record.sensor = clock.stamp(frame.truth.mid_exposure(), stamp_noise_ns);
  // Readout begins with the first row.
  frame.record.frame = clock.stamp(exposure.end - stream.readout, stamp_noise_ns);
  way.stream = stream_id;
  way.kernel_copy_ns = delays.kernel_copy_ns;
  way.delivery_ns = delays.delivery_ns + camera_faults_.take_delay_ns(stream.camera);
  engine_.schedule(exposure.end + stream.latency, id_, kReadout, id);
}

void Capture::on_readout(std::uint32_t frame_id) {
  FrameInFlight& way = frames_[frame_id];
  const CameraStream& stream = cameras_.stream(way.stream);
  way.frame.offered = engine_.now();
  UsbController& bus = controllers_[stream.controller];
  if (bus.submit(engine_.now(), stream.index_on_controller, stream.bytes, frame_id)) {
    wake_controller(stream.controller);
  } else {
    way.frame.fate = FrameFate::kLostOnUsb;
    reports_.frame(way.frame);
    frames_.release(frame_id);
  }
}

void Capture::on_transfer_done(std::uint32_t controller_id) {
  UsbController& bus = controllers_[controller_id];
  if (!bus.is_woken(engine_.now())) return;
  while (const auto frame_id = bus.take_completed(engine_.now())) deliver_later(*frame_id);
  wake_controller(controller_id);
}

void Capture::wake_controller(std::uint32_t controller_id) {
  const auto at = controllers_[controller_id].take_wake_up();
  if (at) engine_.schedule(*at, id_, kTransferDone, controller_id);
}

void Capture::deliver_later(std::uint32_t frame_id) {
  FrameInFlight& way = frames_[frame_id];
  CameraStream& stream = cameras_.stream(way.stream);
  HostSide& host = host_sides_[stream.host];
  const TrueTime now = engine_.now();
  const double host_jitter_ns = host.jitter.at(now) * stream.transfer_ns;
  way.frame.transferred = now;
  way.frame.copied = now + from_ns(way.kernel_copy_ns);
  const double delivery_ns = way.delivery_ns + host_jitter_ns + stream.late_ns;
  TrueTime arrival = way.frame.copied + from_ns(std::max(0.0, delivery_ns));
  arrival += host.load.delay(arrival, kLateFrame, way.stream, way.frame.record.counter);
  stream.last_arrival = std::max(stream.last_arrival, arrival);
  engine_.schedule(stream.last_arrival, id_, kDelivery, frame_id);
}

// What reaches a stopped host ends there unreported.
void Capture::on_delivery(std::uint32_t frame_id) {
  CapturedFrame& frame = frames_[frame_id].frame;
  if (!outages_.host_stopped(frame.host, engine_.now())) {
    frame.delivered = engine_.now();
    stamp(frame);
    reports_.frame(frame);
  }
  frames_.release(frame_id);
  end_if_done();
}

// What its host and the master make of a frame that is delivered now.
void Capture::stamp(CapturedFrame& frame) {
  SystemClock& clock = *clocks_[frame.host];
  const TrueTime middle = frame.truth.mid_exposure();
  const SystemClock::Reading arrival = clock.read_both(frame.delivered);
  const SystemClock::Reading exposed = clock.read_both(middle);
  frame.record.backend = backend_stamps_.stamp(clock, start_, frame.copied, frame.delivered);
  frame.record.arrival = round_down(arrival.system, arrival_quantum_);
  frame.record.arrival_steady = round_down(arrival.steady, arrival_quantum_);
  frame.truth.own_host = exposed.system;
  frame.truth.own_steady = exposed.steady;
  frame.truth.reference = clocks_[0]->read(middle);
  frame.truth.delivered = clocks_[0]->read(frame.delivered);
}

void Capture::on_fault(const scenarios::Fault& fault) {
  const auto* step = std::get_if<scenarios::ClockStep>(&fault);
  if (step == nullptr) return;
  SystemClock& clock = *clocks_[static_cast<std::size_t>(step->host)];
  clock.set(engine_.now(), clock.read(engine_.now()) + from_ms(step->step_ms));
}

void Capture::end_if_done() {
  if (pulses_over_ && frames_.is_empty() && on_end_) std::exchange(on_end_, nullptr)();
}

}  // namespace simbench::sim

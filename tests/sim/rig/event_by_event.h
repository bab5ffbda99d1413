// The cameras' half of a world event by event, as its models state it: the reference for
// CameraWorld, which goes stage by stage over a period.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/engine/engine.h"
#include "sim/rig/camera_world.h"

namespace simbench::sim {

class EventByEvent {
 public:
  EventByEvent(const scenarios::Scenario& scenario, std::uint64_t seed)
      : scenario_(scenario),
        slots_(evaluated_slots(scenario)),
        trigger_(scenario.trigger, static_cast<std::size_t>(scenario.cameras.count), seed),
        cameras_(scenario, seed),
        faults_(scenario.faults) {
    faults_.start(TrueTime{});
    buses_ = cameras_.make_controllers();
    for (std::size_t host = 0; host < static_cast<std::size_t>(scenario.hosts.count); ++host) {
      jitters_.emplace_back(scenario.usb, seed, host, TrueTime{}, trigger_.period_ns());
      loads_.emplace_back(scenario.hosts.load_burst, seed, static_cast<PeerId>(host));
    }
  }

  // All frames in the order in which they were delivered or lost.
  std::vector<SimFrame> run() {
    plan_slot(0);
    for (std::uint32_t id = 0; id < cameras_.streams().size(); ++id) plan_timer(id);
    engine_.run();
    return std::move(ended_);
  }

 private:
  void plan_slot(std::int64_t slot) {
    if (slot > slots_.last) return;
    const TrueTime at = std::max(trigger_.pulse(slot).value_or(trigger_.due(slot)), engine_.now());
    engine_.call_at(at, [this, slot] { on_slot(slot); });
  }
  void on_slot(std::int64_t slot) {
    if (trigger_.pulse(slot)) {
      for (std::uint32_t id = 0; id < cameras_.streams().size(); ++id) {
        SimStream& stream = cameras_.stream(id);
        if (stream.shutter.mode() == ShutterMode::kFreeRunning) continue;
        const TrueTime at = engine_.now() + trigger_.delay_to(stream.camera);
        stream.shutter.set_exposure(cameras_.exposure(stream.camera, at));
        if (const auto exposure = stream.shutter.on_pulse(at, slot)) expose(id, *exposure);
      }
    }
    plan_slot(slot + 1);
  }
  void plan_timer(std::uint32_t id) {
    const TrueTime at = cameras_.stream(id).shutter.next_timer();
    if (at == TrueTime::max() || at >= trigger_.due(slots_.last + 2)) return;
    engine_.call_at(at, [this, id] {
      SimStream& stream = cameras_.stream(id);
      stream.shutter.set_exposure(cameras_.exposure(stream.camera, engine_.now()));
      if (const auto exposure = stream.shutter.on_timer(engine_.now())) expose(id, *exposure);
      plan_timer(id);
    });
  }

  void expose(std::uint32_t id, Exposure exposure) {
    const scenarios::Cameras& parameters = scenario_.cameras;
    SimStream& stream = cameras_.stream(id);
    const FrameDelays::Draw delays = stream.delays.draw(stream.transfer_ns);
    const double noise_ns =
        stream.stamp_noise.normal(parameters.sensor_stamp_jitter_sigma_us * 1e3);
    if (exposure.start - stream.started < from_ms(parameters.unstable_start_ms)) {
      const Nanoseconds late =
          from_ms(std::abs(stream.unsteadiness.normal(parameters.unstable_start_jitter_sigma_ms)));
      exposure.start += late;
      exposure.end += late;
    }
    if (faults_.vanished(stream.camera, exposure.start)) return;
    const auto ticket = static_cast<std::uint32_t>(frames_.size());
    frames_.push_back({.stream = id,
                       .counter = stream.counter++,
                       .pulse = exposure.pulse,
                       .exposure_start = exposure.start,
                       .exposure_end = exposure.end});
    if (parameters.drop_probability > 0 && stream.loss.chance(parameters.drop_probability)) {
      return end(ticket, FrameFate::kLostInCamera);
    }
    SimFrame& frame = frames_.back();
    const TrueTime read_out = exposure.end - stream.readout;
    frame.exposure_us = static_cast<std::uint32_t>((read_out - exposure.start).count() / 1000);
    frame.stamp_noise_ns = noise_ns;
    const double delivery_ns = delays.delivery_ns + faults_.take_delay_ns(stream.camera);
    delays_.resize(frames_.size());
    delays_.back() = {.kernel_copy_ns = delays.kernel_copy_ns, .delivery_ns = delivery_ns};
    engine_.call_at(exposure.end + stream.latency, [this, ticket] { offer(ticket); });
  }

  void offer(std::uint32_t ticket) {
    SimFrame& frame = frames_[ticket];
    const SimStream& stream = cameras_.stream(frame.stream);
    frame.offered = engine_.now();
    const Nanoseconds at = frame.offered.time_since_epoch();
    if (!buses_[stream.controller].submit(at, stream.index_on_controller, stream.bytes, ticket,
                                          stream.latest(at))) {
      return end(ticket, FrameFate::kLostOnUsb);
    }
    plan_transfer(stream.controller);
  }
  void plan_transfer(std::uint32_t bus) {
    const TrueTime at(buses_[bus].wake_up());
    if (at == TrueTime::max()) return;
    engine_.call_at(at, [this, bus, at] {
      if (buses_[bus].wake_up() != at.time_since_epoch()) return;  // out of date
      while (const auto ticket = buses_[bus].take_completed(at.time_since_epoch()))
        deliver(*ticket);
      plan_transfer(bus);
    });
  }

  void deliver(std::uint32_t ticket) {
    SimFrame& frame = frames_[ticket];
    SimStream& stream = cameras_.stream(frame.stream);
    frame.transferred = engine_.now();
    frame.copied = frame.transferred + from_ns(delays_[ticket].kernel_copy_ns);
    const double host_ns = jitters_[stream.host].at(frame.transferred) * stream.transfer_ns;
    TrueTime at = frame.copied +
                  from_ns(std::max(0.0, delays_[ticket].delivery_ns + host_ns + stream.late_ns));
    at += loads_[stream.host].delay(at, ComponentKey("host: late delivery of a frame"),
                                    frame.stream, frame.counter);
    stream.last_arrival = std::max(stream.last_arrival, at);
    engine_.call_at(stream.last_arrival, [this, ticket] { end(ticket, FrameFate::kDelivered); });
  }

  void end(std::uint32_t ticket, FrameFate fate) {
    frames_[ticket].fate = fate;
    frames_[ticket].at = engine_.now();
    ended_.push_back(frames_[ticket]);
  }

  const scenarios::Scenario& scenario_;
  EvaluatedSlots slots_;
  Engine engine_;
  TriggerTree trigger_;
  SimCameras cameras_;
  CameraFaults faults_;
  std::vector<UsbController> buses_;
  std::vector<HostJitter> jitters_;
  std::vector<HostLoad> loads_;
  std::vector<SimFrame> frames_;
  std::vector<FrameDelays::Draw> delays_;
  std::vector<SimFrame> ended_;
};

}  // namespace simbench::sim

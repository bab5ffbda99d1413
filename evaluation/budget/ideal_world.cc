#include "evaluation/budget/ideal_world.h"

#include <stdexcept>
#include <utility>

#include "recording/forwarding_sink.h"

namespace simbench::evaluation {
namespace {

constexpr const char* kOracle = "oracle";

void idealise_trigger(scenarios::Trigger& trigger) {
  trigger.pulse_jitter_sigma_us = 0;
  trigger.branch_delay_max_us = 0;
  trigger.cable_delay_max_us = 0;
  trigger.daisy_chain_delay_us = 0;
}

void idealise_exposure(scenarios::Cameras& cameras) {
  cameras.exposure_camera_periods = 0;
  cameras.exposure_host_periods = 0;
  cameras.unstable_start_jitter_sigma_ms = 0;
  cameras.auto_exposure.step_interval_exponential_ms = 0;
}

void idealise_device_clock(scenarios::Oscillator& oscillator) {
  const double grid_ms = oscillator.wander_step_ms;
  const double time_constant_s = oscillator.self_heating_time_constant_s;
  oscillator = {};
  oscillator.wander_step_ms = grid_ms;
  oscillator.self_heating_time_constant_s = time_constant_s;
}

// Frames are moved by IdealDelivery; polls take no time, and nothing is left to calibrate.
void idealise_delivery(scenarios::Cameras& cameras) {
  for (scenarios::Stream& stream : cameras.streams) stream.calibrated_delay_ms = 0;
  const double interval_ms = cameras.clock_poll.interval_ms;
  cameras.clock_poll = {};
  cameras.clock_poll.interval_ms = interval_ms;
}

template <class Time>
Time floored(Time time, Nanoseconds quantum) {
  if (quantum.count() == 0) return time;
  const std::int64_t rest_ns = time.time_since_epoch().count() % quantum.count();
  const Nanoseconds above{rest_ns < 0 ? rest_ns + quantum.count() : rest_ns};
  return time - above;
}

// Hands everything on, frames as if they had arrived in the middle of their exposure.
class IdealDelivery final : public ForwardingSink {
 public:
  IdealDelivery(RecordingSink& sink, Nanoseconds quantum)
      : ForwardingSink(sink), quantum_(quantum) {}
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) override {
    if (truth == nullptr) {
      throw std::runtime_error("an ideal delivery needs the truth, which only a simulation has");
    }
    FrameRecord ideal = frame;
    ideal.backend = floored(truth->own_host, quantum_);
    ideal.arrival = ideal.backend;
    ideal.arrival_steady = floored(truth->own_steady, quantum_);
    ideal.exposure_us = 0;  // nothing is left of it between the stamp and the arrival
    sink().on_frame(ideal, truth);
  }

 private:
  Nanoseconds quantum_;
};

class IdealDeliverySource final : public RecordingSource {
 public:
  IdealDeliverySource(std::unique_ptr<RecordingSource> source, Nanoseconds quantum)
      : source_(std::move(source)), quantum_(quantum) {}
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    IdealDelivery ideal(sink, quantum_);
    return source_->record(request, ideal);
  }

 private:
  std::unique_ptr<RecordingSource> source_;
  Nanoseconds quantum_;
};

}  // namespace

scenarios::Scenario ideal_scenario(const scenarios::Scenario& scenario,
                                   const scenarios::Pipeline& pipeline, StageSet ideal) {
  scenarios::Scenario world = scenario;
  world.pipelines = {pipeline};
  world.published.clear();
  if (ideal.has(Stage::kTrigger)) idealise_trigger(world.trigger);
  if (ideal.has(Stage::kExposure)) idealise_exposure(world.cameras);
  if (ideal.has(Stage::kStampQuantisation)) {
    world.cameras.sensor_stamp_jitter_sigma_us = 0;
    world.hosts.clock.arrival_quantum_ms = 0;
  }
  if (ideal.has(Stage::kDeviceClock)) {
    idealise_device_clock(world.cameras.oscillator);
    world.cameras.skew_of_camera_ppm.clear();
  }
  if (ideal.has(Stage::kUsbDelivery)) idealise_delivery(world.cameras);
  if (ideal.has(Stage::kHostClock)) world.pipelines.front().host_sync = kOracle;
  if (ideal.has(Stage::kGathering)) world.pipelines.front().gathering = kOracle;
  return world;
}

std::unique_ptr<RecordingSource> ideal_delivery(std::unique_ptr<RecordingSource> source,
                                                const scenarios::Scenario& world, StageSet ideal) {
  if (!ideal.has(Stage::kUsbDelivery)) return source;
  return std::make_unique<IdealDeliverySource>(std::move(source),
                                               from_ms(world.hosts.clock.arrival_quantum_ms));
}

}  // namespace simbench::evaluation

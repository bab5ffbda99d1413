#include "tests/evaluation/test_capture.h"

#include "algorithms/device_time/yoon2021.h"
#include "algorithms/gathering/gatherers.h"

namespace simbench::evaluation {
namespace {

Nanoseconds or_zero(const TestCapture::PerFrame& shift, std::uint32_t camera, std::int64_t pulse) {
  return shift ? shift(camera, pulse) : Nanoseconds(0);
}

}  // namespace

TestCapture::TestCapture(std::uint32_t hosts, std::uint32_t cameras_per_host) {
  layout.hosts = hosts;
  layout.frame_rate_hz = 50;
  layout.first_pulse = 3;
  layout.pulses = 10;
  for (std::uint32_t camera = 0; camera < hosts * cameras_per_host; ++camera) {
    layout.cameras.push_back({.host = camera / cameras_per_host});
  }
  host_errors.assign(hosts, Nanoseconds(0));
}

void TestCapture::record(RecordingSink& sink) const {
  sink.on_start(layout);
  for (const SyncOutcome& outcome : outcomes) sink.on_event(outcome);
  for (std::int64_t pulse = 0; pulse < layout.first_pulse + layout.pulses; ++pulse) {
    if (with_truth) sink.on_event(PulseTruth{pulse, at(pulse), host_errors});
    for (std::uint32_t camera = 0; camera < layout.cameras.size(); ++camera) {
      if (!lost || !lost(camera, pulse)) deliver(camera, pulse, sink);
    }
  }
}

void TestCapture::deliver(std::uint32_t camera, std::int64_t pulse, RecordingSink& sink) const {
  const Nanoseconds host_error = host_errors[layout.cameras[camera].host];
  const TrueTime mid = at(pulse) + or_zero(exposed_late_by, camera, pulse);
  const TrueTime arrival = mid + from_ms(10) + or_zero(late_by, camera, pulse);
  const std::int64_t sensor_ns = nanoseconds_of(mid + or_zero(sensor_late_by, camera, pulse));

  FrameRecord frame;
  frame.camera = camera;
  frame.counter = static_cast<std::uint32_t>(pulse);
  frame.sensor.us = static_cast<std::uint32_t>(sensor_ns / 1000);
  frame.arrival = HostTime(arrival.time_since_epoch() + host_error);
  frame.arrival_steady = SteadyTime(arrival.time_since_epoch());
  FrameTruth truth;
  truth.pulse = pulse;
  truth.exposure_start = mid - from_ms(4);
  truth.exposure_end = mid + from_ms(4);
  truth.reference = HostTime(mid.time_since_epoch());
  truth.own_host = HostTime(mid.time_since_epoch() + host_error);
  sink.on_frame(frame, with_truth ? &truth : nullptr);
}

ScorerSetup arrival_setup() {
  ScorerSetup setup;
  setup.make_estimator = [](std::size_t) { return make_raw_arrival(); };
  setup.make_gatherer = [](const GatheringSetup& gathering) {
    return make_yoon2021_gatherer(gathering);
  };
  return setup;
}

SeedScore score(const TestCapture& capture, const ScorerSetup& setup) {
  PipelineScorer scorer(setup);
  capture.record(scorer);
  return scorer.finish();
}

}  // namespace simbench::evaluation

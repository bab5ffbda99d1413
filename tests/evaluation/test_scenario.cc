#include "tests/evaluation/test_scenario.h"

#include "scenarios/loader.h"

namespace simbench::evaluation {

scenarios::Scenario test_scenario() {
  scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_45fps");
  scenario.name = "test";
  scenario.timeline.frames = 10;
  scenario.trigger.rate_hz = 50;
  scenario.hosts.count = 2;
  scenario.cameras.count = 4;
  scenario.cameras.cameras_per_host = 2;
  scenario.evaluation.gathering_interval_periods = 0.5;
  scenario.pipelines = {{.name = "arrival",
                         .host_sync = scenario.pipelines.front().host_sync,
                         .device_time = "raw_arrival",
                         .gathering = "yoon2021"},
                        {.name = "smooth",
                         .host_sync = scenario.pipelines.front().host_sync,
                         .device_time = "regression_30",
                         .gathering = "yoon2021"}};
  scenario.published.clear();
  return scenario;
}

RecordingCost TestSource::record(const RecordingRequest& request, RecordingSink& sink) {
  TestCapture capture(2, 2);
  const auto seed_ms = static_cast<double>(request.seed) + (request.pipeline == "smooth" ? 0.5 : 0);
  capture.late_by = [seed_ms](std::uint32_t camera, std::int64_t) {
    return from_ms(camera == 3 ? seed_ms : 0);
  };
  capture.record(sink);
  return {.events = 100 + request.seed, .simulated_seconds = 2, .trace_hash = request.seed};
}

}  // namespace simbench::evaluation

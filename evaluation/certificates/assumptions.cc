#include "evaluation/certificates/assumptions.h"

namespace simbench::evaluation {

Assumptions assumptions_of(const scenarios::Scenario& scenario) {
  Assumptions assumed;
  const scenarios::HostClockModel& clock = scenario.hosts.clock;
  constexpr double kNanosecond_ms = 1e-6;
  assumed.host_stamp_ms = clock.tick_ms + clock.resolution_ms + kNanosecond_ms;
  assumed.arrival_stamp_ms = clock.arrival_quantum_ms + kNanosecond_ms;
  assumed.sensor_stamp_us =
      1 + Assumptions::kSigmas * scenario.cameras.sensor_stamp_jitter_sigma_us;
  return assumed;
}

std::vector<AssumptionLine> described(const Assumptions& assumed) {
  std::vector<AssumptionLine> lines = {
      {"host_rate_ppm", assumed.host_rate_ppm,
       "rate error of each host's oscillator, at most, either way"},
      {"camera_rate_ppm", assumed.camera_rate_ppm, "rate error of each camera's clock, likewise"},
      {"message_ms", assumed.message_ms, "delay of a message between hosts, at least"},
      {"poll_ms", assumed.poll_ms, "delay of either way of a poll of a camera's clock, at least"},
      {"arrival_ms", assumed.arrival_ms, "from the end of an exposure to the arrival, at least"},
      {"host_stamp_ms", assumed.host_stamp_ms, "error of a host's stamp, at most, either way"},
      {"arrival_stamp_ms", assumed.arrival_stamp_ms, "error of an arrival stamp, at most"},
      {"sensor_stamp_us", assumed.sensor_stamp_us,
       "a sensor stamp's distance from the middle of the exposure, at most"}};
  if (assumed.observed_margin_ppm) {
    lines.push_back({"observed_margin_ppm", *assumed.observed_margin_ppm,
                     "rates against host 0 are within this of what the recording shows, which "
                     "nothing in it proves"});
  }
  if (const auto& trigger = assumed.trigger) {
    lines.push_back({"trigger_period_ms", trigger->period_ms,
                     "all cameras are exposed by pulses of one trigger with this period"});
    lines.push_back({"trigger_rate_ppm", trigger->rate_error_ppm, "rate error of the trigger"});
    lines.push_back({"trigger_spread_ms", trigger->spread_ms,
                     "exposures of one pulse are so far apart at most"});
  }
  return lines;
}

}  // namespace simbench::evaluation

#include "evaluation/certificates/assumptions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scenarios/camera_groups.h"

namespace simbench::evaluation {

namespace {

constexpr double kNanosecond_ms = 1e-6;
constexpr double kPpbPerPpm = 1e3;
// For what changes a rate with time: a day, far beyond most recordings.
constexpr double kHours = 24;
constexpr double kSecondsAnHour = 3600;

// A rate that `sigma_ppm` is the law of, or the stated ones.
double drawn_ppm(double sigma_ppm, const std::vector<double>& stated_ppm) {
  if (stated_ppm.empty()) return Assumptions::kRateSigmas * sigma_ppm;
  return std::abs(*std::ranges::max_element(stated_ppm, {},
                                            [](double rate_ppm) { return std::abs(rate_ppm); }));
}

// What the rate gains or loses beside its draw. White frequency noise and the random walk are drawn
// once a step of the grid.
double wander_ppm(const scenarios::Oscillator& oscillator) {
  const double step_s = std::max(oscillator.wander_step_ms * 1e-3, 1e-3);
  const double white_ppb = oscillator.white_frequency_ppb / std::sqrt(step_s);
  const double walk_ppb =
      oscillator.random_walk_ppb_per_sqrt_s * std::sqrt(kHours * kSecondsAnHour);
  const double drawn_ppb =
      Assumptions::kSigmas * (white_ppb + walk_ppb + oscillator.flicker_floor_ppb);
  return drawn_ppb / kPpbPerPpm + std::abs(oscillator.self_heating_ppm) +
         std::abs(oscillator.ramp_ppm_per_hour) * kHours;
}

double temperature_ppm(const scenarios::Hosts& hosts) {
  if (!hosts.temperature) return 0;
  const double kelvins = hosts.temperature->day_amplitude_k + hosts.temperature->load_amplitude_k +
                         hosts.temperature->fan_amplitude_k;
  return std::abs(hosts.clock.oscillator.temperature_coefficient_ppb_per_k) * kelvins / kPpbPerPpm;
}

double bound_ppm(double drawn_ppm, double added_ppm) {
  return std::max(Assumptions::kDataSheet_ppm, std::ceil(drawn_ppm + added_ppm));
}

}  // namespace

Assumptions assumptions_of(const scenarios::Scenario& scenario) {
  Assumptions assumed;
  const scenarios::HostClockModel& clock = scenario.hosts.clock;
  const scenarios::Network& network = scenario.network;
  assumed.host_rate_ppm =
      bound_ppm(drawn_ppm(clock.oscillator.skew_sigma_ppm, clock.skew_of_host_ppm),
                wander_ppm(clock.oscillator) + temperature_ppm(scenario.hosts));
  // PTP takes the corrections of a switch out of the stamps.
  assumed.host_stamp_ms = clock.tick_ms + clock.resolution_ms + kNanosecond_ms +
                          Assumptions::kSigmas * network.switch_clock_error_ns * kNanosecond_ms;
  assumed.arrival_stamp_ms = clock.arrival_quantum_ms + kNanosecond_ms;
  assumed.pulse_error_us += Assumptions::kSigmas * scenario.hosts.pulse_lines.pps_jitter_sigma_us;
  double jitter_us = 0;
  for (std::size_t group = 0; group < scenarios::group_count(scenario.cameras); ++group) {
    const scenarios::Cameras cameras = scenarios::cameras_of_group(scenario.cameras, group);
    jitter_us = std::max(jitter_us, cameras.sensor_stamp_jitter_sigma_us);
    assumed.camera_rate_ppm =
        std::max(assumed.camera_rate_ppm,
                 bound_ppm(drawn_ppm(cameras.oscillator.skew_sigma_ppm, cameras.skew_of_camera_ppm),
                           wander_ppm(cameras.oscillator)));
  }
  assumed.sensor_stamp_us = 1 + Assumptions::kSigmas * jitter_us;
  return assumed;
}

std::vector<AssumptionLine> described(const Assumptions& assumed) {
  std::vector<AssumptionLine> lines = {
      {"host_rate_ppm", assumed.host_rate_ppm,
       "rate error of each host's oscillator, at most, either way"},
      {"camera_rate_ppm", assumed.camera_rate_ppm,
       "rate error of each camera's clock, at most, either way"},
      {"message_ms", assumed.message_ms, "delay of a message between hosts, at least"},
      {"poll_ms", assumed.poll_ms, "delay of either way of a poll of a camera's clock, at least"},
      {"arrival_ms", assumed.arrival_ms, "from the end of an exposure to the arrival, at least"},
      {"host_stamp_ms", assumed.host_stamp_ms, "error of a host's stamp, at most, either way"},
      {"arrival_stamp_ms", assumed.arrival_stamp_ms, "error of an arrival stamp, at most"},
      {"sensor_stamp_us", assumed.sensor_stamp_us,
       "a sensor stamp's distance from the middle of the exposure, at most"}};
  if (assumed.estimated_stamp_ms) {
    lines.push_back({"estimated_stamp_ms", *assumed.estimated_stamp_ms,
                     "error of a stamp that a protocol estimated, at most, either way"});
  }
  if (assumed.pulse_late_us) {
    lines.push_back({"pulse_late_us", *assumed.pulse_late_us,
                     "a host sees a pulse of its PPS line so late at most"});
    lines.push_back({"pulse_error_us", assumed.pulse_error_us,
                     "distance of such a pulse from the full second, at most, either way"});
  }
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

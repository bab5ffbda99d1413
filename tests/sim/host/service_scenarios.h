// The worlds in which services of host_sync are tested.
#pragma once

#include "tests/sim/host/sim_world.h"

namespace simbench::sim {

inline constexpr double kServiceLatencyMs = 1;

// Clocks without noise over links without jitter; a test adds what it is about.
inline scenarios::Scenario quiet_world() {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.network.latency_fixed_ms = kServiceLatencyMs;
  scenario.hosts.clock.oscillator.wander_step_ms = 1000;
  return scenario;
}

// A LAN with jitter, quartz with wander.
inline scenarios::Scenario lan_world() {
  scenarios::Scenario scenario = quiet_world();
  scenario.network.latency_fixed_ms = 0.1;
  scenario.network.latency_exponential_ms = 0.05;
  scenario.hosts.clock.oscillator.skew_sigma_ppm = 10;
  scenario.hosts.clock.oscillator.white_frequency_ppb = 5;
  scenario.hosts.clock.oscillator.random_walk_ppb_per_sqrt_s = 0.1;
  return scenario;
}

// The world of chrony's own simulation tests: an offset of 0.1 s, a rate error of about 100 ppm and
// a wander of 1e-9 a second, over links of 100 us plus Exp(jitter).
inline scenarios::Scenario chrony_world(double jitter_s, double wander) {
  scenarios::Scenario scenario = ideal_hosts();
  scenario.network.latency_fixed_ms = 0.1;
  scenario.network.latency_exponential_ms = jitter_s * 1e3;
  // Two hosts differ by sqrt(2) of that: 100 ppm.
  scenario.hosts.clock.oscillator.skew_sigma_ppm = 70.7;
  scenario.hosts.clock.oscillator.random_walk_ppb_per_sqrt_s = wander * 1e9;
  scenario.hosts.clock.oscillator.wander_step_ms = 1000;
  return scenario;
}

}  // namespace simbench::sim

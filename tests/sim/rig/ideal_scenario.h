// A scenario without any noise, for tests that switch on one effect at a time.
#pragma once

#include "scenarios/scenario.h"

namespace simbench::sim {

// Two hosts with one camera each, genlock at 45 Hz in the 90 Hz mode, exposure 4 ms, latency 8 ms,
// transfer 2 ms; 1 s of warm-up and 90 frames; clocks exact, network 0.1 ms.
inline scenarios::Scenario ideal_scenario() {
  const scenarios::Oscillator exact{.skew_sigma_ppm = 0,
                                    .white_frequency_ppb = 0,
                                    .random_walk_ppb_per_sqrt_s = 0,
                                    .wander_step_ms = 1000};
  scenarios::Scenario s{};
  s.name = "ideal";
  s.timeline = {.wait_before_capture_ms = 100, .warm_up_ms = 1000, .frames = 90};
  s.hosts.count = 2;
  s.hosts.clock.oscillator = exact;
  s.hosts.clock.resolution_ms = 1e-6;
  s.hosts.clock.set_effective_fraction = 0.5;
  s.hosts.clock.arrival_quantum_ms = 1e-6;
  s.network.latency_fixed_ms = 0.1;
  s.network.retransmit_timeout_ms = 200;
  s.network.stamp_point = scenarios::StampPoint::kApplication;
  s.trigger.rate_hz = 45;
  s.trigger.cameras_per_sub_trigger = 6;
  s.cameras.count = 2;
  s.cameras.cameras_per_host = 1;
  s.cameras.model = "d455";
  s.cameras.sync_mode = scenarios::SyncMode::kGenlock;
  s.cameras.common_start = true;
  s.cameras.streams = {{.kind = scenarios::StreamKind::kDepth,
                        .width = 1000,
                        .height = 350,
                        .bytes_per_pixel = 2,
                        .mode_rate_hz = 90,
                        .pipeline_latency_ms = 8,
                        .latency_mode_periods = 0,
                        .shutter = scenarios::ShutterKind::kGlobal,
                        .readout_ms = 0}};
  s.cameras.oscillator = exact;
  s.cameras.exposure_ms = 4;
  s.cameras.genlock_guard_fraction = 0.02;
  s.cameras.slave_free_run_after_periods = 3;
  s.usb = {.bandwidth_mb_per_s = 350,
           .sharing = scenarios::UsbSharing::kDedicated,
           .cameras_per_controller = 3,
           .buffered_frames = 4,
           .kernel_copy_exponential_ms = 0,
           .delivery_jitter_transfers = 0,
           .host_jitter_transfers = 0,
           .host_jitter_correlation = 0,
           .spike_probability = 0,
           .spike_max_transfers = 0};
  s.evaluation = {.stream = scenarios::StreamKind::kDepth,
                  .table = scenarios::TableKind::kPipelines,
                  .gathering_interval_periods = 0.5,
                  .rmdv_median = scenarios::MedianKind::kUpperMiddle};
  return s;
}

}  // namespace simbench::sim

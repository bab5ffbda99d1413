// The rates of pulses that slaves follow surely. Intel's page on external synchronisation calls the
// window "so strict" without its size: 1 % around the mode's rate is an assumption. A scenario with
// other pulses is refused.
//
//   const PulseWindow window(/*mode_rate_hz=*/90);
//   const bool is_too_fast = window.is_faster(scenario.trigger.pulse_rate_hz());  // than 90.9 Hz
#pragma once

namespace simbench::scenarios {

struct PulseWindow {
  static constexpr double kTolerance = 0.01;
  static constexpr double kRounding = 1e-9;

  explicit PulseWindow(double mode_rate_hz)
      : slowest_hz(mode_rate_hz * (1 - kTolerance)), fastest_hz(mode_rate_hz * (1 + kTolerance)) {}
  bool is_slower(double rate_hz) const { return rate_hz < slowest_hz * (1 - kRounding); }
  bool is_faster(double rate_hz) const { return rate_hz > fastest_hz * (1 + kRounding); }

  double slowest_hz;
  double fastest_hz;
};

}  // namespace simbench::scenarios

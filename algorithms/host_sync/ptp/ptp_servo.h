// The clock servos of linuxptp, with its published constants: proportional-integral and adaptive
// linear regression. They only compute.
//
// A servo is fed the measured offset (own clock minus reference, ns) with the own clock's reading,
// and answers with a frequency correction: the clock must run slower by that many ppb than its
// oscillator. State kJump adds a step by minus the offset; kUnlocked means no correction.
//
// PI. kp = min(kp_scale T^-0.3, 0.7 / T), ki = min(ki_scale T^0.4, 0.3 / T) with the interval T in
// seconds; scales 0.7 and 0.3 for hardware stamps, 0.1 and 0.001 for software stamps. (SPTP's has
// exponents of 0, and 1 / T and 2 / T.) The first
// sample and the first one at least min(0.016 / ki, 1000) s later (less 0.1 %) give the frequency;
// from then on
// ppb = kp o w + drift + ki o w, drift += ki o w, unless that exceeds the largest frequency.
//
// Linear regression. For windows of the last 4, 8, ... 64 samples it fits the reference over the
// own oscillator (corrections subtracted), and chooses the largest window whose mean prediction
// error is below 1.05 times that of the one chosen before; the error is averaged over 10 updates,
// then smoothed by 0.02. Frequency = slope plus the residual offset (of the line), divided by the
// interval and by 1 up to window 16, 2 for 32 and 3 for 64. Its rate ratio is what is left of the
// slope, which the measurement of the delay takes into account; the PI servo has none (1).
//
// Steps: on the first update if the offset (of the regression: the residual one) exceeds
// first_step_threshold, later only if it exceeds a positive step_threshold.
// Complexity: O(1); regression O(64). Offsets must be finite.
// Source: docs/reference/host_sync.md section 1 (linuxptp); outputs agree with
// tests/data/vectors/linuxptp_golden.json.
//
//   PiServo servo(PiServo::kHardwareStamps, {});
//   ServoAnswer answer = servo.sample(offset_ns, t2_ns, 1.0);
//   if (answer.state != ServoState::kUnlocked) co_await clock.adjust_frequency(-answer.ppb);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "algorithms/parameter_binder.h"

namespace simbench {

enum class ServoState : std::uint8_t { kUnlocked, kJump, kLocked };

struct ServoAnswer {
  double ppb = 0;
  ServoState state = ServoState::kUnlocked;
};

struct ServoSettings {
  double interval_s = 1;
  double max_frequency_ppb = 9e8;           // and no more than the clock takes (ptp_clocks.h)
  double first_step_threshold_ns = 20'000;  // 0: never
  double step_threshold_ns = 0;             // 0: never

  void bind_first_step(ParameterBinder& parameters, const char* source);
  void bind_max_frequency(ParameterBinder& parameters, const char* source);
};

class Servo {
 public:
  virtual ~Servo() = default;
  // `local_ns`: the own clock at the offset. The answer to a clock that jumps back is kUnlocked.
  virtual ServoAnswer sample(double offset_ns, std::int64_t local_ns, double weight) = 0;
  // The reference's rate against the own clock as the servo has left it.
  virtual double rate_ratio() const { return 1; }
};

// A PI servo scales its constants with the interval T: kp = min(kp T^kp_exponent, kp_limit / T), ki
// likewise.
struct PiScales {
  double kp = 0;
  double ki = 0;
  double kp_exponent = -0.3;
  double ki_exponent = 0.4;
  double kp_limit = 0.7;
  double ki_limit = 0.3;
};

class PiServo : public Servo {
 public:
  static constexpr PiScales kHardwareStamps{.kp = 0.7, .ki = 0.3};
  static constexpr PiScales kSoftwareStamps{.kp = 0.1, .ki = 0.001};
  static constexpr PiScales kSimplePtp{
      .kp = 0.7, .ki = 0.3, .kp_exponent = 0, .ki_exponent = 0, .kp_limit = 1, .ki_limit = 2};

  PiServo(PiScales scales, ServoSettings settings);
  ServoAnswer sample(double offset_ns, std::int64_t local_ns, double weight) override;
  // How long after the first sample it finds the frequency.
  double first_frequency_s() const;
  bool has_frequency() const { return phase_ == Phase::kRunning; }
  // Finds the frequency anew, from 0; a first step is not repeated.
  void forget();

 private:
  enum class Phase : std::uint8_t { kEmpty, kOneSample, kRunning };
  ServoAnswer first_frequency(double offset_ns, std::int64_t local_ns);

  ServoSettings settings_;
  double kp_;
  double ki_;
  Phase phase_ = Phase::kEmpty;
  bool is_first_update_ = true;
  double first_offset_ns_ = 0;
  std::int64_t first_local_ns_ = 0;
  double drift_ppb_ = 0;
};

class LinearRegressionServo : public Servo {
 public:
  explicit LinearRegressionServo(ServoSettings settings) : settings_(settings) {}
  ServoAnswer sample(double offset_ns, std::int64_t local_ns, double weight) override;
  double rate_ratio() const override { return rate_ratio_; }

 private:
  static constexpr int kSmallest = 2;  // log2 of the windows
  static constexpr int kLargest = 6;
  // `oscillator_ns` counts the uncorrected oscillator, in whole nanoseconds.
  struct Point {
    std::int64_t oscillator_ns = 0;
    std::int64_t reference_ns = 0;
    double weight = 1;
  };
  struct Fit {
    double slope = 0;
    double intercept_ns = 0;  // at the newest sample: reference minus own clock
    double error_ns = 0;
    int errors = 0;
  };

  void restart();
  void move(std::int64_t oscillator_ns, std::int64_t local_ns);
  void advance_to(std::int64_t local_ns);
  void fit_all();
  void choose_window();
  Fit& fit(int window) { return fits_[static_cast<std::size_t>(window - kSmallest)]; }

  ServoSettings settings_;
  std::deque<Point> points_;  // newest first
  std::array<Fit, kLargest - kSmallest + 1> fits_{};
  Point now_;  // of the last sample: oscillator and own clock
  bool has_local_ = false;
  std::int64_t last_local_ns_ = 0;
  double oscillator_part_ns_ = 0;  // beyond the whole nanoseconds
  double frequency_ppb_ = 0;
  double rate_ratio_ = 1;
  int window_ = 0;
  bool is_first_update_ = true;
};

}  // namespace simbench

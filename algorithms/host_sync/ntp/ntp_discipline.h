// NTP's clock filter and clock discipline. Both are pure state machines: offsets are server minus
// client, in seconds; times are steady seconds. What is not finite is refused by an assertion.
//
// Source: RFC 5905 sections 10 and 11.3 (figures 24 to 28); docs/reference/host_sync.md section 2
// (ntp_loopfilter.c; gate 3 and Allan intercept: ntp.h).
//
//   NtpClockFilter filter(1e-6);
//   NtpDiscipline discipline({});
//   const auto best = filter.add({offset_s, delay_s, dispersion_s, now_s}, 64);
//   if (best && discipline.update(best->offset_s, now_s) == NtpAction::kStep) step(best->offset_s);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "algorithms/host_sync/ntp/ntp_kernel_loop.h"

namespace simbench {

struct NtpSample {
  double offset_s = 0;
  double delay_s = 0;
  double dispersion_s = 0;  // at `at_s`
  double at_s = 0;
};

// The clock filter: of the last eight samples, the one with the lowest delay, if it is new.
//
//  - Order: by delay; the delay of a sample older than the Allan intercept (2048 s) counts with its
//    dispersion added, so that recent ones win at long poll intervals (reference implementation).
//    While the clock is starting the newest comes first: the clock has moved since the older ones.
//  - The dispersion of a kept sample grows by 15e-6 s/s. Dispersion of the filter: sum of
//    dispersion_i / 2^(i+1) over the eight, in that order; a stage that is empty or holds a missing
//    sample has 16 s.
//  - Jitter: RMS difference of the offsets to that of the best sample, at least the precision.
//  - A sample is used once, and never one older than the last used.
//  - Popcorn spikes: a best sample is not used if its offset differs from that of the best before
//    (used or not) by more than 3 times the jitter, which is taken to the new one, within two poll
//    intervals of the last used. The gate therefore closes only where the best before has just left
//    the stages, and a lone outlier of low delay passes, as in the reference implementation. The
//    gate needs dispersions below kMaxDistance (four samples).
//
// Complexity: O(1). Degenerate: delays below the precision count as the precision, a dispersion of
// 16 s or more as no sample.
class NtpClockFilter {
 public:
  static constexpr std::size_t kStages = 8;
  static constexpr double kMaxDispersion = 16;        // s
  static constexpr double kDispersionGrowth = 15e-6;  // s/s, PHI
  static constexpr double kAllanIntercept = 2048;     // s
  static constexpr double kPopcornGate = 3;           // times the jitter
  static constexpr double kMaxDistance = 1.5;         // s, MAXDIST

  explicit NtpClockFilter(double precision_s) : precision_s_(precision_s) { reset(); }

  // Samples come in order of time. Returns the sample to discipline the clock by, if any.
  std::optional<NtpSample> add(const NtpSample& sample, double poll_interval_s,
                               bool is_starting = false);

  // A poll without a reply takes up a stage.
  void add_missing(double at_s);

  // Forgets all samples, after a step of the clock.
  void reset();

  double jitter_s() const { return jitter_s_; }
  double dispersion_s() const { return dispersion_s_; }
  // Half the delay of the best sample plus dispersion and jitter; a server above kMaxDistance is
  // not used.
  double distance_s() const;

 private:
  void shift_in(const NtpSample& stage);
  // The stages in order of preference, as of `now_s`.
  std::array<NtpSample, kStages> ordered(double now_s) const;
  void update_statistics(const std::array<NtpSample, kStages>& by_delay);

  double precision_s_;
  std::array<NtpSample, kStages> stages_;  // newest first
  double newest_s_ = 0;                    // up to when the dispersions have grown
  std::optional<double> last_used_at_s_;
  std::optional<double> best_offset_s_;  // of the last best sample, used or not
  double jitter_s_ = 0;
  double dispersion_s_ = kMaxDispersion;
  double best_delay_s_ = kMaxDispersion;
};

// What turns offsets into phase and frequency once the clock is locked.
enum class NtpLoop : std::uint8_t {
  kKernel,  // Linux's (ntp_kernel_loop.h): ntpd's default
  kDaemon,  // ntpd's own: "disable kernel", or a kernel that has none
};

struct NtpDisciplineSettings {
  NtpLoop loop = NtpLoop::kKernel;
  double step_s = 0.128;  // 0: never step
  double step_out_s = 300;
  double panic_s = 1000;  // 0: never panic
  int poll_min = 6;       // log2 s
  int poll_max = 10;
  double precision_s = 1e-6;
  // A frequency to start with, as from a drift file; nothing: measure it first.
  std::optional<double> frequency{};
};

enum class NtpState : std::uint8_t { kNset, kFset, kFreq, kSync, kSpik };

enum class NtpAction : std::uint8_t {
  kIgnore,  // do nothing
  kAdjust,  // frequency() and phase have new values
  kSlew,    // add the whole offset, as fast as the clock is slewed: kMaxFrequency
  kStep,    // step the clock by the offset; frequency() may have a new value
  kPanic,   // end the service
};

// The clock discipline: from offsets to steps, a frequency and a decaying phase correction.
//
//  - States: NSET (nothing known), FREQ (measuring the frequency for step_out_s, with the phase
//    left alone), SYNC (phase and frequency locked), SPIK (an offset above step_s, waiting), FSET
//    (frequency known, time unknown: after a step, and when started with a frequency).
//  - An offset above step_s steps the clock at once in NSET and FSET; in SYNC it is a spike, and
//    steps if it lasts until step_out_s after the last good update. Above panic_s: panic.
//  - A smaller first offset is slewed away at once; then FREQ begins, as after a step.
//  - Start-up clamp: from when SYNC is first entered, the daemon removes the offset with a time
//    constant of 32 s, while frequency and poll stay; until step_out_s later, or the first offset
//    below kClampFloor.
//  - Then the loop. The kernel's: ntp_kernel_loop.h, with the poll exponent as its constant. It is
//    first told an offset by the update after the clamp. ntpd does not use it if it may not step,
//    or only above kKernelStep.
//  - The daemon's, phase: in SYNC the residual decays with the time constant 16 * 2^poll seconds,
//    no faster than the frequency leaves room for within 500 ppm.
//  - The daemon's, frequency: PLL, offset * min(mu, 2^11) / (4 * 16 * 2^poll)^2, with mu the time
//    since the last update; from poll 11 on also FLL, (offset - residual) * 0.25 / max(2^poll, mu).
//    Within 500 ppm. (RFC 5905's appendix has a PLL gain of 65536: a time constant of 48 days.)
//  - Clock jitter: root of the exponential average (1/8) of squared offset differences.
//  - Poll exponent: a counter goes up by the exponent while |offset| < 4 * jitter, else down by
//    twice that; beyond +-30 the poll moves one step within its bounds.
//
// Not here: reading and writing a drift file.
class NtpDiscipline {
 public:
  static constexpr double kPllGain = 16;
  static constexpr double kClampTime = 32;       // s, time constant during the start-up clamp
  static constexpr double kClampFloor = 0.0005;  // s, CLOCK_FLOOR
  static constexpr double kKernelStep = 0.5;     // s
  static constexpr double kFllGain = 0.25;
  static constexpr double kAverage = 8;
  static constexpr int kAllanPoll = 11;
  static constexpr double kMaxFrequency = 500e-6;
  static constexpr double kPollGate = 4;
  static constexpr int kPollLimit = 30;

  explicit NtpDiscipline(const NtpDisciplineSettings& settings);

  // The service starts at 0 s. `at_s`, when the offset is told, must not decrease.
  NtpAction update(double offset_s, double at_s);

  NtpState state() const { return state_; }
  // Before SYNC, and during the start-up clamp.
  bool is_starting(double at_s) const { return !clamp_end_s_ || at_s < *clamp_end_s_; }
  double frequency() const { return frequency_; }  // correction, as a fraction
  int poll() const { return poll_; }
  double jitter_s() const { return jitter_s_; }
  // The loop has both of these once the clamp is over.
  double time_constant_s() const;
  double poll_interval_s() const;

  // What is left of the phase correction at a time after the last update. The daemon's is 0 unless
  // in SYNC; the kernel knows no states.
  double residual_s(double at_s) const;
  // The part of it to correct in the poll interval that begins then, per second.
  double phase_rate(double at_s) const;

 private:
  NtpAction update_large(double offset_s, double at_s);
  NtpAction update_small(double offset_s, double at_s);
  NtpAction step(double at_s);
  void lock(NtpState state, double offset_s, double at_s);
  void update_frequency(double offset_s, double at_s);
  void measure_frequency(double offset_s, double at_s);
  void adapt_poll(double offset_s);
  // Time constants that pass between two times.
  double decay(double from_s, double to_s) const;
  void move_poll(int by);
  bool is_kernel_in_force(double at_s) const { return kernel_ && !is_starting(at_s); }

  NtpDisciplineSettings settings_;
  NtpState state_;
  double frequency_;
  int poll_;
  int poll_counter_ = 0;
  double jitter_s_;
  double offset_s_ = 0;  // at the last update
  double at_s_ = 0;      // of the last update
  std::optional<double> clamp_end_s_;
  std::optional<NtpKernelLoop> kernel_;
};

}  // namespace simbench

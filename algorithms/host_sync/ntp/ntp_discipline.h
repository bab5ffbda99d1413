// NTP's clock discipline: from offsets to steps, a frequency and a decaying phase correction.
//
// A pure state machine; the caller feeds the offsets that passed the clock filter and does to the
// clock what it says. Offsets are server minus client, in seconds; times are steady seconds.
//
//  - States: NSET (nothing known), FREQ (measuring the frequency for step_out_s, with the phase
//    left alone), SYNC (phase and frequency locked), SPIK (an offset above step_s, waiting), FSET
//    (the frequency is known, the time is not: after a step, and when started with a frequency).
//  - An offset above step_s steps the clock at once in NSET and FSET; in SYNC it is a spike, and
//    steps if step_out_s after the last good update offsets still are so. Above panic_s: panic.
//  - A smaller first offset is slewed away at once; then FREQ begins, as after a step.
//  - Phase: in SYNC the residual decays with the time constant 16 * 2^poll seconds, at no more than
//    the frequency leaves of 500 ppm.
//  - Start-up clamp: for step_out_s after SYNC is first entered, that time constant is 32 s, and
//    neither frequency nor poll are touched, until the initial transient is over.
//  - Frequency: PLL, offset * min(mu, 2^11) / (4 * 16 * 2^poll)^2, with mu the time since the last
//    update; from poll 11 on also FLL, (offset - residual) * 0.25 / max(2^poll, mu). Within 500
//    ppm. (RFC 5905's appendix has a PLL gain of 65536: a time constant of 48 days.)
//  - Clock jitter: root of the exponential average (1/8) of squared offset differences.
//  - Poll exponent: a counter goes up by the exponent while |offset| < 4 * jitter, else down by
//    twice that; beyond +-30 the poll moves one step within its bounds.
//
// Not here: reading and writing a drift file, and the kernel's discipline.
//
// Source: RFC 5905 section 11.3 (figures 24 to 28); docs/reference/host_sync.md section 2
// (ntp_loopfilter.c).
//
//   NtpDiscipline discipline({});
//   if (discipline.update(offset_s, now_s) == NtpAction::kStep) step(offset_s);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_DISCIPLINE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_DISCIPLINE_H_

#include <cstdint>
#include <optional>

namespace simbench {

struct NtpDisciplineSettings {
  double step_s = 0.128;  // 0: never step
  double step_out_s = 300;
  double panic_s = 1000;  // 0: never panic
  int poll_min = 6;       // log2 s
  int poll_max = 10;
  double precision_s = 1e-6;
  // A frequency to start with, as a drift file would give; nothing: measure it first.
  std::optional<double> frequency;
};

enum class NtpState : std::uint8_t { kNset, kFset, kFreq, kSync, kSpik };

enum class NtpAction : std::uint8_t {
  kIgnore,  // do nothing
  kAdjust,  // frequency() and phase have new values
  kSlew,    // add the whole offset, as fast as the clock is slewed: kMaxFrequency
  kStep,    // step the clock by the offset; frequency() may have a new value
  kPanic,   // refuse to go on
};

class NtpDiscipline {
 public:
  static constexpr double kPllGain = 16;
  static constexpr double kClampTime = 32;  // s, time constant during the start-up clamp
  static constexpr double kFllGain = 0.25;
  static constexpr double kAverage = 8;
  static constexpr int kAllanPoll = 11;
  static constexpr double kMaxFrequency = 500e-6;
  static constexpr double kPollGate = 4;
  static constexpr int kPollLimit = 30;

  explicit NtpDiscipline(const NtpDisciplineSettings& settings);

  // `at_s` is when the offset was measured; must not decrease. A not-finite offset is refused by an
  // assertion.
  NtpAction update(double offset_s, double at_s);

  NtpState state() const { return state_; }
  // Before SYNC, and during the start-up clamp.
  bool is_starting(double at_s) const { return !clamp_end_s_ || at_s < *clamp_end_s_; }
  double frequency() const { return frequency_; }  // correction, as a fraction
  int poll() const { return poll_; }
  double jitter_s() const { return jitter_s_; }
  double time_constant_s() const { return kPllGain * poll_interval_s(); }
  double poll_interval_s() const;

  // What is left of the phase correction at a time after the last update; 0 unless in SYNC.
  double residual_s(double at_s) const;
  // How much of it is to be corrected in the poll interval that begins then, per second.
  double phase_rate(double at_s) const;

 private:
  NtpAction update_large(double offset_s, double at_s);
  NtpAction update_small(double offset_s, double at_s);
  NtpAction step(double at_s);
  void lock(NtpState state, double offset_s, double at_s);
  void measure_frequency(double offset_s, double at_s);
  void adapt_poll(double offset_s);
  // Time constants that pass between two times.
  double decay(double from_s, double to_s) const;
  void move_poll(int by);

  NtpDisciplineSettings settings_;
  NtpState state_;
  double frequency_;
  int poll_;
  int poll_counter_ = 0;
  double jitter_s_;
  double offset_s_ = 0;  // at the last update
  double at_s_ = 0;      // of the last update
  std::optional<double> clamp_end_s_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_DISCIPLINE_H_

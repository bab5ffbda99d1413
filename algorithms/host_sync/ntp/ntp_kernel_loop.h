// The clock discipline of the Linux kernel, which a default ntpd steers by (adjtimex, STA_PLL):
// a phase-locked loop that becomes a frequency-locked one after long intervals. Pure state
// machines: offsets are server minus client, in seconds; times are steady seconds.
//
//  - Phase: each second the kernel adds 1 / 2^(kShiftPll + constant) of what is left of the offset:
//    a time constant of 4 * 2^constant s, a quarter of the daemon's own.
//  - Frequency, PLL: offset * min(mu, 8 * 2^constant) / (16 * 2^constant)^2, with mu the time since
//    the last update, in whole seconds as the kernel counts it.
//  - Frequency, FLL: offset / (4 * mu) on top, if mu is above kMaxInterval, or with STA_FLL from
//    kMinInterval on. (ntpd does not set that.)
//  - Frequency within 500 ppm, offset within 0.5 s, constant within 0 to 10. The phase has no other
//    limit: 128 ms at a constant of 3 are added at up to 4000 ppm.
//
// KernelLoop goes second by second, as the kernel does; NtpKernelLoop adds the phase evenly, which
// can be told at any time.
//
// Source: Linux, kernel/time/ntp.c (ntp_update_offset, ntp_update_offset_fll, ntp_offset_chunk,
// second_overflow) and include/linux/timex.h; docs/reference/host_sync.md section 2.
//
//   NtpKernelLoop kernel(now_s);
//   kernel.update(1e-3, 6, now_s + 64);
//   const double phase_s = kernel.residual_s(now_s + 64) - kernel.residual_s(now_s + 128);
//   correct_the_clock(kernel.frequency(), phase_s);
#pragma once

namespace simbench {

class KernelLoop {
 public:
  static constexpr int kShiftPll = 2;           // SHIFT_PLL
  static constexpr int kShiftFll = 2;           // SHIFT_FLL
  static constexpr double kMinInterval = 256;   // s, MINSEC
  static constexpr double kMaxInterval = 2048;  // s, MAXSEC
  static constexpr int kMaxConstant = 10;       // MAXTC
  static constexpr double kMaxPhase = 0.5;      // s, MAXPHASE
  static constexpr double kMaxFrequency = 500e-6;

  enum class Mode { kPll, kFll };  // STA_MODE

  // ADJ_FREQUENCY.
  void set_frequency(double frequency);
  // ADJ_TIMECONST.
  void set_constant(int constant);
  // ADJ_OFFSET, `mu_s` after the last one; 0 leaves the frequency (STA_FREQHOLD). `wants_fll` is
  // STA_FLL. Returns how the frequency was steered.
  Mode update(double offset_s, double mu_s, bool wants_fll = false);
  // The part of the offset that the next second adds.
  double next_part_s() const;
  // It begins: returns that part, which is left no more.
  double next_second();
  // Forgets the offset, after a step of the clock.
  void clear() { offset_s_ = 0; }

  double frequency() const { return frequency_; }  // correction, as a fraction
  double offset_s() const { return offset_s_; }    // what is left
  int constant() const { return constant_; }

 private:
  double frequency_ = 0;
  int constant_ = 0;
  double offset_s_ = 0;
};

class NtpKernelLoop {
 public:
  // The loop is switched on at `at_s`, with no offset and no frequency.
  explicit NtpKernelLoop(double at_s) : at_s_(at_s) {}

  // ADJ_FREQUENCY.
  void set_frequency(double frequency) { loop_.set_frequency(frequency); }
  // ADJ_OFFSET with ADJ_TIMECONST. `at_s` must not decrease.
  void update(double offset_s, int constant, double at_s);

  double frequency() const { return loop_.frequency(); }  // correction, as a fraction
  // What is left of the offset at a time after the last update.
  double residual_s(double at_s) const;
  double time_constant_s() const;

 private:
  KernelLoop loop_;
  double at_s_;  // of the last update
};

}  // namespace simbench

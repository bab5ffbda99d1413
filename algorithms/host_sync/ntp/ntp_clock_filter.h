// NTP's clock filter: of the last eight samples, the one with the lowest delay, if it is new.
//
// A sample is an offset (server minus client), a round trip delay, a dispersion and the steady
// time, in seconds, at which it was taken. The dispersion of a kept sample grows by 15e-6 s/s.
//
//  - Order: by delay; a sample older than the Allan intercept (2048 s) counts as slower by its
//    dispersion, so that recent ones win at long poll intervals (reference implementation).
//    While the clock is starting (ntp_discipline.h), the newest comes first: an older one tells of
//    a clock that has moved since.
//  - Dispersion of the filter: sum of dispersion_i / 2^(i+1) over the eight, in that order; a stage
//    that is empty or holds a missing sample has 16 s.
//  - Jitter: RMS difference of the offsets to that of the best sample, at least the precision.
//  - A sample is used once, and never one older than the last used.
//  - Popcorn spikes: a best sample that differs from the last used by more than 3 times the jitter
//    before it, and comes within two poll intervals of it, is not used; the second chance is after
//    these two intervals, so a real change passes. Not before the filter's dispersion is below
//    kMaxDistance (four samples): a jitter of two samples is none.
//
// Complexity: O(1), eight stages. Degenerate: delays below the precision count as the precision, a
// dispersion of 16 s or more as no sample; a sample with a number that is not finite is refused by
// an assertion.
//
// Source: RFC 5905 section 10; docs/reference/host_sync.md section 2 (gate 3, Allan intercept:
// ntp.h).
//
//   NtpClockFilter filter(1e-6);
//   const auto best = filter.add({offset_s, delay_s, dispersion_s, now_s}, 64);
//   if (best) use(best->offset_s);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_CLOCK_FILTER_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_CLOCK_FILTER_H_

#include <array>
#include <cstddef>
#include <optional>

namespace simbench {

struct NtpSample {
  double offset_s = 0;
  double delay_s = 0;
  double dispersion_s = 0;  // at `at_s`
  double at_s = 0;
};

class NtpClockFilter {
 public:
  static constexpr std::size_t kStages = 8;
  static constexpr double kMaxDispersion = 16;        // s
  static constexpr double kDispersionGrowth = 15e-6;  // s/s, PHI
  static constexpr double kAllanIntercept = 2048;     // s
  static constexpr double kPopcornGate = 3;           // times the jitter
  static constexpr double kMaxDistance = 1.5;         // s, MAXDIST

  explicit NtpClockFilter(double precision_s) : precision_s_(precision_s) { reset(); }

  // Samples must come in order of time. Returns the sample to discipline the clock by, if any.
  std::optional<NtpSample> add(const NtpSample& sample, double poll_interval_s,
                               bool is_starting = false);

  // A poll went unanswered: takes up a stage.
  void add_missing(double at_s);

  // The clock was stepped: what was measured before is void.
  void reset();

  double jitter_s() const { return jitter_s_; }
  double dispersion_s() const { return dispersion_s_; }
  // Half the delay of the best sample, plus dispersion and jitter: at most kMaxDistance if the
  // server may be used.
  double distance_s() const;

 private:
  void shift_in(const NtpSample& stage);
  // The stages in order of preference, as of `now_s`.
  std::array<NtpSample, kStages> ordered(double now_s) const;
  void update_statistics(const std::array<NtpSample, kStages>& by_delay);

  double precision_s_;
  std::array<NtpSample, kStages> stages_;  // newest first
  double newest_s_ = 0;                    // up to when the dispersions have grown
  std::optional<NtpSample> last_used_;
  double jitter_s_ = 0;
  double dispersion_s_ = kMaxDispersion;
  double best_delay_s_ = kMaxDispersion;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_NTP_CLOCK_FILTER_H_

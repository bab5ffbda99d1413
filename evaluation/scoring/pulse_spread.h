// The paper's two metrics for the frames of one pulse: their terms of AMD and RMDV.
//
//   AMD  = mean over pulses of spread_ms      (eq. 3)
//   RMDV = mean over pulses of deviation_ms   (eq. 4, with the square that is missing in print)
//
// Stamps are integer nanoseconds, results milliseconds. Differences are taken before the conversion
// to floating-point, so stamps of any epoch are exact; they must differ by less than 2^63 ns.
//
// For any stamps deviation_ms <= rmdv_bound() * spread_ms, and so RMDV <= bound * AMD: a published
// pair that breaks it cannot come from eq. (4). Source: docs/reference/paper.md sections 6 and 7.
//
// PrintedRmdv is eq. (4) as printed, without the square, to look at: its mean of sqrt(radicand)
// over pulses, the radicand being the mean signed difference from the median. No published value
// can come from it (section 6).
//
//   const std::vector<std::int64_t> stamps = {0, 1'000'000, 3'000'000};
//   spread_ms(stamps);                                            // 3
//   differences_from_median(stamps, MedianKind::kUpperMiddle, workspace)
//       .deviation_ms;                                            // sqrt((1 + 0 + 4) / 3)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scenarios/choices.h"

namespace simbench::evaluation {

using scenarios::MedianKind;

// Returns the largest minus the smallest. `stamps_ns` must not be empty. O(n).
double spread_ms(std::span<const std::int64_t> stamps_ns);

// What the stamps of a pulse differ by from their median.
struct Differences {
  double deviation_ms = 0;  // root mean square
  // Signed mean, which is the mean less the median: the radicand of eq. (4) as printed. For n
  // stamps it is from -1/2 to (n/2 - 1)/n of the spread, and negative where the mean is below the
  // median: in half of the pulses of a symmetric law, or more, as the upper-middle element is above
  // the middle.
  double mean_ms = 0;
};

// `stamps_ns` must not be empty. `workspace` is overwritten; kept by the caller, it saves an
// allocation per pulse. O(n).
Differences differences_from_median(std::span<const std::int64_t> stamps_ns, MedianKind kind,
                                    std::vector<std::int64_t>& workspace);

// Eq. (4) as printed, over pulses. A pulse with a negative radicand has no real root and is left
// out; real_share() tells how many are not.
class PrintedRmdv {
 public:
  void add(const Differences& pulse);
  // The mean root, in sqrt(ms); NaN without a pulse that has one.
  double mean_sqrt_ms() const;
  // Pulses that have one, of all; NaN without pulses.
  double real_share() const;

 private:
  std::int64_t pulses_ = 0;
  std::int64_t real_ = 0;
  double sum_ = 0;
};

// Returns the largest possible deviation_ms / spread_ms of n stamps: 1/sqrt(2) for the upper-middle
// median of an even number, 2/3 for the mean of the middle two of 18.
double rmdv_bound(std::size_t n, MedianKind kind);

}  // namespace simbench::evaluation

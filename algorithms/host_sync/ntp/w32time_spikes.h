// W32Time's protection against single wrong samples, as documented.
//
//  - Hold: the first kHoldPeriod samples, and as many after each accepted large offset, are taken
//    as they come, "to bring the local clock into synchronization quickly".
//  - Then an offset of kLargePhaseOffset or more is a spike: ignored, until such offsets have
//    persisted for kSpikeWatchPeriod. A smaller offset ends the suspicion.
//
// The documentation gives HoldPeriod without a unit; samples is an assumption.
// Source: docs/reference/host_sync.md section 2 (LargePhaseOffset, HoldPeriod, SpikeWatchPeriod);
// Microsoft, "Windows Time service tools and settings".
//
//   W32TimeSpikes spikes;
//   if (spikes.accept(offset, host.steady_clock().now())) ...correct the clock
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_W32TIME_SPIKES_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_W32TIME_SPIKES_H_

#include <optional>

#include "algorithms/ports/time.h"

namespace simbench {

class W32TimeSpikes {
 public:
  static constexpr Nanoseconds kLargePhaseOffset{5'000'000'000};
  static constexpr Nanoseconds kSpikeWatchPeriod{900'000'000'000};
  static constexpr int kHoldPeriod = 5;

  // Whether the clock may be corrected by a sample of this offset, taken at `at`.
  bool accept(Nanoseconds offset, SteadyTime at);

 private:
  int held_ = 0;                         // samples taken since the hold began
  std::optional<SteadyTime> suspicion_;  // when the first large offset of the present ones came
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_NTP_W32TIME_SPIKES_H_

#include "algorithms/host_sync/ntp/w32time_spikes.h"

namespace simbench {

bool W32TimeSpikes::accept(Nanoseconds offset, SteadyTime at) {
  const bool is_large = offset >= kLargePhaseOffset || offset <= -kLargePhaseOffset;
  if (held_ < kHoldPeriod) {
    ++held_;
    return true;
  }
  if (!is_large) {
    suspicion_.reset();
    return true;
  }
  if (!suspicion_) suspicion_ = at;
  if (at - *suspicion_ < kSpikeWatchPeriod) return false;
  suspicion_.reset();
  held_ = 0;
  return true;
}

}  // namespace simbench

#include "algorithms/device_time/clock_map.h"

#include <algorithm>
#include <cmath>

#include "laws/saturate.h"

namespace simbench {
namespace {

// The reading at `at` of a clock that read `reading` at `since`.
HostTime continued(HostTime reading, SteadyTime since, double rate_ppb, SteadyTime at) {
  const Int128 elapsed_ns = Int128{nanoseconds_of(at)} - nanoseconds_of(since);
  const std::int64_t gained_ns = saturate_round(to_double(elapsed_ns) * rate_ppb * 1e-9);
  return HostTime(Nanoseconds(saturate(nanoseconds_of(reading) + elapsed_ns + gained_ns)));
}

}  // namespace

void ClockMap::add(const ClockAdjustment& adjustment) {
  while (!segments_.empty() && segments_.back().at >= adjustment.at) segments_.pop_back();
  if (segments_.size() == kMaxSegments) segments_.pop_front();
  segments_.push_back(adjustment);
  if (!std::isfinite(adjustment.rate_ppb)) segments_.back().rate_ppb = 0;
}

std::optional<HostTime> ClockMap::to_system(SteadyTime steady) const {
  if (segments_.empty()) return std::nullopt;
  const auto next =
      std::upper_bound(segments_.begin(), segments_.end(), steady,
                       [](SteadyTime t, const ClockAdjustment& segment) { return t < segment.at; });
  if (next == segments_.begin()) {
    return continued(next->before, next->at, next->rate_ppb, steady);
  }
  const ClockAdjustment& segment = *(next - 1);
  return continued(segment.after, segment.at, segment.rate_ppb, steady);
}

}  // namespace simbench

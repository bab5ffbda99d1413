#include "algorithms/host_sync/cross_stamps.h"

namespace simbench {

Task<CrossStamp> narrowest_cross_stamp(Host& host) {
  CrossStamp best;
  Nanoseconds width = Nanoseconds::max();
  for (int i = 0; i < kCrossStampReadings; ++i) {
    const CrossStamp stamp = co_await host.hardware_clock()->cross_stamp();
    if (stamp.after - stamp.before >= width) continue;
    best = stamp;
    width = stamp.after - stamp.before;
  }
  co_return best;
}

}  // namespace simbench

// The network card's clock against the system clock: of several cross stamps the narrowest, whose
// middle is the least uncertain, as phc2sys and chronyd take it.
//
//   const CrossStamp stamp = co_await narrowest_cross_stamp(host);
#pragma once

#include "algorithms/ports/host.h"

namespace simbench {

inline constexpr int kCrossStampReadings = 5;  // phc2sys' default (-N)

// The narrowest of kCrossStampReadings readings. The host must have a hardware clock.
Task<CrossStamp> narrowest_cross_stamp(Host& host);

}  // namespace simbench

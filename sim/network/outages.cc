#include "sim/network/outages.h"

#include <algorithm>

namespace simbench::sim {

Outages::Outages(const std::vector<scenarios::Fault>& faults) {
  for (const scenarios::Fault& fault : faults) {
    const bool of_link = fault.kind == "link_stops";
    if (!of_link && fault.kind != "host_stops") continue;
    const Nanoseconds begin = from_ms(fault.at_ms);
    outages_.push_back({.host = static_cast<PeerId>(fault.host),
                        .of_link = of_link,
                        .begin = begin,
                        .end = begin + from_ms(fault.duration_ms)});
  }
}

void Outages::start(TrueTime capture_start) { start_ = capture_start; }

bool Outages::stopped(PeerId host, TrueTime at, bool or_its_link) const {
  if (at < start_) return false;
  const Nanoseconds since_start = at - start_;
  return std::any_of(outages_.begin(), outages_.end(), [&](const Outage& outage) {
    return outage.host == host && (or_its_link || !outage.of_link) && since_start >= outage.begin &&
           since_start < outage.end;
  });
}

}  // namespace simbench::sim

#include "sim/faults/faults.h"

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

bool Outages::stopped(PeerId host, TrueTime at, bool or_its_link) const {
  if (at < start_) return false;
  const Nanoseconds since_start = at - start_;
  return std::any_of(outages_.begin(), outages_.end(), [&](const Outage& outage) {
    return outage.host == host && (or_its_link || !outage.of_link) && since_start >= outage.begin &&
           since_start < outage.end;
  });
}

CameraFaults::CameraFaults(const std::vector<scenarios::Fault>& faults) {
  for (const scenarios::Fault& fault : faults) {
    const auto camera = static_cast<std::uint32_t>(fault.camera);
    if (fault.kind == "camera_vanishes") {
      absences_.push_back({camera, fault.at_ms, fault.at_ms + fault.duration_ms});
    } else if (fault.kind == "late_first_frame") {
      late_frames_.push_back({camera, fault.at_ms, fault.duration_ms * 1e6, false});
    }
  }
}

bool CameraFaults::vanished(std::uint32_t camera, TrueTime at) const {
  if (absences_.empty() || at < start_) return false;
  const double since_start_ms = to_ms(at - start_);
  return std::any_of(absences_.begin(), absences_.end(), [&](const Absence& absence) {
    return absence.camera == camera && since_start_ms >= absence.begin_ms &&
           since_start_ms < absence.end_ms;
  });
}

double CameraFaults::take_delay_ns(std::uint32_t camera, TrueTime at) {
  double delay_ns = 0;
  for (LateFrame& late : late_frames_) {
    if (late.taken || late.camera != camera || to_ms(at - start_) < late.from_ms) continue;
    late.taken = true;
    delay_ns += late.delay_ns;
  }
  return delay_ns;
}

}  // namespace simbench::sim

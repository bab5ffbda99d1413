#include "sim/faults/faults.h"

#include <algorithm>
#include <variant>

namespace simbench::sim {

Outages::Outages(const std::vector<scenarios::Fault>& faults) {
  const auto add = [this](const auto& stop, bool of_link) {
    const Nanoseconds begin = from_ms(stop.at_ms);
    outages_.push_back({.host = static_cast<PeerId>(stop.host),
                        .of_link = of_link,
                        .begin = begin,
                        .end = begin + from_ms(stop.duration_ms)});
  };
  for (const scenarios::Fault& fault : faults) {
    if (const auto* host = std::get_if<scenarios::HostStops>(&fault)) add(*host, false);
    if (const auto* link = std::get_if<scenarios::LinkStops>(&fault)) add(*link, true);
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
    if (const auto* gone = std::get_if<scenarios::CameraVanishes>(&fault)) {
      absences_.push_back(
          {static_cast<std::uint32_t>(gone->camera), gone->at_ms, gone->at_ms + gone->duration_ms});
    } else if (const auto* late = std::get_if<scenarios::LateFirstFrame>(&fault)) {
      late_frames_.push_back(
          {static_cast<std::uint32_t>(late->camera), late->duration_ms * 1e6, false});
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

double CameraFaults::take_delay_ns(std::uint32_t camera) {
  double delay_ns = 0;
  for (LateFrame& late : late_frames_) {
    if (late.taken || late.camera != camera) continue;
    late.taken = true;
    delay_ns += late.delay_ns;
  }
  return delay_ns;
}

}  // namespace simbench::sim

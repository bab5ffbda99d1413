#include "algorithms/ports/frame_control.h"

#include <string>

namespace simbench {

std::string refusal_of(const FrameControlLimits& limits, FrameControlKind kind,
                       Nanoseconds length) {
  if (!limits.allows(kind)) {
    return "the camera has no control " + std::string(name_of(kind));
  }
  if (kind == FrameControlKind::kStartAt) return "";
  const auto in_ms = [](Nanoseconds time) { return std::to_string(to_ms(time)) + " ms"; };
  if (length < limits.shortest || length > limits.longest) {
    return "found a frame of " + in_ms(length) + ", allowed: " + in_ms(limits.shortest) + " to " +
           in_ms(limits.longest);
  }
  if (kind != FrameControlKind::kInsertFrame && length < limits.exposure) {
    return "found a frame of " + in_ms(length) + ", allowed: not below the exposure of " +
           in_ms(limits.exposure);
  }
  return "";
}

std::string refusal_of_start(const FrameControlLimits& limits, HostTime at, HostTime now) {
  std::string refused = refusal_of(limits, FrameControlKind::kStartAt, {});
  if (!refused.empty() || at > now) return refused;
  return "found a start " + std::to_string(to_ms(now - at)) + " ms ago, allowed: one to come";
}

}  // namespace simbench

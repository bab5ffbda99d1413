// The index of a frame's trigger pulse in a GenLock capture, from its sensor stamp.
//
// All cameras of a GenLock capture start with one common pulse, so a camera's first frame has index
// 0 and later ones follow from the time since then in periods. Two variants:
//
//   kReanchored   adds round((s - s_previous) / period) for every frame. The rate difference of
//                 camera and trigger counts over one interval only, so it never adds up.
//   kFirstStamp   round((s - s_first) / period), as the paper has it: at a rate difference of e it
//                 is off by one after period / (2 e) - with 575 ppm (trigger 500, camera 75) after
//                 870 frames, 19 s at 45 FPS.
//
// Re-anchored indices are exact while, for every two consecutive frames, the change of stamp error
// plus gap * period * e is below half a period: with jitter below a quarter of a period less that,
// and gaps of lost frames up to 1 / (2 e). A camera that loses its first frame is off by one.
//
// Source: docs/reference/paper.md section 8, docs/design.md section 8.
//
//   GenlockOrder order(from_ms(1000.0 / 45), GenlockOrder::Variant::kReanchored);
//   std::int64_t index = order.next(frame.sensor);   // one object per camera
#pragma once

#include <cstdint>
#include <optional>

#include "algorithms/ports/time.h"

namespace simbench {

class GenlockOrder {
 public:
  enum class Variant : std::uint8_t { kReanchored, kFirstStamp };

  // `period` is the nominal frame period, positive.
  GenlockOrder(Nanoseconds period, Variant variant);

  // The index of the camera's next frame, by its unwrapped sensor stamp.
  std::int64_t next(DeviceTime sensor) {
    if (!anchor_) anchor_ = sensor;
    const std::int64_t elapsed_ns = nanoseconds_of(sensor) - nanoseconds_of(*anchor_);
    const std::int64_t index = anchor_index_ + periods_in(elapsed_ns);
    if (variant_ == Variant::kReanchored) {
      anchor_ = sensor;
      anchor_index_ = index;
    }
    return index;
  }

 private:
  std::int64_t periods_in(std::int64_t elapsed_ns) const {
    // One, nearly always: from half a period to one and a half, without a division.
    const auto period = static_cast<std::uint64_t>(period_ns_);
    const bool is_one = static_cast<std::uint64_t>(elapsed_ns) - (period + 1) / 2 < period;
    return is_one ? 1 : rounded_quotient(elapsed_ns, period_ns_);
  }
  static std::int64_t rounded_quotient(std::int64_t elapsed_ns, std::int64_t period_ns);

  std::int64_t period_ns_;
  Variant variant_;
  std::optional<DeviceTime> anchor_;
  std::int64_t anchor_index_ = 0;
};

}  // namespace simbench

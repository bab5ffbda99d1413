// Controls of a camera that there is not: what was asked of it.
#pragma once

#include <utility>
#include <vector>

#include "clocks/frame_lengths.h"
#include "hardware/camera/camera.h"
#include "tests/hardware/camera/steering_values.h"

namespace simbench::hardware {

// One thread, as the node's is.
class MadeUpSteering final : public CameraSteering {
 public:
  explicit MadeUpSteering(const FrameSteering& settings = steering_settings())
      : requests_(settings.limits) {}

  const FrameControlLimits& limits() const override { return requests_.limits(); }
  FrameControlReply control(FrameControlKind kind, Nanoseconds value) override {
    controls.emplace_back(kind, value);
    return requests_.reply(kind, value);
  }
  FrameControlReply start_at(MonotonicTime at) override {
    starts.push_back(at);
    asked.push_back(monotonic_now());
    return requests_.reply(FrameControlKind::kStartAt, {});
  }

  std::vector<std::pair<FrameControlKind, Nanoseconds>> controls;
  std::vector<MonotonicTime> starts;
  std::vector<MonotonicTime> asked;  // when it was asked for each

 private:
  clocks::FrameRequests requests_;
};

}  // namespace simbench::hardware

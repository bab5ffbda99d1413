#include "scenarios/frame_limits.h"

#include <cstdint>

namespace simbench::scenarios {

FrameControlLimits frame_limits(const Scenario& scenario) {
  const FrameControlModel& model = *scenario.cameras.frame_control;
  return {.frame_length = from_ms(scenario.trigger.period_ms()),
          .shortest = from_ms(model.shortest_ms),
          .longest = from_ms(model.longest_ms),
          .granularity = from_us(model.granularity_us),
          .exposure = from_ms(scenario.cameras.exposure_ms),
          .latency_frames = static_cast<std::uint32_t>(model.latency_frames),
          .allowed = {model.adjust_frame, model.insert_frame, model.frame_length, model.start_at}};
}

}  // namespace simbench::scenarios

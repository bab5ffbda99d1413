// Who is told of every frame at the instant of its delivery, besides the recording.
#ifndef SIMBENCH_SIM_RIG_FRAME_OBSERVER_H_
#define SIMBENCH_SIM_RIG_FRAME_OBSERVER_H_

#include <cstdint>

#include "recording/recording.h"

namespace simbench::sim {

class FrameObserver {
 public:
  virtual ~FrameObserver() = default;
  // `bytes` is the size of the image.
  virtual void on_delivery(std::uint32_t host, const FrameRecord& frame, double bytes) = 0;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_FRAME_OBSERVER_H_

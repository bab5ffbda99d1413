#include "algorithms/gathering/frame_queues.h"

namespace simbench {

FrameQueues::FrameQueues(std::uint32_t sources, std::uint32_t capacity) : capacity_(capacity) {
  SIMBENCH_ASSERT(sources > 0, "gathering needs a source");
  SIMBENCH_ASSERT(capacity > 0, "a queue needs room for one frame");
  queues_.resize(sources);
  slab_.resize(std::size_t{sources} * capacity);
  taken_.resize(sources);
}

std::span<const GatherFrame> FrameQueues::take_fronts() {
  SIMBENCH_ASSERT(all_waiting(), "a source without a frame has no front");
  for (std::uint32_t source = 0; source < queues_.size(); ++source) {
    taken_[source] = front(source);
    pop(source);
  }
  return taken_;
}

}  // namespace simbench

// Frames waiting to be gathered: a bounded queue per source, in one slab of memory.
//
// The store under the policies that compare fronts. It keeps order and counts; what is given up and
// when is the policy's business. Nothing is allocated after construction.
//
// gather_key() is a frame's stamp as the integer that policies compare: nanoseconds, where stamps
// further than 146 years from zero count as that far, so that two of them always subtract.
//
//   FrameQueues queues(sources, capacity);
//   if (queues.size(frame.source) == capacity) queues.pop(frame.source);
//   queues.push(frame);
//   if (queues.all_waiting()) sink.on_set(queues.take_fronts());
#ifndef SIMBENCH_ALGORITHMS_GATHERING_FRAME_QUEUES_H_
#define SIMBENCH_ALGORITHMS_GATHERING_FRAME_QUEUES_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "algorithms/ports/assert.h"

namespace simbench {

inline constexpr std::int64_t kFarthestKey = (std::int64_t{1} << 62) - 1;

inline std::int64_t gather_key(const GatherFrame& frame) {
  return std::clamp(nanoseconds_of(frame.stamp), -kFarthestKey, kFarthestKey);
}

class FrameQueues {
 public:
  // Both at least 1. `capacity` is per source.
  FrameQueues(std::uint32_t sources, std::uint32_t capacity);

  std::uint32_t sources() const { return static_cast<std::uint32_t>(queues_.size()); }
  std::uint32_t size(std::uint32_t source) const { return queues_[source].size; }
  bool empty(std::uint32_t source) const { return queues_[source].size == 0; }
  // Whether every source has a frame.
  bool all_waiting() const { return waiting_ == queues_.size(); }

  // `index` counts from the front and is below size(source).
  const GatherFrame& at(std::uint32_t source, std::uint32_t index) const {
    std::uint32_t place = queues_[source].head + index;
    if (place >= capacity_) place -= capacity_;
    return slab_[std::size_t{source} * capacity_ + place];
  }
  const GatherFrame& front(std::uint32_t source) const { return at(source, 0); }

  // The source must exist and have room.
  void push(const GatherFrame& frame) {
    SIMBENCH_ASSERT(frame.source < queues_.size(), "a frame of a source that does not exist");
    Queue& queue = queues_[frame.source];
    SIMBENCH_ASSERT(queue.size < capacity_, "a full queue has no room");
    std::uint32_t place = queue.head + queue.size;
    if (place >= capacity_) place -= capacity_;
    slab_[std::size_t{frame.source} * capacity_ + place] = frame;
    if (queue.size++ == 0) ++waiting_;
  }

  // Removes the front of a queue that is not empty.
  void pop(std::uint32_t source) {
    Queue& queue = queues_[source];
    if (--queue.size == 0) {
      queue.head = 0;  // an idle queue uses one place over and over, which stays in the cache
      --waiting_;
    } else if (++queue.head == capacity_) {
      queue.head = 0;
    }
  }

  // Removes every front; all queues must have one. Valid until the next call.
  std::span<const GatherFrame> take_fronts();

 private:
  struct Queue {
    std::uint32_t head = 0;
    std::uint32_t size = 0;
  };

  std::uint32_t capacity_;
  std::uint32_t waiting_ = 0;  // queues that are not empty
  std::vector<Queue> queues_;
  std::vector<GatherFrame> slab_;  // capacity_ per source
  std::vector<GatherFrame> taken_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_FRAME_QUEUES_H_

// The rule of Algorithm 3 over integer keys: match the fronts of n queues, or drop the earliest.
//
// While no queue is empty: if the keys of the fronts lie less than `tolerance` apart, the fronts
// are a set and all are popped; else the front with the smallest key is given up (of equal ones,
// that of the lowest source). With stamps for keys this is Algorithm 3; with frame indices and
// tolerance 1 it is gathering by GenLock order.
//
// Keys of a source normally increase; if they do not, frames still leave in the order they came.
//
// Complexity: O(1) amortised per frame while all frames match, O(log n) per frame given up: the
// fronts lie side by side in order of source, and a heap over them is made only when one must be
// dropped. Memory: one slab of n * queue_limit frames, allocated when made; nothing per frame.
//
// Source: docs/reference/paper.md section 5.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_FRONT_MATCHER_H_
#define SIMBENCH_ALGORITHMS_GATHERING_FRONT_MATCHER_H_

#include <cstdint>
#include <vector>

#include "algorithms/gathering/gathering.h"

namespace simbench {

class FrontMatcher {
 public:
  // All at least 1. `queue_limit` counts the front.
  FrontMatcher(std::uint32_t sources, std::int64_t tolerance, std::uint32_t queue_limit);

  // Adds the frame to its source's queue (dropping the oldest of a full one), then matches.
  void push(std::int64_t key, const GatherFrame& frame, FrameSetSink& sink);
  std::uint64_t discarded() const { return discarded_; }

 private:
  struct Waiting {
    std::int64_t key = 0;
    GatherFrame frame;
  };
  struct Queue {
    std::uint32_t length = 0;  // with the front; 0: empty
    std::uint32_t head = 0;    // of the ring behind the front
  };

  void enqueue(std::uint32_t source, std::int64_t key, const GatherFrame& frame);
  void pop_front(std::uint32_t source);
  void match(FrameSetSink& sink);
  bool fronts_match();
  void drop_earliest();
  void heap_push(std::uint32_t source);
  // Order of the heap: by key, then by source.
  auto later() const;

  std::int64_t tolerance_;
  std::uint32_t ring_size_;
  std::uint32_t waiting_sources_ = 0;  // whose queues are not empty
  std::uint64_t discarded_ = 0;
  std::vector<Queue> queues_;
  std::vector<std::int64_t> keys_;   // of the fronts, by source
  std::vector<GatherFrame> fronts_;  // by source
  std::vector<Waiting> rings_;       // behind the fronts: ring_size_ per source
  // While a set is being searched: the sources that have a front, the earliest first. Else empty.
  std::vector<std::uint32_t> heap_;
  std::int64_t latest_ = 0;  // of the fronts, while a set is being searched
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_FRONT_MATCHER_H_

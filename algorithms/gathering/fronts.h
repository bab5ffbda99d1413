// Parts of the policies that compare the fronts of n queues: the queues, the matcher of Algorithm
// 3, and the tournament of the earliest and latest front.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "algorithms/ports/assert.h"

namespace simbench {

// Frames waiting to be gathered: a bounded queue per source, in one slab of memory.
//
// It keeps order and counts; the policy decides which frames it discards. Nothing is allocated
// after construction.
//
// gather_key() is a frame's stamp as the integer that policies compare: nanoseconds, where stamps
// further than 146 years from zero count as that far, so that two of them always subtract.
//
//   FrameQueues queues(sources, capacity);
//   if (queues.size(frame.source) == capacity) queues.pop(frame.source);
//   queues.push(frame);
//   if (queues.all_waiting()) set_sink.on_set(queues.take_fronts());
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

// The rule of Algorithm 3 over integer keys: match the fronts of n queues, or drop the earliest.
//
// While no queue is empty: if the keys of the fronts lie less than `tolerance` apart, the fronts
// are a set and all are popped; else the front with the smallest key is discarded (of equal ones,
// that of the lowest source). With stamps for keys this is Algorithm 3; with frame indices and
// tolerance 1 it is gathering by GenLock order.
//
// Keys of a source normally increase; if they do not, frames still leave in the order they came.
//
// Complexity: O(1) amortised per frame while all frames match, O(log n) per discarded frame: the
// fronts lie side by side in order of source, and a heap over them is made only to discard one.
//
// Memory: room for kFirstQueue frames a source, or queue_limit if that is less, of 48 bytes each. A
// queue that becomes longer than it ever was doubles; nothing else is allocated after construction.
// Without a limit, frames wait as long as a source is silent, and no shorter queue gives the same
// sets: the next stamp of that source may be as old as the oldest frame that waits. The capture is
// the bound: if a source never delivers again, the others' frames wait until its end.
//
// Source: docs/reference/paper.md section 5.
class FrontMatcher {
 public:
  static constexpr std::uint32_t kFirstQueue = 64;

  // `sources` and a stated `queue_limit` are at least 1. The limit counts the front; without one,
  // any number may wait.
  FrontMatcher(std::uint32_t sources, std::int64_t tolerance,
               std::optional<std::uint32_t> queue_limit);

  // Adds the frame to its source's queue (dropping the oldest of a full one), then matches.
  void push(std::int64_t key, const GatherFrame& frame, FrameSetSink& sink) {
    SIMBENCH_ASSERT(frame.source < queues_.size(), "a frame of a source that does not exist");
    enqueue(frame.source, key, frame);
    if (waiting_sources_ == queues_.size()) match(sink);
  }
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
  using Ring = std::vector<Waiting>;

  void enqueue(std::uint32_t source, std::int64_t key, const GatherFrame& frame) {
    Queue& queue = queues_[source];
    if (queue.length == rings_[source].size() + 1) make_room(source);
    if (queue.length == 0) {
      ++waiting_sources_;
      keys_[source] = key;
      fronts_[source] = frame;
      if (!heap_.empty()) heap_push(source);
    } else {
      Ring& ring = rings_[source];
      std::size_t tail = std::size_t{queue.head} + queue.length - 1;
      if (tail >= ring.size()) tail -= ring.size();
      ring[tail] = {.key = key, .frame = frame};
      ++behind_;
    }
    ++queue.length;
  }
  // Makes a full queue longer if the limit allows it, else drops its oldest frame.
  void make_room(std::uint32_t source);
  void pop_front(std::uint32_t source);
  void match(FrameSetSink& sink);
  bool fronts_match();
  void pop_fronts();
  void drop_earliest();
  void heap_push(std::uint32_t source);
  // Order of the heap: by key, then by source.
  auto later() const;

  std::int64_t tolerance_;
  std::uint32_t queue_limit_;
  std::uint32_t waiting_sources_ = 0;  // whose queues are not empty
  std::uint64_t behind_ = 0;           // frames that wait behind the fronts
  std::uint64_t discarded_ = 0;
  std::vector<Queue> queues_;
  std::vector<std::int64_t> keys_;   // of the fronts, by source
  std::vector<GatherFrame> fronts_;  // by source
  std::vector<Ring> rings_;          // behind the fronts, by source
  // While a set is being searched: the sources that have a front, the earliest first. Else empty.
  std::vector<std::uint32_t> heap_;
  std::int64_t latest_ = 0;  // of the fronts, while a set is being searched
};

// The earliest and the latest of n fronts, while single ones change.
//
// A tournament tree over one integer key per source. If keys are equal, the lowest source is the
// earliest and the highest source the latest.
//
// Complexity: O(log n) per changed key at most (mostly less: the walk ends where nothing changes);
// O(n) once after forget(), which is for changing most of them at once. Memory: 16 bytes a source
// and a key, allocated when made.
//
//   FrontTournament fronts(sources);
//   fronts.set(3, key);              // for all sources, before the first query
//   auto range = fronts.key(fronts.latest()) - fronts.key(fronts.earliest());
class FrontTournament {
 public:
  explicit FrontTournament(std::uint32_t sources);

  void set(std::uint32_t source, std::int64_t key) {
    keys_[source] = key;
    if (played_) replay(source);
  }
  std::int64_t key(std::uint32_t source) const { return keys_[source]; }

  // Until the next query, set() only stores keys.
  void forget() { played_ = false; }

  std::uint32_t earliest() { return champions().earliest; }
  std::uint32_t latest() { return champions().latest; }

 private:
  struct Node {
    std::uint32_t earliest = 0;
    std::uint32_t latest = 0;
    friend bool operator==(const Node&, const Node&) = default;
  };

  const Node& champions() {
    if (!played_) play_all();
    return nodes_[1];
  }
  Node play(const Node& a, const Node& b) const;
  void play_all();
  void replay(std::uint32_t source);

  std::vector<std::int64_t> keys_;
  std::vector<Node> nodes_;  // the children of i are 2i and 2i + 1; leaves from sources on
  bool played_ = false;
};

}  // namespace simbench

// The queue of pending events: pops them in the order (time, order of insertion).
//
// Two structures behind one interface. Up to a few hundred pending events everything lies in a
// 4-ary heap with an open root (open_heap.h). When more are pending, the heap spills into a ladder
// (ladder.h), which keeps the far future in unsorted buckets and hands out the near future in
// sorted runs; the heap then only holds what is scheduled into the near future meanwhile, and an
// event is popped from whichever of run and heap has the earlier one. When few are left, the
// ladder empties itself. Entries carry their sequence number wherever they lie, so a change of
// structure cannot change the order.
//
// Complexity: O(log n) for few pending events, amortised O(1) for many. No allocation in steady
// state. Reference: event_engine.md, section 2.
#ifndef SIMBENCH_SIM_ENGINE_EVENT_QUEUE_H_
#define SIMBENCH_SIM_ENGINE_EVENT_QUEUE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/engine/ladder.h"
#include "sim/engine/open_heap.h"
#include "sim/engine/queue_entry.h"

namespace simbench::sim {

class EventQueue {
 public:
  std::size_t size() const { return heap_.size() + run_.size() + ladder_.size(); }

  void push(const Event& event) { insert({.event = event, .sequence = next_sequence_++}); }

  // Takes the earliest event if it is not later than `last`. False, and `event` untouched, if
  // there is none.
  bool pop_through(TrueTime last, Event& event) {
    if (run_.empty() && heap_.empty() && !refill()) return false;
    if (!run_.empty() && (heap_.empty() || earlier(run_.back(), heap_.top()))) {
      if (run_.back().event.time > last) return false;
      event = run_.back().event;
      run_.pop_back();
      return true;
    }
    const QueueEntry& top = heap_.top();
    if (top.event.time > last) return false;
    event = top.event;
    heap_.pop();
    return true;
  }

  // The earliest event, until the queue is changed; null if there is none.
  const Event* first() {
    if (run_.empty() && heap_.empty() && !refill()) return nullptr;
    const bool from_run = !run_.empty() && (heap_.empty() || earlier(run_.back(), heap_.top()));
    return from_run ? &run_.back().event : &heap_.top().event;
  }

  // Removes the events for which `is_unwanted(event)` returns true. O(n).
  template <class Predicate>
  void erase_if(Predicate is_unwanted) {
    std::vector<QueueEntry> entries;
    drain(entries);
    for (const QueueEntry& entry : entries) {
      if (!is_unwanted(entry.event)) insert(entry);
    }
  }

 private:
  // Pending events from which the ladder is faster than the heap, found by measurement
  // (engine_workloads w1 with 100 to 2000 timers).
  static constexpr std::size_t kHeapEntries = 512;

  void insert(const QueueEntry& entry) {
    if (entry.event.time.time_since_epoch().count() < ladder_.start_ns()) {
      heap_.push(entry);
      // While a long run is being popped, spilling again and again what comes before its end would
      // cost more than a deeper heap.
      if (heap_.size() > kHeapEntries + run_.size()) [[unlikely]]
        spill();
    } else {
      ladder_.push(entry);
    }
  }

  bool refill();
  void spill();
  void drain_near(std::vector<QueueEntry>& out);
  void drain(std::vector<QueueEntry>& out);

  OpenHeap heap_;                // pending events before the ladder's start, except the run
  std::vector<QueueEntry> run_;  // the run being popped, latest first
  Ladder ladder_;
  std::vector<QueueEntry> spilled_;  // scratch of spill()
  std::uint64_t next_sequence_ = 0;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_ENGINE_EVENT_QUEUE_H_

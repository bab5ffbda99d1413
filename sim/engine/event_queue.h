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
// state. Reference: docs/reference/event_engine.md section 2.
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

  void push(TrueTime time, std::uint64_t payload) {
    insert({.time_ns = time.time_since_epoch().count(),
            .payload = payload,
            .sequence = next_sequence_++});
  }

  // Takes the earliest entry if it is not later than `last`. False, and `entry` untouched, if there
  // is none.
  bool pop_through(TrueTime last, QueueEntry& entry) {
    const QueueEntry* const earliest = first();
    if (earliest == nullptr || earliest->time_ns > last.time_since_epoch().count()) return false;
    entry = *earliest;
    if (is_from_run(earliest)) {
      run_.pop_back();
    } else {
      heap_.pop();
    }
    return true;
  }

  // The earliest entry, until the queue is changed; null if there is none.
  const QueueEntry* first() {
    if (!run_.empty()) {
      return heap_.empty() || earlier(run_.back(), heap_.top()) ? &run_.back() : &heap_.top();
    }
    if (!heap_.empty()) return &heap_.top();
    return refill() ? &run_.back() : nullptr;
  }

  // Removes the entries for which `is_unwanted(entry)` returns true. O(n).
  template <class Predicate>
  void erase_if(Predicate is_unwanted) {
    drain(drained_);
    for (const QueueEntry& entry : drained_) {
      if (!is_unwanted(entry)) insert(entry);
    }
    drained_.clear();
  }

 private:
  // Pending events from which the ladder is faster than the heap, found by measurement
  // (engine_workloads w1 with 100 to 2000 timers).
  static constexpr std::size_t kHeapEntries = 512;

  void insert(QueueEntry entry) {
    if (entry.time_ns >= ladder_.start_ns()) {
      ladder_.push(entry.time_ns, entry.payload, entry.sequence);
    } else if (!heap_.push(entry)) [[unlikely]] {
      insert_into_full_heap(entry.time_ns, entry.payload, entry.sequence);
    }
  }

  bool is_from_run(const QueueEntry* entry) const { return !run_.empty() && entry == &run_.back(); }

  bool refill();
  void insert_into_full_heap(std::int64_t time_ns, std::uint64_t payload, std::uint64_t sequence);
  void make_room_in_heap();
  void drain_near(std::vector<QueueEntry>& out);
  void drain(std::vector<QueueEntry>& out);

  OpenHeap heap_;                // pending events before the ladder's start, except the run
  std::vector<QueueEntry> run_;  // the run being popped, latest first
  Ladder ladder_;
  std::vector<QueueEntry> spilled_;  // scratch of make_room_in_heap()
  std::vector<QueueEntry> drained_;  // scratch of erase_if()
  std::uint64_t next_sequence_ = 0;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_ENGINE_EVENT_QUEUE_H_

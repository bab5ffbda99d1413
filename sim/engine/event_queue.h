// The queue of pending events: pops them in the order (time, order of insertion).
//
// Two structures behind one interface. Up to a few hundred pending events everything lies in a
// tournament (tournament.h). When more are pending, it spills into a ladder (ladder.h), which keeps
// the far future in unsorted buckets and hands out the near future in sorted runs; the tournament
// then only holds what is scheduled into the near future meanwhile, and an event is popped from
// whichever of the two has the earlier one. When few are left, the ladder empties itself. Entries
// carry their sequence number wherever they lie, so a change of structure cannot change the order.
//
// Complexity: O(log n) for few pending events, amortised O(1) for many. No allocation in steady
// state. Reference: docs/reference/event_engine.md section 2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/engine/ladder.h"
#include "sim/engine/queue_entry.h"
#include "sim/engine/tournament.h"

namespace simbench::sim {

class EventQueue {
 public:
  std::size_t size() const { return near_.size() + run_.size() + ladder_.size(); }

  void push(TrueTime time, std::uint64_t payload) {
    insert({.time_ns = time.time_since_epoch().count(),
            .payload = payload,
            .sequence = next_sequence_++});
  }

  // Takes the earliest entry if it is not later than `last`. False, and `entry` untouched, if there
  // is none.
  bool pop_through(TrueTime last, QueueEntry& entry) {
    const std::int64_t last_ns = last.time_since_epoch().count();
    if (!near_.empty()) {
      const QueueEntry near = near_.first();
      if (run_.empty() || earlier(near, run_.back())) {
        if (near.time_ns > last_ns) return false;
        near_.pop();
        entry = near;
        return true;
      }
    } else if (run_.empty() && !refill()) {
      return false;
    }
    if (run_.back().time_ns > last_ns) return false;
    entry = run_.back();
    run_.pop_back();
    return true;
  }

  // The earliest entry; none if there is none.
  std::optional<QueueEntry> first() {
    if (run_.empty() && near_.empty() && !refill()) return std::nullopt;
    if (near_.empty()) return run_.back();
    const QueueEntry near = near_.first();
    return run_.empty() || earlier(near, run_.back()) ? near : run_.back();
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
  // Pending events from which the ladder is faster than a tournament alone, found by measurement
  // (engine_workloads w1 with 100 to 2000 timers).
  static constexpr std::size_t kNearEntries = 4096;

  void insert(QueueEntry entry) {
    if (entry.time_ns >= ladder_.start_ns()) {
      ladder_.push(entry.time_ns, entry.payload, entry.sequence);
    } else if (!near_.add(entry)) [[unlikely]] {
      insert_into_full(entry.time_ns, entry.payload, entry.sequence);
    }
  }

  bool refill();
  void insert_into_full(std::int64_t time_ns, std::uint64_t payload, std::uint64_t sequence);
  void make_room();
  void drain_near(std::vector<QueueEntry>& out);
  void drain(std::vector<QueueEntry>& out);

  Tournament near_;              // pending events before the ladder's start, except the run
  std::vector<QueueEntry> run_;  // the run being popped, latest first
  Ladder ladder_;
  std::vector<QueueEntry> spilled_;  // scratch of make_room()
  std::vector<QueueEntry> drained_;  // scratch of erase_if()
  std::uint64_t next_sequence_ = 0;
};

}  // namespace simbench::sim

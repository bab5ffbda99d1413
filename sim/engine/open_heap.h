// A 4-ary min-heap of queue entries whose pop leaves the root open.
//
// A discrete-event simulation mostly pops one event and pushes its successor. A plain heap then
// moves two entries through its whole depth; this one leaves the root empty after a pop, and the
// next push sinks from there, so the pair costs one pass. Only a pop that follows a pop has to
// close the root with the last entry first.
//
// Complexity: push and pop O(log4 n). No allocation once the capacity has been reached.
#ifndef SIMBENCH_SIM_ENGINE_OPEN_HEAP_H_
#define SIMBENCH_SIM_ENGINE_OPEN_HEAP_H_

#include <cstddef>
#include <limits>
#include <vector>

#include "sim/engine/queue_entry.h"

namespace simbench::sim {

class OpenHeap {
 public:
  std::size_t size() const { return used_ - (root_is_open_ ? 1 : 0); }
  std::size_t capacity() const { return capacity_; }
  bool empty() const { return used_ == (root_is_open_ ? 1 : 0); }

  // False, and nothing done, if the heap has no place left: grow() or drain() it then.
  bool push(QueueEntry entry) {
    if (root_is_open_) {
      root_is_open_ = false;
      sink_from_root(entry);
      return true;
    }
    if (used_ == capacity_) [[unlikely]]
      return false;
    rise(used_++, entry);
    return true;
  }

  // Doubles the number of places.
  void grow();

  // The earliest entry. The heap must not be empty.
  const QueueEntry& top() {
    if (root_is_open_) close_root();
    return places_[0];
  }

  // Removes the entry that top() has just returned.
  void pop() { root_is_open_ = true; }

  // Moves all entries, in no particular order, to the end of `out`.
  void drain(std::vector<QueueEntry>& out);

 private:
  static constexpr std::size_t kChildren = 4;
  static constexpr std::size_t kFirstCapacity = 64;

  // Later than any event. Every place from used_ on holds it, so that a group of children can be
  // compared without asking how many of them exist.
  static constexpr QueueEntry last_of_all() {
    return {.time_ns = std::numeric_limits<std::int64_t>::max(),
            .sequence = std::numeric_limits<std::uint64_t>::max()};
  }

  void close_root() {
    root_is_open_ = false;
    const QueueEntry last = places_[--used_];
    places_[used_] = last_of_all();
    if (used_ > 0) sink_from_root(last);
  }

  void sink_from_root(QueueEntry entry) {
    QueueEntry* const root = places_.data();
    const QueueEntry* const end = root + used_;
    const QueueKey key = entry.key();
    QueueEntry* hole = root;
    for (QueueEntry* child = root + 1; child < end; child = root + kChildren * (hole - root) + 1) {
      QueueEntry* const left = child + static_cast<int>(earlier(child[1], child[0]));
      QueueEntry* const right = child + 2 + static_cast<int>(earlier(child[3], child[2]));
      QueueEntry* const best = earlier(*right, *left) ? right : left;
      if (key < best->key()) break;
      *hole = *best;
      hole = best;
    }
    *hole = entry;
  }

  void rise(std::size_t hole, QueueEntry entry) {
    QueueEntry* const places = places_.data();
    while (hole > 0) {
      const std::size_t parent = (hole - 1) / kChildren;
      if (!earlier(entry, places[parent])) break;
      places[hole] = places[parent];
      hole = parent;
    }
    places[hole] = entry;
  }

  std::vector<QueueEntry> places_;  // capacity_ and a group of children
  std::size_t capacity_ = 0;
  std::size_t used_ = 0;       // places in use, an open root included
  bool root_is_open_ = false;  // the root's entry has been popped
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_ENGINE_OPEN_HEAP_H_

// A 4-ary min-heap of queue entries whose pop leaves the root open.
//
// A discrete-event simulation mostly pops one event and pushes its successor. A usual heap then
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
  bool empty() const { return size() == 0; }

  void push(const QueueEntry& entry) {
    if (root_is_open_) {
      root_is_open_ = false;
      sink_from_root(entry);
    } else {
      if (used_ + kChildren > places_.size()) grow();
      rise(used_++, entry);
    }
  }

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

  // Later than any event, so that a group of children can be compared without asking how many of
  // them exist: every place at or after used_ holds it.
  static constexpr QueueEntry last_of_all() {
    return {.event = {.time = TrueTime::max()},
            .sequence = std::numeric_limits<std::uint64_t>::max()};
  }

  void close_root() {
    root_is_open_ = false;
    const QueueEntry last = places_[--used_];
    places_[used_] = last_of_all();
    if (used_ > 0) sink_from_root(last);
  }

  void sink_from_root(const QueueEntry& entry) {
    QueueEntry* const places = places_.data();
    const QueueKey key = key_of(entry);
    std::size_t hole = 0;
    for (std::size_t first = 1; first < used_; first = kChildren * hole + 1) {
      const std::size_t left = first + (earlier(places[first + 1], places[first]) ? 1 : 0);
      const std::size_t right = first + 2 + (earlier(places[first + 3], places[first + 2]) ? 1 : 0);
      const std::size_t best = earlier(places[right], places[left]) ? right : left;
      if (key < key_of(places[best])) break;
      places[hole] = places[best];
      hole = best;
    }
    places[hole] = entry;
  }

  void rise(std::size_t hole, const QueueEntry& entry) {
    QueueEntry* const places = places_.data();
    while (hole > 0) {
      const std::size_t parent = (hole - 1) / kChildren;
      if (!earlier(entry, places[parent])) break;
      places[hole] = places[parent];
      hole = parent;
    }
    places[hole] = entry;
  }

  void grow();

  std::vector<QueueEntry> places_;
  std::size_t used_ = 0;  // places in use, an open root included
  bool root_is_open_ = false;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_ENGINE_OPEN_HEAP_H_

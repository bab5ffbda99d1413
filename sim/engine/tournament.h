// The near future of the event queue: a tournament in which the earlier of two events wins.
//
// A complete binary tree over a number of places, each with an event or none; every inner node has
// the earlier of its two children, so the root has the earliest of all. When an event comes to a
// place, its way to the root is played anew: one comparison a level with the neighbour there, whose
// address does not depend on how the one before went. A heap has fewer levels, but each waits for
// the one before and guesses where to end, which costs more than the comparison.
//
// A discrete-event simulation mostly takes one event and adds its successor. What is taken
// leaves its place open, and the next event comes there and plays both away at once. Only when the
// earliest is asked for again before that, the empty place has to be played by itself.
//
// A node is one number of 128 bits: time, sequence and place; what the event says lies at its place
// alone. There are 44 bits of sequence: events of six days of computing, and 2^20 places.
//
// Complexity: O(log2 of the capacity) to add, O(1) to pop. No allocation once the capacity has
// been reached. Source: Knuth, "The Art of Computer Programming", vol. 3, section 5.4.1.
//
//   Tournament near;
//   while (!near.add({.time_ns = 7, .payload = 1, .sequence = 0})) near.grow();
//   const QueueEntry first = near.first();
//   near.pop();
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim/engine/queue_entry.h"

namespace simbench::sim {

class Tournament {
 public:
  std::size_t size() const { return capacity_ - free_count_; }
  bool empty() const { return free_count_ == capacity_; }

  // False, and nothing done, if there is no place left: grow() or drain() it then.
  bool add(const QueueEntry& entry) {
    if (free_count_ == 0) [[unlikely]]
      return false;
    const std::uint32_t place = free_[--free_count_];  // the open one, if there is one
    is_open_ = false;
    payloads_[place] = entry.payload;
    play(place, node_of(entry.time_ns, (entry.sequence << kPlaceBits) | place));
    return true;
  }

  // The earliest entry; there must be one.
  QueueEntry first() {
    close();
    return entry_of(nodes_[1]);
  }
  // Removes the entry that first() has just returned.
  void pop() {
    free_[free_count_++] = place_of(nodes_[1]);
    is_open_ = true;
  }

  // Doubles the number of places.
  void grow();

  // Moves all entries, in no particular order, to the end of `out`, and goes back to no places.
  void drain(std::vector<QueueEntry>& out);

 private:
  static constexpr int kPlaceBits = 20;
  static constexpr std::size_t kFewPlaces = 32;

  // Two words, the first of which counts.
  static QueueKey node_of(std::int64_t time_ns, std::uint64_t rest) {
    return (static_cast<QueueKey>(time_ns) << 64) | static_cast<QueueKey>(rest);
  }
  // Later than any event.
  static QueueKey nobody() {
    return node_of(std::numeric_limits<std::int64_t>::max(),
                   std::numeric_limits<std::uint64_t>::max());
  }
  static std::uint32_t place_of(QueueKey node) {
    return static_cast<std::uint32_t>(node) & ((1U << kPlaceBits) - 1);
  }
  QueueEntry entry_of(QueueKey node) const {
    return {.time_ns = static_cast<std::int64_t>(node >> 64),
            .payload = payloads_[place_of(node)],
            .sequence = static_cast<std::uint64_t>(node) >> kPlaceBits};
  }

  void close() {
    if (!is_open_) return;
    is_open_ = false;
    play(free_[free_count_ - 1], nobody());
  }

  // From its place to the root.
  void play(std::uint32_t place, QueueKey node) {
    QueueKey* const nodes = nodes_.data();
    std::size_t at = capacity_ + place;
    nodes[at] = node;
    do {
      const QueueKey neighbour = nodes[at ^ 1];
      node = neighbour < node ? neighbour : node;
      nodes[at /= 2] = node;
    } while (at > 1);
  }

  // The root is node 1, the children of node i are 2 i and 2 i + 1, place p is node capacity + p.
  std::vector<QueueKey> nodes_;
  std::vector<std::uint64_t> payloads_;  // by place
  std::vector<std::uint32_t> free_;      // the first free_count_ of these places are
  std::size_t capacity_ = 0;             // places: a power of two
  std::size_t free_count_ = 0;
  bool is_open_ = false;  // the winner has been taken: the last free place, not yet played
};

}  // namespace simbench::sim

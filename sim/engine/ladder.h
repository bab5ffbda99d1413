// The far future of the event queue: events in buckets of time, sorted only when their turn comes.
//
// A ladder queue (Tang, Goh and Thng, "Ladder queue: an O(1) priority queue structure for
// large-scale discrete event simulation", ACM TOMACS 15(3), 2005). Events beyond the ladder lie
// unsorted in `top`. When the ladder is used up, top is spread over the buckets of a first rung;
// a bucket that holds too many events is spread over a finer rung of its own when its turn comes;
// a bucket that holds few is sorted and handed out as a run. An event is moved two or three times
// in all, whatever the number of pending events.
//
// Every rung fits itself to the earliest and latest event that it was made from, so that bursts
// (all cameras of a rig triggered within microseconds) cost no more than evenly spread events.
//
// Entries earlier than start() are not the ladder's; the caller keeps them. start() never
// decreases except through spill().
//
// Complexity: amortised O(1) per entry, besides sorting runs of a few dozen entries.
// Memory is recycled: no allocation once the largest number of pending entries has been reached.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "sim/engine/queue_entry.h"

namespace simbench::sim {

class Ladder {
 public:
  // Nanoseconds of the earliest time that the ladder takes. Without rungs there is no such time.
  std::int64_t start_ns() const { return start_ns_; }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }

  // Takes an entry at or after start().
  void push(std::int64_t time_ns, std::uint64_t payload, std::uint64_t sequence);

  // Moves the earliest entries to `run`, latest first, and sets start() behind them. The ladder
  // must not be empty and `run` must be.
  void take_run(std::vector<QueueEntry>& run);

  // Takes back entries that are all earlier than start(), as the innermost rung; start() becomes
  // the time of the earliest. Empties `entries`. The ladder must have room for another rung.
  bool has_room() const { return depth_ < kMaxRungs; }
  void spill(std::vector<QueueEntry>& entries);

  // Moves all entries, in no particular order, to the end of `out` and removes all rungs.
  void drain(std::vector<QueueEntry>& out);

 private:
  static constexpr std::size_t kChunkEntries = 8;
  static constexpr std::size_t kMaxRungs = 8;

  struct Chunk {
    std::array<QueueEntry, kChunkEntries> entries;
    Chunk* next = nullptr;
  };
  // Entries in no particular order: a chain of chunks of which only the first may be part full.
  struct Bucket {
    Chunk* chunk = nullptr;
    std::size_t count = 0;

    std::size_t in_first_chunk() const { return (count - 1) % kChunkEntries + 1; }
  };
  struct Rung {
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;  // the last bucket reaches to here, however wide that makes it
    int shift = 0;            // a bucket is 2^shift ns wide
    std::size_t next = 0;     // first bucket not yet taken
    std::size_t size = 0;     // buckets in use
    std::vector<Bucket> buckets;

    std::int64_t start_of_next_ns() const;
    Bucket take_next();  // the first bucket that is not empty; an empty one if there is none
  };

  void append(Bucket& bucket, const QueueEntry& entry) {
    const std::size_t place = bucket.count++ % kChunkEntries;
    if (place == 0) bucket.chunk = new_chunk(bucket.chunk);
    bucket.chunk->entries[place] = entry;
  }
  Chunk* new_chunk(Chunk* next) {
    if (free_chunk_ == nullptr) [[unlikely]]
      add_chunks();
    Chunk* const chunk = std::exchange(free_chunk_, free_chunk_->next);
    chunk->next = next;
    return chunk;
  }
  void add_chunks();
  // Visits the entries and frees their chunks.
  template <class Visit>
  void consume(Bucket bucket, Visit visit);

  // Makes the innermost rung from the entries of `bucket`, none at or after `end_ns`.
  void spread(Bucket bucket, std::int64_t end_ns);
  // Prepares the innermost rung for `count` entries from `first_ns` to `last_ns`.
  Rung& add_rung(std::size_t count, std::int64_t first_ns, std::int64_t last_ns,
                 std::int64_t end_ns);
  void make_run(Bucket bucket, std::vector<QueueEntry>& run);

  std::vector<std::unique_ptr<Chunk[]>> chunks_;  // all of them, in blocks
  std::size_t chunk_count_ = 0;
  Chunk* free_chunk_ = nullptr;
  std::array<Rung, kMaxRungs> rungs_;  // outermost first
  std::size_t depth_ = 0;              // rungs in use
  Bucket top_;
  std::size_t size_ = 0;
  std::int64_t start_ns_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace simbench::sim

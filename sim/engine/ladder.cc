#include "sim/engine/ladder.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench::sim {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
// A bucket of up to this many entries is sorted; a larger one is spread over a finer rung.
constexpr std::size_t kSortable = 48;
// Entries per bucket that a new rung is laid out for.
constexpr std::size_t kEntriesPerBucket = 4;
// When no more than this many are left in all, they are handed out as one run: the ladder has
// become empty and its user goes on with a heap alone.
constexpr std::size_t kFewLeft = 256;
constexpr std::size_t kFirstChunks = 64;

// b - a for a <= b, also where the difference is no std::int64_t.
std::uint64_t span_ns(std::int64_t a, std::int64_t b) {
  return static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a);
}

std::int64_t later_ns(std::int64_t start_ns, std::uint64_t span) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(start_ns) + span);
}

}  // namespace

std::int64_t Ladder::Rung::start_of_next_ns() const {
  return next == size ? end_ns : later_ns(start_ns, next << shift);
}

Ladder::Bucket Ladder::Rung::take_next() {
  while (next < size && buckets[next].count == 0) ++next;
  return next < size ? std::exchange(buckets[next++], Bucket{}) : Bucket{};
}

void Ladder::push(std::int64_t time_ns, std::uint64_t payload, std::uint64_t sequence) {
  const QueueEntry entry = {.time_ns = time_ns, .payload = payload, .sequence = sequence};
  ++size_;
  if (depth_ == 0 || time_ns >= rungs_[0].end_ns) {
    append(top_, entry);
    return;
  }
  std::size_t i = 0;
  while (i + 1 < depth_ && time_ns < rungs_[i + 1].end_ns) ++i;
  Rung& rung = rungs_[i];
  const std::size_t place = span_ns(rung.start_ns, time_ns) >> rung.shift;
  append(rung.buckets[std::min(place, rung.size - 1)], entry);
}

void Ladder::take_run(std::vector<QueueEntry>& run) {
  for (;;) {
    if (depth_ == 0) {
      const Bucket bucket = std::exchange(top_, Bucket{});
      if (bucket.count <= kFewLeft) {
        start_ns_ = kNever;
        make_run(bucket, run);
        return;
      }
      spread(bucket, kNever);
      continue;
    }
    Rung& rung = rungs_[depth_ - 1];
    const Bucket bucket = rung.take_next();
    if (bucket.count == 0) {
      --depth_;
    } else if (bucket.count <= kSortable || rung.size == 1 || depth_ == kMaxRungs) {
      start_ns_ = rung.start_of_next_ns();
      make_run(bucket, run);
      return;
    } else {
      spread(bucket, rung.start_of_next_ns());
    }
  }
}

void Ladder::spill(std::vector<QueueEntry>& entries) {
  SIMBENCH_ASSERT(has_room() && !entries.empty(), "nothing to spill or no room for it");
  Bucket bucket;
  for (const QueueEntry& entry : entries) append(bucket, entry);
  size_ += entries.size();
  entries.clear();
  spread(bucket, start_ns_);
}

void Ladder::drain(std::vector<QueueEntry>& out) {
  const auto take = [&out](const QueueEntry& entry) { out.push_back(entry); };
  for (std::size_t i = 0; i < depth_; ++i) {
    for (Bucket bucket = rungs_[i].take_next(); bucket.count > 0; bucket = rungs_[i].take_next()) {
      consume(bucket, take);
    }
  }
  consume(std::exchange(top_, Bucket{}), take);
  depth_ = 0;
  size_ = 0;
  start_ns_ = kNever;
}

// Doubles their number, so that a number of pending entries that merely fluctuates soon needs no
// more.
void Ladder::add_chunks() {
  const std::size_t count = std::max(kFirstChunks, chunk_count_);
  Chunk* const block = chunks_.emplace_back(std::make_unique<Chunk[]>(count)).get();
  for (std::size_t i = 0; i < count; ++i) {
    block[i].next = std::exchange(free_chunk_, &block[i]);
  }
  chunk_count_ += count;
}

template <class Visit>
void Ladder::consume(Bucket bucket, Visit visit) {
  while (bucket.count > 0) {
    Chunk* const chunk = bucket.chunk;
    const std::size_t count = bucket.in_first_chunk();
    for (std::size_t i = 0; i < count; ++i) visit(chunk->entries[i]);
    bucket = {.chunk = chunk->next, .count = bucket.count - count};
    chunk->next = std::exchange(free_chunk_, chunk);
  }
}

void Ladder::spread(Bucket bucket, std::int64_t end_ns) {
  std::int64_t first_ns = kNever;
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (Bucket rest = bucket; rest.count > 0;) {
    const std::size_t count = rest.in_first_chunk();
    for (std::size_t i = 0; i < count; ++i) {
      first_ns = std::min(first_ns, rest.chunk->entries[i].time_ns);
      last_ns = std::max(last_ns, rest.chunk->entries[i].time_ns);
    }
    rest = {.chunk = rest.chunk->next, .count = rest.count - count};
  }
  Rung& rung = add_rung(bucket.count, first_ns, last_ns, end_ns);
  consume(bucket, [&](const QueueEntry& entry) {
    append(rung.buckets[span_ns(rung.start_ns, entry.time_ns) >> rung.shift], entry);
  });
  start_ns_ = first_ns;
}

Ladder::Rung& Ladder::add_rung(std::size_t count, std::int64_t first_ns, std::int64_t last_ns,
                               std::int64_t end_ns) {
  const std::uint64_t span = span_ns(first_ns, last_ns);
  const std::uint64_t buckets = std::max<std::uint64_t>(1, count / kEntriesPerBucket);
  Rung& rung = rungs_[depth_++];
  rung.start_ns = first_ns;
  rung.shift = static_cast<int>(std::bit_width(span / buckets));
  rung.next = 0;
  rung.size = (span >> rung.shift) + 1;
  const std::uint64_t reach = rung.size << rung.shift;
  const bool reaches_never = reach == 0 || reach > span_ns(first_ns, kNever);
  rung.end_ns = end_ns != kNever ? end_ns : reaches_never ? kNever : later_ns(first_ns, reach);
  if (rung.buckets.size() < rung.size) rung.buckets.resize(std::bit_ceil(rung.size));
  return rung;
}

void Ladder::make_run(Bucket bucket, std::vector<QueueEntry>& run) {
  size_ -= bucket.count;
  run.resize(bucket.count);
  auto place = run.begin();
  consume(bucket, [&place](const QueueEntry& entry) { *place++ = entry; });
  std::sort(run.begin(), run.end(),
            [](const QueueEntry& a, const QueueEntry& b) { return earlier(b, a); });
}

}  // namespace simbench::sim

#include "algorithms/gathering/fronts.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

constexpr std::uint32_t kUnbounded = std::numeric_limits<std::uint32_t>::max();

}  // namespace

FrameQueues::FrameQueues(std::uint32_t sources, std::uint32_t capacity) : capacity_(capacity) {
  SIMBENCH_ASSERT(sources > 0, "gathering needs a source");
  SIMBENCH_ASSERT(capacity > 0, "a queue needs room for one frame");
  queues_.resize(sources);
  slab_.resize(std::size_t{sources} * capacity);
  taken_.resize(sources);
}

std::span<const GatherFrame> FrameQueues::take_fronts() {
  SIMBENCH_ASSERT(all_waiting(), "a source without a frame has no front");
  for (std::uint32_t source = 0; source < queues_.size(); ++source) {
    taken_[source] = front(source);
    pop(source);
  }
  return taken_;
}

FrontMatcher::FrontMatcher(std::uint32_t sources, std::int64_t tolerance,
                           std::optional<std::uint32_t> queue_limit)
    : tolerance_(tolerance), queue_limit_(queue_limit.value_or(kUnbounded)) {
  SIMBENCH_ASSERT(sources > 0, "gathering needs a source");
  SIMBENCH_ASSERT(tolerance > 0, "no set is narrower than an interval of 0");
  SIMBENCH_ASSERT(queue_limit_ > 0, "a queue needs room for one frame");
  queues_.resize(sources);
  keys_.resize(sources);
  fronts_.resize(sources);
  rings_.assign(sources, Ring(std::min(kFirstQueue, queue_limit_) - 1));
  heap_.reserve(sources);
}

void FrontMatcher::make_room(std::uint32_t source) {
  Queue& queue = queues_[source];
  if (queue.length == queue_limit_) {
    pop_front(source);
    ++discarded_;
    heap_.clear();  // its order and latest_ may no longer hold
    return;
  }
  Ring& ring = rings_[source];
  std::rotate(ring.begin(), ring.begin() + queue.head, ring.end());
  queue.head = 0;
  ring.resize(std::min<std::size_t>(2 * (ring.size() + 1), queue_limit_) - 1);
}

void FrontMatcher::pop_front(std::uint32_t source) {
  Queue& queue = queues_[source];
  if (--queue.length == 0) {
    --waiting_sources_;
    return;
  }
  const Ring& ring = rings_[source];
  keys_[source] = ring[queue.head].key;
  fronts_[source] = ring[queue.head].frame;
  --behind_;
  if (++queue.head == ring.size()) queue.head = 0;
}

void FrontMatcher::match(FrameSetSink& sink) {
  const auto sources = static_cast<std::uint32_t>(queues_.size());
  while (waiting_sources_ == sources) {
    if (!fronts_match()) {
      drop_earliest();
      continue;
    }
    sink.on_set(fronts_);
    pop_fronts();
  }
}

void FrontMatcher::pop_fronts() {
  heap_.clear();
  if (behind_ == 0) {
    std::ranges::fill(queues_, Queue{});
    waiting_sources_ = 0;
    return;
  }
  for (std::uint32_t source = 0; source < queues_.size(); ++source) pop_front(source);
}

bool FrontMatcher::fronts_match() {
  std::int64_t earliest = 0;
  if (heap_.empty()) {
    const auto [low, high] = std::ranges::minmax(keys_);
    earliest = low;
    latest_ = high;
  } else {
    earliest = keys_[heap_.front()];
  }
  // Unsigned: the distance of two keys may exceed what a signed number holds.
  return static_cast<std::uint64_t>(latest_) - static_cast<std::uint64_t>(earliest) <
         static_cast<std::uint64_t>(tolerance_);
}

auto FrontMatcher::later() const {
  return [this](std::uint32_t a, std::uint32_t b) {
    return keys_[a] != keys_[b] ? keys_[a] > keys_[b] : a > b;
  };
}

void FrontMatcher::heap_push(std::uint32_t source) {
  latest_ = std::max(latest_, keys_[source]);
  heap_.push_back(source);
  std::ranges::push_heap(heap_, later());
}

void FrontMatcher::drop_earliest() {
  if (heap_.empty()) {
    for (std::uint32_t source = 0; source < queues_.size(); ++source) heap_.push_back(source);
    std::ranges::make_heap(heap_, later());
  }
  std::ranges::pop_heap(heap_, later());
  const std::uint32_t source = heap_.back();
  heap_.pop_back();
  pop_front(source);
  ++discarded_;
  if (queues_[source].length > 0) heap_push(source);
}

FrontTournament::FrontTournament(std::uint32_t sources)
    : keys_(sources), nodes_(std::size_t{2} * sources) {
  for (std::uint32_t source = 0; source < sources; ++source) {
    nodes_[std::size_t{sources} + source] = {source, source};
  }
}

FrontTournament::Node FrontTournament::play(const Node& a, const Node& b) const {
  const auto before = [this](std::uint32_t x, std::uint32_t y) {
    return keys_[x] != keys_[y] ? keys_[x] < keys_[y] : x < y;
  };
  return {before(b.earliest, a.earliest) ? b.earliest : a.earliest,
          before(a.latest, b.latest) ? b.latest : a.latest};
}

void FrontTournament::play_all() {
  for (std::size_t i = keys_.size() - 1; i > 0; --i) {
    nodes_[i] = play(nodes_[2 * i], nodes_[2 * i + 1]);
  }
  played_ = true;
}

void FrontTournament::replay(std::uint32_t source) {
  for (std::size_t i = (keys_.size() + source) / 2; i > 0; i /= 2) {
    const Node node = play(nodes_[2 * i], nodes_[2 * i + 1]);
    // Nodes above see this one's champions alone: nothing changes there if these are the same and
    // kept their keys.
    if (node == nodes_[i] && node.earliest != source && node.latest != source) return;
    nodes_[i] = node;
  }
}

}  // namespace simbench

#include "sim/engine/event_queue.h"

#include <gtest/gtest.h>

#include <queue>
#include <vector>

#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

// The same order by the standard library: what the queue is held against.
class ReferenceQueue {
 public:
  void push(std::int64_t time_ns, std::uint64_t payload) {
    queue_.push({.time_ns = time_ns, .payload = payload, .sequence = next_sequence_++});
  }
  const QueueEntry& top() const { return queue_.top(); }
  void pop() { queue_.pop(); }
  std::size_t size() const { return queue_.size(); }

  template <class Predicate>
  void erase_if(Predicate is_unwanted) {
    std::vector<QueueEntry> kept;
    for (; !queue_.empty(); queue_.pop()) {
      if (!is_unwanted(queue_.top())) kept.push_back(queue_.top());
    }
    for (const QueueEntry& entry : kept) queue_.push(entry);
  }

 private:
  struct Later {
    bool operator()(const QueueEntry& a, const QueueEntry& b) const {
      return a.time_ns != b.time_ns ? a.time_ns > b.time_ns : a.sequence > b.sequence;
    }
  };
  std::priority_queue<QueueEntry, std::vector<QueueEntry>, Later> queue_;
  std::uint64_t next_sequence_ = 0;
};

// Both queues, and the check that they agree.
class QueuePair {
 public:
  explicit QueuePair(std::int64_t start_ns) : now_ns_(start_ns) {}

  void push(std::int64_t delay_ns) {
    const std::int64_t time_ns =
        now_ns_ > 0 && delay_ns > kNever - now_ns_ ? kNever : now_ns_ + delay_ns;
    queue_.push(TrueTime(Nanoseconds(time_ns)), next_payload_);
    reference_.push(time_ns, next_payload_++);
  }

  // Pops from both; false when they differ.
  bool pop() {
    QueueEntry entry;
    if (!queue_.pop_through(TrueTime::max(), entry)) return reference_.size() == 0;
    if (reference_.size() == 0 || entry.payload != reference_.top().payload ||
        entry.time_ns != reference_.top().time_ns) {
      return false;
    }
    reference_.pop();
    now_ns_ = entry.time_ns;
    return queue_.size() == reference_.size();
  }

  template <class Predicate>
  void erase_if(Predicate is_unwanted) {
    queue_.erase_if(is_unwanted);
    reference_.erase_if(is_unwanted);
  }

  std::size_t size() const { return reference_.size(); }

 private:
  EventQueue queue_;
  ReferenceQueue reference_;
  std::int64_t now_ns_;
  std::uint64_t next_payload_ = 0;
};

// Delays as models produce them, from ties to hours, with bursts.
std::int64_t draw_delay_ns(RandomStream& random) {
  switch (random.below(7)) {
    case 0:
      return 0;
    case 1:
      return static_cast<std::int64_t>(random.below(3));
    case 2:
      return 22'222'222;
    case 3:
      return 3'000'000 + static_cast<std::int64_t>(random.exponential(1e5));
    case 4:
      return static_cast<std::int64_t>(random.exponential(4e8));
    case 5:
      return static_cast<std::int64_t>(random.below(1'000'000));
    default:
      return random.chance(0.01) ? kNever : 3'600'000'000'000;
  }
}

// Grows to `peak` entries, holds that number for a while, and shrinks to none: from tournament to
// ladder and back when the peak is large.
bool agree_over_a_life(QueuePair& queues, RandomStream& random, std::size_t peak) {
  while (queues.size() < peak) {
    queues.push(draw_delay_ns(random));
    if (random.chance(0.3) && !queues.pop()) return false;
  }
  for (std::size_t i = 0; i < peak; ++i) {
    const std::uint64_t burst = random.below(4);
    for (std::uint64_t k = 0; k < burst; ++k) queues.push(draw_delay_ns(random));
    for (std::uint64_t k = 0; k < burst; ++k) {
      if (!queues.pop()) return false;
    }
  }
  while (queues.size() > 0) {
    if (random.chance(0.2)) queues.push(draw_delay_ns(random));
    if (!queues.pop()) return false;
  }
  return queues.pop();
}

TEST(EventQueue, AgreesWithPriorityQueueAtEverySize) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    RandomStream random(seed, "event queue");
    QueuePair queues(-5'000'000'000);
    for (const std::size_t peak : {3, 40, 300, 2'000, 4'200, 30, 12'000}) {
      ASSERT_TRUE(agree_over_a_life(queues, random, peak)) << "seed " << seed << " peak " << peak;
    }
  }
}

TEST(EventQueue, AgreesWhenEntriesAreErased) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, "erase");
    QueuePair queues(0);
    for (int round = 0; round < 6; ++round) {
      const std::uint64_t pushes = 100 + random.below(9'000);
      for (std::uint64_t i = 0; i < pushes; ++i) queues.push(draw_delay_ns(random));
      const std::uint64_t divisor = 2 + random.below(3);
      queues.erase_if([=](const QueueEntry& entry) { return entry.payload % divisor == 0; });
      const std::uint64_t pops = random.below(queues.size());
      for (std::uint64_t i = 0; i < pops; ++i) ASSERT_TRUE(queues.pop()) << "seed " << seed;
    }
    while (queues.size() > 0) ASSERT_TRUE(queues.pop()) << "seed " << seed;
  }
}

// Pushes earlier and earlier times, so that the tournament spills inside what it has spilled
// before.
TEST(EventQueue, AgreesWhenTimesDescend) {
  for (const std::int64_t step_ns : {0, 1, 1'000}) {
    QueuePair queues(0);
    constexpr std::int64_t kEntries = 20'000;
    for (std::int64_t i = 0; i < kEntries; ++i) queues.push(step_ns * (kEntries - i));
    while (queues.size() > 0) ASSERT_TRUE(queues.pop()) << "step " << step_ns << " ns";
  }
}

TEST(EventQueue, AgreesOverTheWholeRangeOfTime) {
  constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min() + 1;
  RandomStream random(1, "range");
  EventQueue queue;
  std::vector<std::int64_t> times_ns = {kEarliest, -1, 0, 1, kNever - 1, kNever, kNever};
  for (int i = 0; i < 9'000; ++i) times_ns.push_back(static_cast<std::int64_t>(random()));
  for (const std::int64_t time_ns : times_ns) queue.push(TrueTime(Nanoseconds(time_ns)), 0);
  std::sort(times_ns.begin(), times_ns.end());
  for (const std::int64_t time_ns : times_ns) {
    QueueEntry entry;
    ASSERT_TRUE(queue.pop_through(TrueTime::max(), entry));
    ASSERT_EQ(entry.time_ns, time_ns);
  }
  EXPECT_EQ(queue.size(), 0);
}

TEST(EventQueue, PopsNothingLaterThanAsked) {
  EventQueue queue;
  queue.push(TrueTime(Nanoseconds(10)), 1);
  QueueEntry entry;
  EXPECT_FALSE(queue.pop_through(TrueTime(Nanoseconds(9)), entry));
  EXPECT_TRUE(queue.pop_through(TrueTime(Nanoseconds(10)), entry));
  EXPECT_EQ(entry.payload, 1);
  EXPECT_FALSE(queue.pop_through(TrueTime::max(), entry));
}

}  // namespace
}  // namespace simbench::sim

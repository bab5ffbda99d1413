#include "sim/engine/tournament.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "sim/engine/random.h"

namespace simbench::sim {
namespace {

void add(Tournament& tournament, const QueueEntry& entry) {
  while (!tournament.add(entry)) tournament.grow();
}

TEST(Tournament, IsEmptyAtFirst) {
  Tournament tournament;
  EXPECT_TRUE(tournament.empty());
  EXPECT_EQ(tournament.size(), 0u);
  EXPECT_FALSE(tournament.add({})) << "it has no places yet";
}

TEST(Tournament, TimeCountsThenSequence) {
  Tournament tournament;
  add(tournament, {.time_ns = 5, .payload = 1, .sequence = 2});
  add(tournament, {.time_ns = 5, .payload = 2, .sequence = 1});
  add(tournament, {.time_ns = -7, .payload = 3, .sequence = 3});
  std::vector<std::uint64_t> payloads;
  for (; !tournament.empty(); tournament.pop()) payloads.push_back(tournament.first().payload);
  EXPECT_EQ(payloads, (std::vector<std::uint64_t>{3, 2, 1}));
}

// The last instant is later than any other and still an event.
TEST(Tournament, KeepsEventsOfTheLastInstant) {
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  Tournament tournament;
  add(tournament, {.time_ns = kLast, .payload = 9, .sequence = (std::uint64_t{1} << 44) - 2});
  std::vector<QueueEntry> drained;
  tournament.drain(drained);
  ASSERT_EQ(drained.size(), 1u);
  EXPECT_EQ(drained.front().time_ns, kLast);
  EXPECT_EQ(drained.front().payload, 9u);
  EXPECT_EQ(drained.front().sequence, (std::uint64_t{1} << 44) - 2);
  EXPECT_TRUE(tournament.empty());
}

// Adds, pops with and without a successor, grows and drains against an ordered map.
TEST(Tournament, AgreesWithAnOrderedMap) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    RandomStream random(seed, "tournament");
    Tournament tournament;
    std::map<std::pair<std::int64_t, std::uint64_t>, std::uint64_t> expected;
    for (std::uint64_t sequence = 0; sequence < 3'000; ++sequence) {
      const auto time_ns = static_cast<std::int64_t>(random.below(500)) - 250;
      add(tournament, {.time_ns = time_ns, .payload = sequence * 3, .sequence = sequence});
      expected[{time_ns, sequence}] = sequence * 3;
      for (std::uint64_t pops = random.below(3); pops > 0 && !expected.empty(); --pops) {
        const QueueEntry first = tournament.first();
        const auto [key, payload] = *expected.begin();
        ASSERT_EQ(std::pair(first.time_ns, first.sequence), key) << "seed " << seed;
        ASSERT_EQ(first.payload, payload) << "seed " << seed;
        tournament.pop();
        expected.erase(expected.begin());
      }
      ASSERT_EQ(tournament.size(), expected.size()) << "seed " << seed;
      if (!random.chance(0.001)) continue;
      std::vector<QueueEntry> drained;
      tournament.drain(drained);
      ASSERT_EQ(drained.size(), expected.size()) << "seed " << seed;
      for (const QueueEntry& entry : drained) add(tournament, entry);
    }
  }
}

}  // namespace
}  // namespace simbench::sim

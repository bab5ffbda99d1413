// Algorithm 3 on random streams: its properties, and the same sets as a naive implementation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/algorithms/gathering/gathering_world.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

// Algorithm 3 to the letter: O(n) a step, no thought of speed.
class NaiveGatherer {
 public:
  explicit NaiveGatherer(const GatheringSetup& setup) : setup_(setup), queues_(setup.sources) {}

  void push(const GatherFrame& frame, FrameSetSink& sink) {
    std::deque<GatherFrame>& queue = queues_[frame.source];
    if (setup_.queue_limit && queue.size() == *setup_.queue_limit) {
      queue.pop_front();
      ++discarded;
    }
    queue.push_back(frame);
    while (std::ranges::none_of(queues_, [](const auto& q) { return q.empty(); })) step(sink);
  }

  std::uint64_t discarded = 0;

 private:
  void step(FrameSetSink& sink) {
    std::vector<GatherFrame> fronts;
    for (const auto& queue : queues_) fronts.push_back(queue.front());
    const auto [low, high] = std::ranges::minmax_element(fronts, {}, &GatherFrame::stamp);
    if (high->stamp - low->stamp < setup_.interval) {
      sink.on_set(fronts);
      for (auto& queue : queues_) queue.pop_front();
    } else {
      queues_[low->source].pop_front();
      ++discarded;
    }
  }

  GatheringSetup setup_;
  std::vector<std::deque<GatherFrame>> queues_;
};

// Algorithm 3 as it is printed: all stamps of the capture in a queue a camera, then the sets.
std::vector<std::vector<std::int64_t>> sets_as_printed(const std::vector<GatherFrame>& frames,
                                                       const GatheringSetup& setup) {
  std::vector<std::deque<GatherFrame>> queues(setup.sources);
  for (const GatherFrame& frame : frames) queues[frame.source].push_back(frame);
  std::vector<std::vector<std::int64_t>> sets;
  while (std::ranges::none_of(queues, &std::deque<GatherFrame>::empty)) {
    const auto [low, high] = std::ranges::minmax_element(
        queues, {}, [](const auto& queue) { return queue.front().stamp; });
    if (high->front().stamp - low->front().stamp >= setup.interval) {
      low->pop_front();
      continue;
    }
    std::vector<std::int64_t>& set = sets.emplace_back();
    for (auto& queue : queues) {
      set.push_back(queue.front().tag);
      queue.pop_front();
    }
  }
  return sets;
}

std::vector<std::vector<std::int64_t>> streamed_sets(const std::vector<GatherFrame>& frames,
                                                     const GatheringSetup& setup) {
  const auto gatherer = make_yoon2021_gatherer(setup);
  CollectedSets sets;
  for (const GatherFrame& frame : frames) gatherer->push(frame, sets);
  return sets.tags();
}

// Drops, offsets of whole periods as a stepped clock has them, some beyond the capture's length,
// cameras that die, some before their first frame.
GatheringWorld hazardous_world(boost::random::mt19937& random) {
  boost::random::uniform_01<double> uniform;
  GatheringWorld world;
  world.period_ms = kPeriodMs;
  world.sources = 1 + static_cast<std::uint32_t>(random() % 7);
  world.pulses = 400;
  world.sigma_ms = 4 * uniform(random);
  world.drop = random() % 2 == 0 ? 0 : 0.1 * uniform(random);
  world.outage = 0.3 * uniform(random);
  world.delay_max_ms = 100 * uniform(random);
  world.quantum_ms = random() % 2 == 0 ? 4 : 0;
  for (std::uint32_t source = 0; source < world.sources; ++source) {
    const auto periods = static_cast<double>(random() % 900) - 450;
    world.offset_ms.push_back(random() % 3 == 0 ? periods * kPeriodMs : 0);
    const auto frames = static_cast<std::int64_t>(random() % 400);
    world.dies_after.push_back(random() % 6 == 0 ? frames : world.pulses);
  }
  return world;
}

GatheringSetup random_setup(const GatheringWorld& world, double interval_ms,
                            std::optional<std::uint32_t> queue_limit) {
  return {.sources = world.sources,
          .period = from_ms(kPeriodMs),
          .interval = from_ms(interval_ms),
          .queue_limit = queue_limit};
}

TEST(Yoon2021Random, EqualsTheNaiveImplementation) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    boost::random::mt19937 random(seed);
    boost::random::uniform_01<double> uniform;
    GatheringWorld world;
    world.period_ms = kPeriodMs;
    world.sources = 1 + static_cast<std::uint32_t>(random() % 9);
    world.pulses = 60;
    world.sigma_ms = 8 * uniform(random);
    world.drop = 0.2 * uniform(random);
    world.outage = 0.3 * uniform(random);
    world.delay_max_ms = 100 * uniform(random);
    world.quantum_ms = seed % 2 == 0 ? 4 : 0;
    std::optional<std::uint32_t> limit;
    if (seed % 3 != 0) limit = static_cast<std::uint32_t>(seed % 3 == 1 ? 1 + random() % 4 : 64);
    const GatheringSetup setup = random_setup(world, 1 + 21 * uniform(random), limit);
    const auto gatherer = make_yoon2021_gatherer(setup);
    NaiveGatherer naive(setup);
    CollectedSets sets;
    CollectedSets expected;
    for (const GatherFrame& frame : nonempty(frames_of(world, seed))) {
      gatherer->push(frame, sets);
      naive.push(frame, expected);
      ASSERT_EQ(sets.sets.size(), expected.sets.size()) << "seed " << seed;
      ASSERT_EQ(gatherer->discarded(), naive.discarded) << "seed " << seed;
    }
    ASSERT_EQ(sets.tags(), expected.tags()) << "seed " << seed;
  }
}

TEST(Yoon2021Random, WithoutALimitItGivesTheSetsThatArePrinted) {
  int of_other_pulses = 0;
  int lost_by_a_limit = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    boost::random::mt19937 random(seed);
    const GatheringWorld world = hazardous_world(random);
    const std::vector<GatherFrame> frames = frames_of(world, seed);
    const auto printed = sets_as_printed(frames, random_setup(world, kPeriodMs / 2, {}));
    ASSERT_EQ(streamed_sets(frames, random_setup(world, kPeriodMs / 2, {})), printed)
        << "seed " << seed;
    of_other_pulses += std::ranges::any_of(printed, [](const std::vector<std::int64_t>& set) {
      return std::ranges::any_of(set, [&](std::int64_t tag) { return tag > set.front() + 64; });
    });
    lost_by_a_limit += streamed_sets(frames, random_setup(world, kPeriodMs / 2, 64)) != printed;
  }
  EXPECT_GT(of_other_pulses, 20);  // the hazard occurs, and a queue of 64 frames hides it
  EXPECT_GT(lost_by_a_limit, of_other_pulses);
}

TEST(Yoon2021Random, NeverReordersNeverReusesAndKeepsTheInterval) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const GatheringWorld world = {.sources = 6,
                                  .pulses = 300,
                                  .period_ms = kPeriodMs,
                                  .sigma_ms = 4,
                                  .drop = 0.05,
                                  .outage = 0.2,
                                  .delay_max_ms = 60};
    const GatheringSetup setup = random_setup(world, kPeriodMs / 2, 8);
    const auto gatherer = make_yoon2021_gatherer(setup);
    CollectedSets out;
    const std::vector<GatherFrame> frames = frames_of(world, seed);
    for (const GatherFrame& frame : frames) gatherer->push(frame, out);
    ASSERT_FALSE(out.sets.empty()) << "seed " << seed;
    std::map<std::uint32_t, std::int64_t> last_tag;
    for (const std::vector<GatherFrame>& set : out.sets) {
      ASSERT_EQ(set.size(), world.sources) << "seed " << seed;
      const auto [low, high] = std::ranges::minmax_element(set, {}, &GatherFrame::stamp);
      ASSERT_LT(high->stamp - low->stamp, setup.interval) << "seed " << seed;
      for (std::uint32_t source = 0; source < world.sources; ++source) {
        ASSERT_EQ(set[source].source, source) << "seed " << seed;
        const auto [entry, is_first] = last_tag.try_emplace(source, -1);
        ASSERT_GT(set[source].tag, entry->second) << "seed " << seed << ", source " << source;
        entry->second = set[source].tag;
      }
    }
    // Every frame is in a set, given up or waiting in a queue.
    const std::uint64_t used = out.sets.size() * world.sources + gatherer->discarded();
    ASSERT_LE(used, frames.size()) << "seed " << seed;
    ASSERT_LE(frames.size() - used, (world.sources - 1) * setup.queue_limit.value())
        << "seed " << seed;
  }
}

TEST(Yoon2021Random, CleanInputHasRecallOne) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const GatheringWorld world = {
        .sources = 18, .pulses = 200, .period_ms = kPeriodMs, .sigma_ms = 1, .delay_max_ms = 60};
    const auto gatherer = make_yoon2021_gatherer(random_setup(world, kPeriodMs / 2, 64));
    CollectedSets out;
    for (const GatherFrame& frame : frames_of(world, seed)) gatherer->push(frame, out);
    ASSERT_EQ(out.sets.size(), 200U) << "seed " << seed;
    ASSERT_EQ(out.pure(), 200) << "seed " << seed;
    ASSERT_EQ(gatherer->discarded(), 0U) << "seed " << seed;
  }
}

// Without synchronisation: six hosts with independent phases find sets only if all lie within half
// a period, 6/2^5 of the time (docs/reference/paper.md section 11, C9).
TEST(Yoon2021Random, SixIndependentPhasesMostlyGiveNoSet) {
  constexpr std::uint32_t kSeed = 17;
  constexpr int kRuns = 2000;
  boost::random::mt19937 random(kSeed);
  boost::random::uniform_01<double> uniform;
  int without = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto gatherer = make_yoon2021_gatherer(random_setup({.sources = 6}, kPeriodMs / 2, 64));
    CollectedSets out;
    std::array<double, 6> phase_ms{};
    for (double& phase : phase_ms) phase = kPeriodMs * uniform(random);
    for (std::int64_t pulse = 0; pulse < 10; ++pulse) {
      for (std::uint32_t host = 0; host < 6; ++host) {
        gatherer->push(
            frame_at(host, static_cast<double>(pulse) * kPeriodMs + phase_ms[host], pulse), out);
      }
    }
    without += out.sets.empty() ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(without) / kRuns, 1 - 6.0 / 32, 0.03) << "seed " << kSeed;
}

TEST(Yoon2021Random, EighteenThousandSources) {
  const GatheringWorld world = {
      .sources = 18'000, .pulses = 4, .period_ms = kPeriodMs, .sigma_ms = 0.5, .drop = 2e-5};
  const auto gatherer = make_yoon2021_gatherer(random_setup(world, kPeriodMs / 2, 8));
  CollectedSets out;
  const std::vector<GatherFrame> frames = frames_of(world, 4);
  for (const GatherFrame& frame : frames) gatherer->push(frame, out);
  // A pulse with a lost frame gives no set; all its frames are given up once the next is complete.
  EXPECT_GE(out.sets.size(), 1U);
  EXPECT_EQ(out.pure(), static_cast<std::int64_t>(out.sets.size()));
}

}  // namespace
}  // namespace simbench

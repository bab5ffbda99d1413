// A program that takes frames one after another: when it takes which, and which it never does.
#include "sim/host/reader_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/nonempty.h"
#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

using scenarios::FullQueue;
using Outcomes = std::vector<ReaderQueue::Outcome>;

// `frames` frames, one every `period_ms`.
Outcomes run(const scenarios::FrameReader& reader, std::uint32_t frames, double period_ms) {
  ReaderQueue queue(reader);
  Outcomes outcomes;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    queue.arrive(frame, at_ms(frame * period_ms), outcomes);
  }
  queue.read_before(TrueTime::max(), outcomes);
  return outcomes;
}

std::map<FrameFate, std::size_t> counts(const Outcomes& outcomes) {
  std::map<FrameFate, std::size_t> found;
  for (const ReaderQueue::Outcome& outcome : nonempty(outcomes)) ++found[outcome.fate];
  return found;
}

TEST(ReaderQueue, AFastProgramTakesEachFrameAsItComes) {
  const Outcomes outcomes = run({.frame_ms = 10, .queue_frames = 1, .full_queue = {}}, 50, 10);
  ASSERT_EQ(outcomes.size(), 50U);
  for (std::uint32_t frame = 0; frame < 50; ++frame) {
    EXPECT_EQ(outcomes[frame].frame, frame);
    EXPECT_EQ(outcomes[frame].at, at_ms(10.0 * frame));
    EXPECT_EQ(outcomes[frame].fate, FrameFate::kDelivered);
  }
}

TEST(ReaderQueue, AShortDelayIsWorkedOff) {
  ReaderQueue queue({.frame_ms = 4, .queue_frames = 3, .full_queue = {}});
  Outcomes outcomes;
  for (std::uint32_t frame = 0; frame < 3; ++frame) queue.arrive(frame, at_ms(1), outcomes);
  queue.read_before(at_ms(9), outcomes);
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_EQ(outcomes[1].at, at_ms(5));
  queue.read_before(at_ms(9.1), outcomes);
  ASSERT_EQ(outcomes.size(), 3U);
  EXPECT_EQ(outcomes[2].at, at_ms(9));
}

// One frame in four is taken, whichever the queue drops.
TEST(ReaderQueue, ASlowProgramTakesAsManyFramesAsItHasTimeFor) {
  for (const FullQueue full : {FullQueue::kDropsNewest, FullQueue::kDropsOldest}) {
    const auto found =
        counts(run({.frame_ms = 40, .queue_frames = 5, .full_queue = full}, 4000, 10));
    EXPECT_NEAR(static_cast<double>(found.at(FrameFate::kDelivered)), 1000, 6);
    EXPECT_EQ(found.at(FrameFate::kDelivered) + found.at(FrameFate::kLostInQueue), 4000U);
  }
}

// In a queue of two: what waits is the newest, or the oldest.
TEST(ReaderQueue, AFullQueueDropsTheOldestOrTheNewest) {
  const auto waited_ms = [](FullQueue full) {
    const Outcomes outcomes = run({.frame_ms = 40, .queue_frames = 2, .full_queue = full}, 400, 10);
    double longest = 0;
    for (const ReaderQueue::Outcome& outcome : nonempty(outcomes)) {
      if (outcome.fate != FrameFate::kDelivered || outcome.frame % 390 < 100) continue;
      longest = std::max(longest, to_ms(outcome.at - at_ms(10.0 * outcome.frame)));
    }
    return longest;
  };
  EXPECT_NEAR(waited_ms(FullQueue::kDropsNewest), 80, 10.001);
  // The older one of the two newest is taken, just before a third comes.
  EXPECT_NEAR(waited_ms(FullQueue::kDropsOldest), 20, 0.001);
}

TEST(ReaderQueue, OneFrameInSoManyIsPassedOnByItsOwnCount) {
  const Outcomes outcomes =
      run({.frame_ms = 0, .queue_frames = 1, .full_queue = {}, .passed_every = 3}, 10, 10);
  for (const ReaderQueue::Outcome& outcome : nonempty(outcomes)) {
    EXPECT_EQ(outcome.fate, outcome.frame % 3 == 0 ? FrameFate::kDelivered : FrameFate::kNotPassed);
  }
}

}  // namespace
}  // namespace simbench::sim

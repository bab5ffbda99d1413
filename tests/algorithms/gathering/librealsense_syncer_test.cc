#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/algorithms/gathering/gathering_world.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kGapMs = 20;

class LibrealsenseSyncer : public testing::Test {
 protected:
  void make(std::uint32_t sources, std::uint32_t queue_limit = 10) {
    gatherer_ = make_librealsense_gatherer(
        {.sources = sources, .period = from_ms(kGapMs), .queue_limit = queue_limit});
  }
  void push(std::uint32_t source, double stamp_ms) {
    gatherer_->push(frame_at(source, stamp_ms, 0), out_);
  }
  // Makes all sources known: their first frames come out alone.
  void begin(std::uint32_t sources) {
    make(sources);
    for (std::uint32_t source = 0; source < sources; ++source) push(source, 0);
    EXPECT_THAT(out_.partial, SizeIs(sources));
    EXPECT_THAT(out_.sets, IsEmpty());
    out_ = {};
  }

  std::unique_ptr<Gatherer> gatherer_;
  CollectedSets out_;
};

TEST_F(LibrealsenseSyncer, ASourceWithoutAFrameYetIsNotWaitedFor) { begin(3); }

TEST_F(LibrealsenseSyncer, WaitsForSourcesThatAreExpected) {
  begin(3);
  push(1, 20);
  push(2, 21);
  EXPECT_THAT(out_.all, IsEmpty());
  push(0, 19);
  EXPECT_THAT(out_.sets, SizeIs(1));
}

TEST_F(LibrealsenseSyncer, HalfAGapIsTooFar) {
  for (const double apart_ms : {9.999999, 10.0}) {
    out_ = {};
    begin(2);
    push(0, 20);
    push(1, 20 + apart_ms);
    EXPECT_THAT(out_.sets, SizeIs(apart_ms < 10 ? 1 : 0)) << apart_ms;
    EXPECT_THAT(out_.partial, SizeIs(apart_ms < 10 ? 0 : 2)) << apart_ms;
  }
}

TEST_F(LibrealsenseSyncer, ALaterFrontBesideTheGroupEndsTheWait) {
  begin(3);
  push(0, 20);
  push(1, 20);
  EXPECT_THAT(out_.all, IsEmpty());
  push(2, 40);  // its frame of 20 ms was lost
  ASSERT_THAT(out_.partial, SizeIs(1));
  EXPECT_THAT(out_.partial[0], SizeIs(2));
}

TEST_F(LibrealsenseSyncer, InactiveAfterSevenGaps) {
  begin(2);
  for (double stamp_ms = 20; stamp_ms < 20 + 7 * kGapMs; stamp_ms += kGapMs) push(0, stamp_ms);
  EXPECT_THAT(out_.all, IsEmpty());
  push(0, 20 + 7 * kGapMs);  // source 1 was expected at 20 ms
  EXPECT_THAT(out_.partial, SizeIs(8));
  push(0, 20 + 8 * kGapMs);
  EXPECT_THAT(out_.partial, SizeIs(9)) << "nobody waits for an inactive source";
  push(1, 20 + 9 * kGapMs);
  push(0, 20 + 9 * kGapMs);
  EXPECT_THAT(out_.sets, SizeIs(1)) << "it is active again";
  EXPECT_EQ(gatherer_->discarded(), 0U);
}

TEST_F(LibrealsenseSyncer, AFullQueueDropsItsOldest) {
  make(2, 3);
  push(0, 0);
  push(1, 0);
  for (int i = 1; i <= 5; ++i) push(0, i * kGapMs);
  EXPECT_EQ(gatherer_->discarded(), 2U);
}

// The rule as it stands in the header, looked at anew for every frame.
class Naive {
 public:
  Naive(std::uint32_t sources, Nanoseconds gap, std::uint32_t limit)
      : gap_(gap), limit_(limit), queues_(sources), expected_(sources) {}

  void push(const GatherFrame& frame, FrameSetSink& sink, std::uint32_t sources) {
    auto& queue = queues_[frame.source];
    if (queue.size() == limit_) queue.pop_front();
    queue.push_back(frame);
    expected_[frame.source] = frame.stamp + gap_;
    while (emit(frame.stamp, sink, sources)) continue;
  }

 private:
  bool near(GlobalTime a, GlobalTime b) const { return 2 * std::chrono::abs(a - b) < gap_; }

  bool emit(GlobalTime newest, FrameSetSink& sink, std::uint32_t sources) {
    std::optional<GlobalTime> earliest;
    for (const auto& queue : queues_) {
      if (!queue.empty())
        earliest = std::min(earliest.value_or(GlobalTime::max()), queue.front().stamp);
    }
    if (!earliest) return false;
    bool all_near = true;
    bool wait = false;
    for (std::size_t i = 0; i < queues_.size(); ++i) {
      if (!queues_[i].empty()) {
        all_near = all_near && near(*earliest, queues_[i].front().stamp);
      } else if (expected_[i] && newest > *expected_[i]) {
        wait = wait || newest - *expected_[i] < 7 * gap_;
      } else if (expected_[i]) {
        wait = wait || near(*earliest, *expected_[i]);
      }
    }
    if (all_near && wait) return false;
    std::vector<GatherFrame> group;
    for (auto& queue : queues_) {
      if (queue.empty() || !near(*earliest, queue.front().stamp)) continue;
      group.push_back(queue.front());
      queue.pop_front();
    }
    if (group.size() == sources) {
      sink.on_set(group);
    } else {
      sink.on_partial_set(group);
    }
    return true;
  }

  Nanoseconds gap_;
  std::uint32_t limit_;
  std::vector<std::deque<GatherFrame>> queues_;
  std::vector<std::optional<GlobalTime>> expected_;
};

TEST(LibrealsenseSyncerRandom, EqualsTheNaiveImplementation) {
  std::size_t sets = 0;
  std::size_t partial = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const GatheringWorld world = {.sources = 1 + seed % 6,
                                  .period_ms = kGapMs,
                                  .sigma_ms = 1.5 * (seed % 4),
                                  .drop = 0.1 * (seed % 9),
                                  .delay_max_ms = 25.0 * (seed % 3),
                                  .quantum_ms = seed % 5 == 0 ? 4.0 : 0.0};
    const auto limit = static_cast<std::uint32_t>(1 + seed % 10);
    const auto gatherer = make_librealsense_gatherer(
        {.sources = world.sources, .period = from_ms(kGapMs), .queue_limit = limit});
    Naive naive(world.sources, from_ms(kGapMs), limit);
    CollectedSets out;
    CollectedSets expected;
    for (const GatherFrame& frame : nonempty(frames_of(world, seed))) {
      gatherer->push(frame, out);
      naive.push(frame, expected, world.sources);
      ASSERT_EQ(out.all.size(), expected.all.size()) << "seed " << seed;
    }
    for (std::size_t i = 0; i < out.all.size(); ++i) {
      ASSERT_EQ(out.all[i].size(), expected.all[i].size()) << "seed " << seed;
      for (std::size_t j = 0; j < out.all[i].size(); ++j) {
        ASSERT_EQ(out.all[i][j].tag, expected.all[i][j].tag) << "seed " << seed;
      }
    }
    sets += out.sets.size();
    partial += out.partial.size();
  }
  EXPECT_GT(sets, 1'000U);
  EXPECT_GT(partial, 1'000U);
}

}  // namespace
}  // namespace simbench

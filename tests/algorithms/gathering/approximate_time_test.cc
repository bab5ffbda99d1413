// ApproximateTime by example, and against an implementation without any thought of speed.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "algorithms/gathering/gatherers.h"
#include "tests/algorithms/gathering/collected_sets.h"
#include "tests/algorithms/gathering/gathering_world.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// The policy with a list per queue, copied for every virtual search.
class NaiveApproximateTime {
 public:
  NaiveApproximateTime(std::uint32_t sources, const ApproximateTimeOptions& options)
      : options_(options), state_{.ahead = Queues(sources), .aside = Queues(sources)} {
    dropped_.resize(sources);
  }

  void push(const GatherFrame& frame, FrameSetSink& sink) {
    const std::uint32_t source = frame.source;
    state_.ahead[source].push_back(frame);
    if (state_.ahead[source].size() == 1) search(sink);
    if (state_.ahead[source].size() + state_.aside[source].size() <= options_.queue) return;
    put_back();
    state_.ahead[source].pop_front();
    ++discarded;
    dropped_[source] = true;
    if (candidate_.empty()) return;
    candidate_.clear();
    search(sink);
  }

  std::uint64_t discarded = 0;

 private:
  using Queues = std::vector<std::deque<GatherFrame>>;
  struct State {
    Queues ahead;
    Queues aside;
  };
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
    double start = 0;
    double end = 0;
  };

  static double ns(const GatherFrame& frame) {
    return static_cast<double>(nanoseconds_of(frame.stamp));
  }
  double time_of(std::size_t source) const {
    if (!state_.ahead[source].empty()) return ns(state_.ahead[source].front());
    const double bound = static_cast<double>(options_.lower_bound.count());
    return std::max(ns(state_.aside[source].back()) + bound, pivot_time_);
  }
  Range range() const {
    Range range;
    for (std::size_t source = 0; source < state_.ahead.size(); ++source) {
      const double time = time_of(source);
      if (source == 0 || time < range.start) range.first = source, range.start = time;
      if (source == 0 || time >= range.end) range.last = source, range.end = time;
    }
    return range;
  }
  bool all_ahead() const {
    return std::ranges::none_of(state_.ahead, [](const auto& queue) { return queue.empty(); });
  }
  double later(const Range& range) const { return (range.end - end_) * (1 + options_.age_penalty); }

  void search(FrameSetSink& sink) {
    while (all_ahead()) {
      const Range now = range();
      for (std::size_t i = 0; i < dropped_.size(); ++i) dropped_[i] = dropped_[i] && i == now.last;
      if (candidate_.empty()) {
        const double widest = static_cast<double>(options_.max_interval.count());
        if ((widest > 0 && now.end - now.start > widest) || dropped_[now.last]) {
          state_.ahead[now.first].pop_front();
          ++discarded;
          continue;
        }
        pivot_ = now.last;
        pivot_time_ = now.end;
        take(now);
      } else if (later(now) < now.start - start_) {
        take(now);
      }
      step(now.first);
      const bool best = now.first == pivot_ || later(now) >= pivot_time_ - start_;
      if (best || (!all_ahead() && is_best_even_virtually())) emit(sink);
    }
  }

  bool is_best_even_virtually() {
    const State kept = state_;
    bool best = false;
    for (;;) {
      const Range now = range();
      best = later(now) >= pivot_time_ - start_;
      if (best || later(now) < now.start - start_) break;
      step(now.first);
    }
    state_ = kept;
    return best;
  }

  void take(const Range& now) {
    candidate_.clear();
    for (const auto& queue : state_.ahead) candidate_.push_back(queue.front());
    for (auto& queue : state_.aside) {
      discarded += queue.size();
      queue.clear();
    }
    start_ = now.start;
    end_ = now.end;
  }

  void step(std::size_t source) {
    state_.aside[source].push_back(state_.ahead[source].front());
    state_.ahead[source].pop_front();
  }

  void put_back() {
    for (std::size_t source = 0; source < state_.ahead.size(); ++source) {
      auto& ahead = state_.ahead[source];
      ahead.insert(ahead.begin(), state_.aside[source].begin(), state_.aside[source].end());
      state_.aside[source].clear();
    }
  }

  void emit(FrameSetSink& sink) {
    sink.on_set(candidate_);
    candidate_.clear();
    put_back();
    for (auto& queue : state_.ahead) queue.pop_front();
  }

  ApproximateTimeOptions options_;
  State state_;
  std::vector<bool> dropped_;
  std::vector<GatherFrame> candidate_;  // empty: none
  double start_ = 0;
  double end_ = 0;
  std::size_t pivot_ = 0;
  double pivot_time_ = 0;
};

TEST(ApproximateTime, EqualsTheNaiveImplementation) {
  std::size_t sets = 0;
  for (std::uint32_t seed = 1; seed <= 600; ++seed) {
    const GatheringWorld world = {.sources = 1 + seed % 7,
                                  .sigma_ms = 1.5 * (seed % 6),
                                  .drop = 0.08 * (seed % 4),
                                  .delay_max_ms = 25.0 * (seed % 5),
                                  .quantum_ms = seed % 3 == 0 ? 4.0 : 0.0};
    ApproximateTimeOptions options;
    options.queue = 1 + seed % 11;
    options.age_penalty = seed % 2 == 0 ? 0.1 : 0.0;
    options.lower_bound = from_ms(kPeriodMs * 0.25 * (seed % 4));
    if (seed % 5 == 0) options.max_interval = from_ms(kPeriodMs / 2);
    const auto gatherer =
        make_approximate_time_gatherer(setup_of(world.sources, options.queue), options);
    NaiveApproximateTime naive(world.sources, options);
    CollectedSets out;
    CollectedSets expected;
    for (const GatherFrame& frame : nonempty(frames_of(world, seed))) {
      gatherer->push(frame, out);
      naive.push(frame, expected);
      ASSERT_EQ(out.sets.size(), expected.sets.size()) << "seed " << seed;
      ASSERT_EQ(gatherer->discarded(), naive.discarded) << "seed " << seed;
    }
    ASSERT_EQ(out.tags(), expected.tags()) << "seed " << seed;
    sets += out.sets.size();
  }
  EXPECT_GT(sets, 10'000U);
}

TEST(ApproximateTime, WithoutABoundASetWaitsForTheNextFrame) {
  const auto gatherer = make_approximate_time_gatherer(setup_of(2), {});
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(1, 1, 0), out);
  EXPECT_THAT(out.sets, IsEmpty()) << "source 0 might have a frame at 1 ms";
  gatherer->push(frame_at(0, 22, 1), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0, 0)));
}

TEST(ApproximateTime, ALowerBoundProvesTheSetAtOnce) {
  const auto gatherer =
      make_approximate_time_gatherer(setup_of(2), {.lower_bound = from_ms(kPeriodMs / 2)});
  CollectedSets out;
  gatherer->push(frame_at(0, 0, 0), out);
  gatherer->push(frame_at(1, 1, 0), out);
  EXPECT_THAT(out.tags(), ElementsAre(ElementsAre(0, 0)));
}

TEST(ApproximateTime, ALostFrameMixesExposuresUnlessTheIntervalIsBounded) {
  for (const bool bounded : {false, true}) {
    ApproximateTimeOptions options = {.lower_bound = from_ms(kPeriodMs / 2)};
    if (bounded) options.max_interval = from_ms(kPeriodMs / 2);
    const auto gatherer = make_approximate_time_gatherer(setup_of(3), options);
    CollectedSets out;
    for (std::int64_t pulse = 0; pulse < 20; ++pulse) {
      for (std::uint32_t source = 0; source < 3; ++source) {
        // Sources 0 and 1 lose different frames of one neighbourhood.
        if ((pulse == 10 && source == 0) || (pulse == 11 && source == 1)) continue;
        gatherer->push(frame_at(source, static_cast<double>(pulse) * kPeriodMs, pulse), out);
      }
    }
    EXPECT_EQ(out.pure(), 18);
    EXPECT_EQ(out.sets.size(), bounded ? 18U : 19U);
  }
}

TEST(ApproximateTime, TheLargestIntervalItselfIsAllowed) {
  for (const double range_ms : {5.0, 5.000001}) {
    const auto gatherer = make_approximate_time_gatherer(
        setup_of(2), {.lower_bound = from_ms(20), .max_interval = from_ms(5)});
    CollectedSets out;
    gatherer->push(frame_at(0, 0, 0), out);
    gatherer->push(frame_at(1, range_ms, 0), out);
    EXPECT_EQ(out.sets.size(), range_ms > 5 ? 0U : 1U) << range_ms;
  }
}

TEST(ApproximateTime, OnlyStampsMatterNotTheOrderOfArrival) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    GatheringWorld world = {.sources = 3, .sigma_ms = 2, .drop = 0.1};
    std::vector<std::vector<std::int64_t>> first;
    for (const double delay_ms : {0.0, 15.0, 60.0}) {
      world.delay_max_ms = delay_ms;
      const auto gatherer = make_approximate_time_gatherer(setup_of(3), {.queue = 64});
      CollectedSets out;
      for (const GatherFrame& frame : frames_of(world, seed)) gatherer->push(frame, out);
      auto tags = out.tags();
      ASSERT_GE(tags.size(), 30U);
      tags.resize(30);  // the last ones depend on where the streams end
      if (first.empty()) first = tags;
      ASSERT_EQ(tags, first) << "seed " << seed << ", delay " << delay_ms;
    }
  }
}

}  // namespace
}  // namespace simbench

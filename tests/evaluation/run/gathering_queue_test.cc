// The paper's gathering where one host's clock is seconds off: wrong sets, which a queue hides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/score_observer.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

using Set = std::vector<std::int64_t>;  // the pulses of its members, by camera

class Watched final : public ScoreObserver {
 public:
  void on_stamp(const GatherFrame& frame) override { stamps.push_back(frame); }
  void on_set(std::span<const GatherFrame> set, bool /*complete*/, GlobalTime /*now*/) override {
    Set& pulses = sets.emplace_back();
    for (const GatherFrame& frame : set) pulses.push_back(frame.tag);
  }
  void on_shift(Nanoseconds /*shift*/) override {}

  std::vector<GatherFrame> stamps;
  std::vector<Set> sets;
};

struct Gathered {
  SeedScore score;
  std::vector<GatherFrame> stamps;
  std::vector<Set> sets;
};

Gathered gathered(const std::vector<scenarios::Override>& overrides) {
  const scenarios::Scenario scenario = scenarios::load_scenario("6cam_2host_30fps", overrides);
  const PipelineChoice choice = choose_pipelines(scenario, {"yoon2021_both"}).front();
  const auto source = sim::make_simulation(scenario);
  PipelineScorer scorer(scorer_setup(scenario, choice));
  Watched watched;
  scorer.watch(watched);
  Gathered all;
  all.score = score_run(*source, choice, /*seed=*/1, scorer, scorer);
  all.stamps = watched.stamps;
  all.sets = watched.sets;
  return all;
}

// Algorithm 3 as it is printed (docs/reference/paper.md section 5): all stamps of the capture in a
// queue a camera.
std::vector<Set> sets_as_printed(const std::vector<GatherFrame>& frames, Nanoseconds interval) {
  std::vector<std::deque<GatherFrame>> queues(6);
  for (const GatherFrame& frame : frames) queues[frame.source].push_back(frame);
  std::vector<Set> sets;
  while (std::ranges::none_of(queues, &std::deque<GatherFrame>::empty)) {
    const auto [low, high] = std::ranges::minmax_element(
        queues, {}, [](const auto& queue) { return queue.front().stamp; });
    if (high->front().stamp - low->front().stamp >= interval) {
      low->pop_front();
      continue;
    }
    Set& set = sets.emplace_back();
    for (auto& queue : queues) {
      set.push_back(queue.front().tag);
      queue.pop_front();
    }
  }
  return sets;
}

const scenarios::Override kThreeSeconds = {
    "/faults", R"([{"kind": "clock_step", "host": 1, "at_ms": 1000, "step_ms": 3000}])"};

TEST(GatheringQueue, ThePapersUserGetsWrongSetsFromAClockSecondsOff) {
  const Gathered run = gathered({kThreeSeconds});
  const std::vector<Set> printed = sets_as_printed(run.stamps, from_ms(500.0 / 30));
  EXPECT_EQ(run.sets, printed);
  // 480 frames, of which the last 90 of host 0 and the first 90 of host 1 have no partner.
  EXPECT_EQ(run.score.sets.emitted, 390);
  EXPECT_EQ(run.score.sets.pure, 0);
  for (const Set& set : printed) EXPECT_EQ(set.front(), set.back() + 90);
}

TEST(GatheringQueue, AShorterQueueThanTheOffsetHidesThem) {
  const Gathered run = gathered({kThreeSeconds, {"/evaluation/gathering_queue_frames", "64"}});
  EXPECT_EQ(run.score.sets.emitted, 0);
  const Gathered longer = gathered({kThreeSeconds, {"/evaluation/gathering_queue_frames", "91"}});
  EXPECT_EQ(longer.score.sets.emitted, 390);
}

TEST(GatheringQueue, ACameraThatVanishesEndsTheSetsAndTheRunGoesOn) {
  const Gathered run = gathered({{"/faults",
                                  R"([{"kind": "camera_vanishes", "camera": 4, "at_ms": 7000,
                                       "duration_ms": 100000}])"}});
  EXPECT_EQ(run.sets, sets_as_printed(run.stamps, from_ms(500.0 / 30)));
  EXPECT_GT(run.score.sets.pure, 50);  // 2 s after the warm-up of 5 s
  EXPECT_LT(run.score.sets.pure, 65);
}

}  // namespace
}  // namespace simbench::evaluation

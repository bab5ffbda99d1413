#include "evaluation/run/part_progress.h"

#include <gmock/gmock.h>

#include <vector>

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::IsNan;

// Programs have started, and hardly begun.
constexpr double kBegun = PartProgress::kStartedShare;

// A clock that the test moves, and what was told.
struct Bench {
  Bench(std::vector<bool> of_programs, std::uint64_t seeds, std::size_t threads)
      : parts(progress, part_plan(std::move(of_programs), seeds, threads),
              [this] { return std::chrono::duration<double>(now_s); }) {}

  static Progress telling(std::vector<PartDone>& told) {
    Progress progress = [](std::uint64_t, std::uint64_t) {};
    progress.on_part = [&told](const PartDone& part) { told.push_back(part); };
    return progress;
  }

  double now_s = 0;
  std::vector<PartDone> told{};
  Progress progress = telling(told);
  PartProgress parts;
};

TEST(PartProgress, ProgramsRunFirst) {
  EXPECT_THAT(programs_first({false, true, false, true}), ElementsAre(1, 3, 0, 2));
  EXPECT_THAT(part_plan({false, true}, 2, 1).pipelines, ElementsAre(1, 0, 1, 0));
}

TEST(PartProgress, IsOffWithoutProgramsOrListeners) {
  const Bench algorithms({false, false}, 2, 1);
  EXPECT_FALSE(algorithms.parts.is_on());
  const Progress deaf = [](std::uint64_t, std::uint64_t) {};
  PartProgress unheard(deaf, part_plan({true}, 1, 1));
  EXPECT_FALSE(unheard.is_on());
  EXPECT_FALSE(unheard.share_of(0));
}

// The programs of a run start in 2 s, and a hundredth of it then takes 0.1 s.
TEST(PartProgress, WhatIsLeftIsByTheSpeedMeasured) {
  Bench bench({true}, 2, 1);
  bench.parts.begin(0);
  const ShareDone share_done = bench.parts.share_of(0);
  bench.now_s = 1.5;
  share_done(1e-9);
  EXPECT_TRUE(bench.told.empty()) << "they start";
  bench.now_s = 2 + 0.1;
  share_done(0.01);
  EXPECT_THAT(bench.told.back().left_s, IsNan()) << "they have only started";
  bench.now_s = 4.5;
  share_done(0.25);
  EXPECT_DOUBLE_EQ(bench.told.back().done, 0.25);
  EXPECT_EQ(bench.told.back().total, 2U);
  EXPECT_NEAR(bench.told.back().left_s, 7.5 + 12, 0.05);
  bench.now_s = 12;
  bench.parts.end(0);
  EXPECT_DOUBLE_EQ(bench.told.back().done, 1);
  EXPECT_NEAR(bench.told.back().left_s, 12, 0.05);
}

TEST(PartProgress, TooLittleIsNotMeasured) {
  Bench bench({true}, 1, 1);
  bench.parts.begin(0);
  const ShareDone share_done = bench.parts.share_of(0);
  share_done(kBegun);
  bench.now_s = 0.4;
  share_done(0.5);
  EXPECT_THAT(bench.told.back().left_s, IsNan()) << "too short";
  bench.now_s = 0.6;
  share_done(0.6);
  EXPECT_NEAR(bench.told.back().left_s, 0.4, 0.05);
}

TEST(PartProgress, ThreadsShareIt) {
  Bench bench({true}, 4, 2);
  for (const std::size_t run : {0, 1}) {
    bench.parts.begin(run);
    bench.parts.share_of(run)(kBegun);
  }
  bench.now_s = 4;
  bench.parts.share_of(0)(0.5);
  bench.parts.share_of(1)(0.5);
  // Three runs of 8 s are left, two at a time.
  EXPECT_NEAR(bench.told.back().left_s, 12, 0.05);
}

// A run of a program took 10 s, one of an algorithm 1 s: one of each is left.
TEST(PartProgress, EachPipelineHasASpeedOfItsOwn) {
  Bench bench({false, true}, 2, 1);
  bench.parts.begin(0);
  EXPECT_TRUE(bench.parts.share_of(0)) << "the program's";
  bench.parts.share_of(0)(kBegun);
  bench.now_s = 10;
  bench.parts.end(0);
  EXPECT_NEAR(bench.told.back().left_s, 10, 0.05) << "of algorithms nothing is known yet";
  bench.parts.begin(1);
  EXPECT_FALSE(bench.parts.share_of(1)) << "an algorithm's";
  bench.now_s = 11;
  bench.parts.end(1);
  EXPECT_NEAR(bench.told.back().left_s, 11, 0.05);
}

TEST(PartProgress, AProgramThatHasNotBegunIsTakenForTheOthers) {
  Bench bench({true, true}, 1, 2);
  bench.parts.begin(0);
  bench.parts.share_of(0)(kBegun);
  bench.now_s = 10;
  bench.parts.share_of(0)(0.5);
  EXPECT_NEAR(bench.told.back().left_s, (10 + 20) / 2.0, 0.05);
}

}  // namespace
}  // namespace simbench::evaluation

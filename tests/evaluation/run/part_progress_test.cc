#include "evaluation/run/part_progress.h"

#include <gmock/gmock.h>

#include <vector>

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::IsNan;

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

// A quarter of the first of two runs took 3 s: 9 s and 12 s are left.
TEST(PartProgress, WhatIsLeftIsByTheSpeedMeasured) {
  Bench bench({true}, 2, 1);
  bench.parts.begin(0);
  const ShareDone share_done = bench.parts.share_of(0);
  bench.now_s = 0.1;
  share_done(0.01);
  EXPECT_THAT(bench.told.back().left_s, IsNan()) << "too early";
  bench.now_s = 3;
  share_done(0.25);
  EXPECT_DOUBLE_EQ(bench.told.back().done, 0.25);
  EXPECT_EQ(bench.told.back().total, 2U);
  EXPECT_DOUBLE_EQ(bench.told.back().left_s, 21);
  bench.now_s = 10;
  bench.parts.end(0);
  EXPECT_DOUBLE_EQ(bench.told.back().done, 1);
  EXPECT_DOUBLE_EQ(bench.told.back().left_s, 10);
}

TEST(PartProgress, ThreadsShareIt) {
  Bench bench({true}, 4, 2);
  bench.parts.begin(0);
  bench.parts.begin(1);
  bench.now_s = 4;
  bench.parts.share_of(0)(0.5);
  bench.parts.share_of(1)(0.5);
  // Three runs of 8 s are left, two at a time.
  EXPECT_DOUBLE_EQ(bench.told.back().left_s, 12);
}

// A run of a program took 10 s, one of an algorithm 1 s: one of each is left.
TEST(PartProgress, EachPipelineHasASpeedOfItsOwn) {
  Bench bench({false, true}, 2, 1);
  bench.parts.begin(0);
  EXPECT_TRUE(bench.parts.share_of(0)) << "the program's";
  bench.now_s = 10;
  bench.parts.end(0);
  EXPECT_DOUBLE_EQ(bench.told.back().left_s, 10) << "of algorithms nothing is known yet";
  bench.parts.begin(1);
  EXPECT_FALSE(bench.parts.share_of(1)) << "an algorithm's";
  bench.now_s = 11;
  bench.parts.end(1);
  EXPECT_DOUBLE_EQ(bench.told.back().left_s, 11);
}

}  // namespace
}  // namespace simbench::evaluation

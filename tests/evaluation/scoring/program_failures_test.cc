#include "evaluation/scoring/program_failures.h"

#include <gmock/gmock.h>

#include <cmath>

#include "evaluation/answer/answer.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/rows.h"
#include "tests/evaluation/test_capture.h"

namespace simbench::evaluation {
namespace {

using testing::Each;
using testing::IsEmpty;
using testing::IsNan;
using testing::SizeIs;

const ProgramFailure kFailure{.host = 1,
                              .program = "chronyd",
                              .at = from_ms(250),
                              .how = "exited with status 1",
                              .last_words = "No such file"};

// A capture whose hosts have clocks some milliseconds apart.
SeedScore scored_capture(std::uint64_t seed, bool has_failed) {
  TestCapture capture(/*hosts=*/2, /*cameras_per_host=*/3);
  capture.host_errors = {Nanoseconds(0), from_ms(3)};
  PipelineScorer scorer(arrival_setup());
  capture.record(scorer);
  if (has_failed) scorer.on_event(kFailure);
  return captured_score(
      scorer, {.events = 7, .simulated_seconds = 2, .messages = 10, .notes = {"a note"}}, seed);
}

Row row_of_programs(std::vector<SeedScore> seeds) {
  scenarios::Pipeline pipeline;
  pipeline.name = "mine";
  pipeline.host_sync = "program chronyd";
  pipeline.device_time = "raw_arrival";
  pipeline.gathering = "yoon2021";
  pipeline.programs.emplace();
  return make_row(pipeline, std::move(seeds), {.gathering_interval_ms = 10, .sources = 6});
}

TEST(ProgramFailures, ASeedWithOneHasNoValues) {
  const SeedScore good = scored_capture(1, false);
  const SeedScore bad = scored_capture(1, true);
  ASSERT_THAT(bad.program_failures, SizeIs(1));
  for (const Metric& metric : metrics()) {
    if (!metric.is_series()) continue;
    EXPECT_THAT(metric.of_seed(bad), IsNan()) << metric.id;
  }
  EXPECT_GT(good.amd_ms, 1);
  EXPECT_EQ(good.packets_per_s, 5);
  EXPECT_EQ(good.sets.complete_pulses, 10);
  EXPECT_EQ(bad.sets.complete_pulses, 0);
  EXPECT_EQ(bad.frames.delivered, 0);
  EXPECT_THAT(bad.pulses, IsEmpty());
  EXPECT_THAT(bad.host_errors_ms, SizeIs(2)) << "each host has a line in hosts.csv all the same";
  EXPECT_THAT(bad.host_errors_ms, Each(IsNan()));
  EXPECT_TRUE(bad.recorded);
  EXPECT_EQ(bad.cost.events, 7U) << "it was simulated";
}

TEST(ProgramFailures, ItsRowHasFailedAndKeepsTheOtherSeeds) {
  const Row row = row_of_programs({scored_capture(1, false), scored_capture(2, true),
                                   scored_capture(3, false), scored_capture(4, false)});
  EXPECT_TRUE(row.is_of_programs);
  EXPECT_THAT(row.amd_ms.values[1], IsNan());
  EXPECT_GT(row.amd_ms.median, 1);
  EXPECT_EQ(scored_seeds(row), 3U);
  EXPECT_EQ(row.sets.complete_pulses, 30);
  const ReasonedStanding standing = standing_of(row, RankedBy::kAmd);
  EXPECT_EQ(standing.is, RowStanding::kFailed);
  EXPECT_EQ(standing.reason,
            "a program ended in 1 of 4 seeds: seed 2, host 1, at 0.250000 s: chronyd: exited with "
            "status 1: No such file");
  EXPECT_FALSE(failed_in_all_seeds(row));
}

TEST(ProgramFailures, WhateverTheRowIsElse) {
  Row row = row_of_programs({scored_capture(1, true)});
  row.host_sync = "oracle";  // a limit
  EXPECT_EQ(standing_of(row, RankedBy::kAmd).is, RowStanding::kFailed);
  EXPECT_EQ(standing_of(row, RankedBy::kExposureSpread).is, RowStanding::kFailed);
}

TEST(ProgramFailures, NoAnswerCountsIt) {
  Results results;
  results.rows = {row_of_programs({scored_capture(1, false), scored_capture(2, true)})};
  const Answer answer = answer_of(results);
  EXPECT_EQ(answer.best, nullptr);
  ASSERT_THAT(answer.failed, SizeIs(1));
}

TEST(ProgramFailures, AllSeedsAreAllThatWereRecorded) {
  EXPECT_TRUE(
      failed_in_all_seeds(row_of_programs({scored_capture(1, true), scored_capture(2, true)})));
  EXPECT_TRUE(failed_in_all_seeds(
      row_of_programs({scored_capture(1, true), missing_score(2, "no camera")})));
  EXPECT_FALSE(failed_in_all_seeds(row_of_programs({scored_capture(1, false)})));
  Row of_algorithms = row_of_programs({missing_score(1, "no camera")});
  EXPECT_TRUE(failed_in_all_seeds(of_algorithms)) << "its programs cannot run";
  of_algorithms.is_of_programs = false;
  EXPECT_FALSE(failed_in_all_seeds(of_algorithms));
}

}  // namespace
}  // namespace simbench::evaluation

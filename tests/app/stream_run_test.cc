#include "app/stream_run.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "app/recordings.h"
#include "recording/rs_csv.h"
#include "scenarios/loader.h"
#include "tests/evaluation/frames/steady_stream.h"
#include "tests/nonempty.h"

namespace simbench::app {
namespace {

using evaluation::GroundTruth;
using evaluation::kSteadyPeriodMs;
using evaluation::no_latency;
using evaluation::Results;
using evaluation::Row;
using evaluation::SeedScore;
using evaluation::steady_stream;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

Results scored(std::vector<RecordedStream> streams, const StreamScoring& scoring = {}) {
  const RecordedRun run({"rig.csv"}, {.streams = std::move(streams), .notes = {}}, scoring);
  return run.evaluate(run.chosen(scoring.pipelines), {}, nullptr);
}

const SeedScore& score_of(const Results& results, const std::string& pipeline) {
  const Row* const row = evaluation::find_row(results.rows, pipeline);
  EXPECT_NE(row, nullptr) << pipeline;
  return row->seeds.front();
}

// Two cameras, of which b's host is 1.5 ms ahead: that is the whole spread.
std::vector<RecordedStream> two_cameras(int frames = 300) {
  return {steady_stream("a", frames, 20, no_latency),
          steady_stream(
              "b", frames, -40, [](int) { return 1.5; }, 9000)};
}

TEST(StreamRun, EachDeviceTimeOfStampsIsARow) {
  const Results results = scored(two_cameras());
  ASSERT_FALSE(results.rows.empty());
  for (const Row& row : results.rows) {
    EXPECT_EQ(row.pipeline, row.device_time);
    EXPECT_EQ(row.gathering, "yoon2021");
    EXPECT_EQ(row.host_sync, "as_recorded");
    EXPECT_EQ(row.ground_truth, GroundTruth::kNone) << row.pipeline;
    EXPECT_TRUE(row.seeds.front().recorded) << row.pipeline;
  }
  EXPECT_EQ(evaluation::find_row(results.rows, "two_way_poll"), nullptr);
  EXPECT_THAT(results.warnings, IsEmpty());
}

TEST(StreamRun, SetsAreScoredUnverified) {
  const Results results =
      scored(two_cameras(), {.pipelines = {"raw_arrival", "regression_30", "raw_arrival+genlock"}});
  for (const char* pipeline : {"raw_arrival", "raw_arrival+genlock"}) {
    const SeedScore& score = score_of(results, pipeline);
    EXPECT_NEAR(score.amd_ms, 1.5, 1e-9);
    EXPECT_NEAR(score.rmdv_ms, 1.5 / std::sqrt(2), 1e-9);
    EXPECT_EQ(score.sets.emitted, 300);
    EXPECT_EQ(score.frames.delivered, 600);
    EXPECT_TRUE(std::isnan(score.absolute_error_ms)) << pipeline;
  }
  EXPECT_NEAR(score_of(results, "regression_30").amd_ms, 1.5, 2e-3);
}

TEST(StreamRun, GenlockOrderVerifiesWhereItIsStated) {
  std::vector<RecordedStream> streams = two_cameras();
  streams[1].frames.erase(streams[1].frames.begin() + 100);
  const Results results = scored(streams, {.pipelines = {"raw_arrival"}, .genlock = true});
  const SeedScore& score = score_of(results, "raw_arrival");
  EXPECT_EQ(score.ground_truth, GroundTruth::kGenlockOrder);
  EXPECT_NEAR(score.amd_ms, 1.5, 1e-9);
  EXPECT_EQ(score.sets.complete_pulses, 299);
  EXPECT_EQ(score.sets.pure, 299);
  EXPECT_EQ(score.frames.dropped, 1);
}

TEST(StreamRun, ALostFrameLeavesItsSetOutAndIsCounted) {
  std::vector<RecordedStream> streams = two_cameras();
  streams[1].frames.erase(streams[1].frames.begin() + 100);
  const Results results = scored(streams, {.pipelines = {"raw_arrival"}});
  const SeedScore& score = score_of(results, "raw_arrival");
  EXPECT_EQ(score.sets.emitted, 299);
  EXPECT_EQ(score.sets.discarded_frames, 1);
  EXPECT_EQ(score.frames.dropped, 1);
}

TEST(StreamRun, WithoutACommonStartGenlockOrderHasAWarning) {
  std::vector<RecordedStream> streams = {steady_stream("a", 300, 0, no_latency),
                                         steady_stream("b", 300, 0, no_latency)};
  streams[1].frames.erase(streams[1].frames.begin());
  const Results results = scored(streams, {.pipelines = {"raw_arrival", "raw_arrival+genlock"}});
  EXPECT_THAT(results.warnings, ElementsAre(HasSubstr("common start")));
  // Order counts from the first frames and pairs neighbours; stamps do not.
  EXPECT_NEAR(score_of(results, "raw_arrival+genlock").amd_ms, kSteadyPeriodMs, 1e-6);
  EXPECT_NEAR(score_of(results, "raw_arrival").amd_ms, 0, 1e-6);
}

TEST(StreamRun, WhatTheFilesLackIsTheRowsReason) {
  const Results results =
      scored(two_cameras(), {.pipelines = {"two_way_poll", "host_stamps", "rocsync_led", "oracle",
                                           "raw_arrival+oracle", "raw_arrival"}});
  const std::vector<std::pair<std::string, std::string>> lacks = {
      {"two_way_poll", "needs polls of the cameras' clocks"},
      {"host_stamps", "needs stamps of the host's clock"},
      {"rocsync_led", "needs sightings of a clock of LEDs"},
      {"raw_arrival+oracle", "needs the pulse of every frame"}};
  for (const auto& [pipeline, lack] : nonempty(lacks)) {
    EXPECT_FALSE(score_of(results, pipeline).recorded);
    EXPECT_THAT(score_of(results, pipeline).cost.notes, ElementsAre(HasSubstr(lack)));
  }
  EXPECT_FALSE(score_of(results, "oracle").recorded);
  EXPECT_TRUE(score_of(results, "raw_arrival").recorded);
}

TEST(StreamRun, WithoutAPeriodThereIsNoScore) {
  const Results results =
      scored({steady_stream("a", 1, 0, no_latency)}, {.pipelines = {"raw_arrival"}});
  EXPECT_FALSE(score_of(results, "raw_arrival").recorded);
  EXPECT_THAT(score_of(results, "raw_arrival").cost.notes,
              ElementsAre(HasSubstr("no camera has a frame period")));
}

TEST(StreamRun, ScoresOneKindOfStream) {
  std::vector<RecordedStream> streams = two_cameras();
  streams.push_back(steady_stream("a", 30, 0, no_latency));
  streams.back().stream = "Color 0";
  const StreamRun depth({.streams = streams, .notes = {}}, {"x"}, {});
  EXPECT_EQ(depth.kind(), "Depth 0");
  EXPECT_THAT(depth.notes(), ElementsAre("Depth 0 is scored; --stream chooses Color 0"));
  EXPECT_EQ(score_of(scored(streams, {.stream = "Color 0"}), "raw_arrival").frames.delivered, 30);
  EXPECT_THAT(
      [&] { scored(streams, {.stream = "IR"}); },
      ThrowsMessage<scenarios::InputError>("--stream: found 'IR', allowed Depth 0, Color 0"));
}

TEST(StreamRun, APipelineIsADeviceTimeAndAGathering) {
  EXPECT_THAT([] { scored(two_cameras(), {.pipelines = {"chrony+hull_300+yoon2021"}}); },
              ThrowsMessage<scenarios::InputError>(HasSubstr("device_time[+gathering]")));
  EXPECT_THAT([] { scored(two_cameras(), {.pipelines = {"hul_300"}}); },
              ThrowsMessage<scenarios::InputError>(
                  HasSubstr("--pipelines: found \"hul_300\", did you mean hull_300")));
}

TEST(StreamRun, StampsOfEveryFrameAreThere) {
  std::vector<RecordedStream> streams = two_cameras(50);
  const auto stamped = stamped_streams(streams, {"raw_arrival", "sensor_normalised"}, "--stamps");
  ASSERT_EQ(stamped.size(), 4U);
  EXPECT_EQ(stamped[1].stream, &streams[0]);
  EXPECT_EQ(stamped[2].stream, &streams[1]);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(stamped[0].stamps[i]->time_since_epoch(), streams[0].frames[i].arrival);
    EXPECT_EQ(stamped[2].stamps[i]->time_since_epoch(), streams[1].frames[i].arrival);
  }
  // Relative stamps have one anchor, the first arrival of all.
  EXPECT_FALSE(stamped[0].relative);
  EXPECT_TRUE(stamped[1].relative);
  EXPECT_EQ(stamped[1].stamps[0]->time_since_epoch(), from_ms(100));
  EXPECT_THAT([&] { stamped_streams(streams, {"two_way_poll"}, "--stamps"); },
              ThrowsMessage<scenarios::InputError>(
                  HasSubstr("--stamps: found 'two_way_poll', allowed: regression_30")));
}

TEST(StreamRun, DamagedStampsEndInScoresOrReasons) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto any = [&](int sign) {
      const std::uint64_t limit = kLargestStampMs * 1'000'000;
      return Nanoseconds(static_cast<std::int64_t>(random() % limit) * sign);
    };
    std::vector<RecordedStream> streams = two_cameras(60);
    for (RecordedStream& stream : streams) {
      for (StampedFrame& frame : stream.frames) {
        if (random() % 4 == 0) frame.sensor = any(1);
        if (random() % 4 == 0) frame.arrival = any(random() % 2 ? 1 : -1);
        if (random() % 4 == 0) frame.counter = random();
      }
    }
    for (const bool genlock : {false, true}) {
      for (const Row& row : scored(streams, {.genlock = genlock}).rows) {
        EXPECT_FALSE(row.seeds.empty()) << row.pipeline;
      }
    }
  }
}

}  // namespace
}  // namespace simbench::app

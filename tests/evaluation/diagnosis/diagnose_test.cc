// Diagnoses of hand-made recordings: one fault each.
#include "evaluation/diagnosis/diagnose.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "recording/rs_csv.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsNan;
using ::testing::Not;

constexpr double kPeriodMs = 1000.0 / 30;

// A camera that exposes a frame per period of true time; its clock is fast by `clock_ppm`, its
// host's by `host_ppm`.
struct Camera {
  std::string name;
  std::string host = "pc";
  std::string stream = "Depth 0";
  double period_ms = kPeriodMs;
  double clock_ppm = 0;
  double host_ppm = 0;
  double phase_ms = 0;
  double delay_ms = 9;
  double late_mean_ms = 0.3;  // exponential, of each arrival
  std::int64_t frames = 1800;
  std::uint32_t seed = 1;
};

RecordedStream record(const Camera& camera) {
  boost::random::mt19937 random(camera.seed + 7919 * static_cast<std::uint32_t>(camera.name[0]));
  boost::random::exponential_distribution<double> late(1);
  RecordedStream stream = {camera.name, camera.host, camera.stream, {}};
  for (std::int64_t i = 0; i < camera.frames; ++i) {
    const double at_ms = camera.phase_ms + static_cast<double>(i) * camera.period_ms;
    const double arrival_ms = at_ms + camera.delay_ms + camera.late_mean_ms * late(random);
    stream.frames.push_back({.counter = static_cast<std::uint64_t>(i + 1),
                             .sensor = from_ms(5000 + at_ms * (1 + camera.clock_ppm * 1e-6)),
                             .arrival = from_ms(arrival_ms * (1 + camera.host_ppm * 1e-6))});
  }
  return stream;
}

// Cameras "a", "b" and "c" on one trigger, their clocks tens of ppm apart.
std::vector<RecordedStream> rig(std::int64_t frames = 1800) {
  return {record({.name = "a", .frames = frames}),
          record({.name = "b", .clock_ppm = 40, .delay_ms = 11, .frames = frames}),
          record({.name = "c", .clock_ppm = -75, .delay_ms = 6, .frames = frames})};
}

std::vector<std::string> kinds(const Diagnosis& diagnosis) {
  std::vector<std::string> all;
  for (const Finding& finding : diagnosis.findings) {
    all.push_back(finding.camera + " " + finding.kind);
  }
  return all;
}

TEST(Diagnose, OneTriggerWorksWhateverTheCamerasClocksDo) {
  const Diagnosis found = diagnose(rig(), {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  EXPECT_THAT(found.findings, IsEmpty());
  EXPECT_NEAR(found.verdict.period_ms, kPeriodMs, 1e-4);
  EXPECT_NEAR(found.cameras[0].standing.phase_ms, 0, 1e-9);
  EXPECT_NEAR(found.cameras[1].standing.phase_ms, 2, 0.05);
  EXPECT_NEAR(found.cameras[2].standing.phase_ms, -3, 0.05);
  EXPECT_NEAR(found.cameras[1].facts.period_ms, kPeriodMs * (1 + 40e-6), 1e-6);
  EXPECT_EQ(found.cameras[1].facts.on_grid_share, 1);
}

TEST(Diagnose, AFreeRunningCameraIsNamedWithItsMovement) {
  std::vector<RecordedStream> streams = rig();
  streams[1] = record({.name = "b", .period_ms = kPeriodMs * (1 + 50e-6)});
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork);
  EXPECT_THAT(found.verdict.reason, HasSubstr("free-running"));
  EXPECT_THAT(kinds(found), ElementsAre("b free_running"));
  EXPECT_NEAR(found.cameras[1].standing.moves_ms_per_minute, 3, 0.05);
  EXPECT_THAT(found.findings[0].text, HasSubstr("per minute relative to camera a (+50"));
  EXPECT_EQ(found.cameras[0].standing.follows, Follows::kTrigger);
  EXPECT_EQ(found.cameras[2].standing.follows, Follows::kTrigger);
}

TEST(Diagnose, TwoCamerasThatDisagreeBothRunFree) {
  const Diagnosis found = diagnose(
      {record({.name = "a"}), record({.name = "b", .period_ms = kPeriodMs * 1.00003})}, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork);
  EXPECT_THAT(kinds(found), ElementsAre("a free_running", "b free_running"));
  EXPECT_THAT(found.findings[0].text, HasSubstr("no other camera has its period"));
}

// 10 ms of jitter leave periods uncertain by some 40 ppm, but not by 930.
TEST(Diagnose, UnsteadyCamerasThatClearlyDisagreeRunFree) {
  const auto unsteady = [](const char* name, double ppm) {
    return record({.name = name, .period_ms = kPeriodMs * (1 + ppm * 1e-6), .late_mean_ms = 10});
  };
  const Diagnosis found = diagnose({unsteady("a", 0), unsteady("b", 930)}, {});
  EXPECT_GT(found.verdict.resolution_ppm, 5);
  EXPECT_LT(found.verdict.resolution_ppm, 930);
  EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork) << found.verdict.reason;
  EXPECT_THAT(found.verdict.reason, HasSubstr("free-running"));
  EXPECT_THAT(found.verdict.reason, HasSubstr("a, b"));
  EXPECT_NEAR(found.cameras[1].standing.moves_ms_per_minute, 55.8, 5);
  // Two that agree may still differ by tens of ppm; the one that does not runs free all the same.
  const Diagnosis agreeing = diagnose({unsteady("a", 0), unsteady("b", 0)}, {});
  EXPECT_EQ(agreeing.verdict.status, SyncStatus::kCannotBeTold) << agreeing.verdict.reason;
  EXPECT_FALSE(agreeing.verdict.standard);
  const Diagnosis three = diagnose({unsteady("a", 0), unsteady("b", 930), unsteady("c", 0)}, {});
  EXPECT_EQ(three.verdict.status, SyncStatus::kDoesNotWork);
  EXPECT_EQ(three.cameras[0].standing.follows, Follows::kUnknown);
  EXPECT_EQ(three.cameras[1].standing.follows, Follows::kOwnClock);
  EXPECT_EQ(three.cameras[2].standing.follows, Follows::kUnknown);
}

TEST(Diagnose, OneColumnForBothStampsIsOneClock) {
  std::vector<RecordedStream> streams;
  for (const char* name : {"a", "b"}) {
    streams.push_back(record({.name = name, .period_ms = 50, .delay_ms = 0, .late_mean_ms = 0}));
    for (StampedFrame& frame : streams.back().frames) frame.sensor = frame.arrival;
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks);
  EXPECT_EQ(
      found.verdict.reason,
      "all 2 cameras have one frame period, to 0.02 ppm, and their stamps are within 0.001 ms "
      "of each other");
  EXPECT_EQ(found.verdict.resolution_ppm, 0.02);
  EXPECT_THAT(kinds(found), ElementsAre("a one_clock", "b one_clock"));
  EXPECT_THAT(found.cannot_know,
              Contains(HasSubstr("one column, so that there is one clock only")));
  // A frame with a delay of its own is enough for two clocks.
  streams[0].frames[7].arrival += Nanoseconds(1);
  EXPECT_THAT(kinds(diagnose(streams, {})), ElementsAre("b one_clock"));
}

TEST(Diagnose, HalfTheRateIsStillTheTrigger) {
  std::vector<RecordedStream> streams = rig();
  streams[2] = record({.name = "c", .period_ms = 2 * kPeriodMs, .clock_ppm = 20, .frames = 900});
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  EXPECT_EQ(found.cameras[2].standing.period_multiple, 2);
  EXPECT_THAT(kinds(found), ElementsAre("c divided_rate"));
  EXPECT_THAT(found.findings[0].text, HasSubstr("half the rate (15.000 Hz)"));
}

TEST(Diagnose, AllAtHalfTheRateShowsOnlyAgainstTheNominalOne) {
  std::vector<RecordedStream> streams;
  for (const char* name : {"a", "b"}) {
    streams.push_back(record({.name = name, .period_ms = 2 * kPeriodMs}));
  }
  EXPECT_THAT(kinds(diagnose(streams, {})), IsEmpty());
  EXPECT_THAT(kinds(diagnose(streams, {.rate_hz = 30})),
              ElementsAre("a divided_rate", "b divided_rate"));
}

TEST(Diagnose, AnotherRateIsNoTrigger) {
  std::vector<RecordedStream> streams = rig();
  streams[0] = record({.name = "a", .period_ms = 40, .frames = 1500});
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork);
  EXPECT_THAT(kinds(found), ElementsAre("a other_rate"));
}

TEST(Diagnose, TellsLostFramesFromSkippedTriggers) {
  std::vector<RecordedStream> streams = rig();
  std::vector<StampedFrame>& lossy = streams[0].frames;
  for (const std::ptrdiff_t at : {900, 600, 300}) lossy.erase(lossy.begin() + at);
  std::vector<StampedFrame>& skipping = streams[1].frames;
  for (const std::ptrdiff_t at : {1200, 1000}) skipping.erase(skipping.begin() + at);
  for (std::size_t i = 0; i < skipping.size(); ++i) skipping[i].counter = i;
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  EXPECT_EQ(found.cameras[0].facts.account.lost, 3);
  EXPECT_EQ(found.cameras[0].facts.account.never_exposed, 0);
  EXPECT_EQ(found.cameras[1].facts.account.lost, 0);
  EXPECT_EQ(found.cameras[1].facts.account.never_exposed, 2);
  EXPECT_THAT(kinds(found), ElementsAre("a lost_frames", "b skipped_pulses"));
}

TEST(Diagnose, FindsAPeriodSlip) {
  std::vector<RecordedStream> streams = rig(3600);
  for (std::size_t i = 1000; i < 3600; ++i) streams[2].frames[i].sensor += from_ms(kPeriodMs);
  const Diagnosis found = diagnose(streams, {});
  ASSERT_EQ(found.cameras[2].facts.jumps.size(), 1U);
  EXPECT_EQ(found.cameras[2].facts.jumps[0].periods, -1);
  EXPECT_NEAR(found.cameras[2].facts.jumps[0].step_ms, -kPeriodMs, 0.3);
  EXPECT_NEAR(found.cameras[2].facts.jumps[0].at_s, 1000 * kPeriodMs * 1e-3, 0.1);
  EXPECT_THAT(kinds(found), Contains("c period_slip"));
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << "it is on the trigger before and after";
}

TEST(Diagnose, FindsAClockThatWasSet) {
  std::vector<RecordedStream> streams = rig(3600);
  for (RecordedStream& stream : streams) {
    for (std::size_t i = 1000; i < 3600; ++i) stream.frames[i].arrival -= from_ms(250);
  }
  const Diagnosis found = diagnose(streams, {});
  for (const CameraDiagnosis& camera : nonempty(found.cameras)) {
    ASSERT_EQ(camera.facts.jumps.size(), 1U);
    EXPECT_EQ(camera.facts.jumps[0].periods, 0);
    EXPECT_NEAR(camera.facts.jumps[0].step_ms, -250, 0.3);
    EXPECT_EQ(camera.facts.backward_arrivals, 1);
  }
  EXPECT_THAT(kinds(found), Contains("a clock_step"));
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
}

TEST(Diagnose, FindsStampsInTheFuture) {
  std::vector<RecordedStream> streams = rig();
  for (const std::size_t i : {700U, 900U, 901U}) streams[0].frames[i].sensor += from_ms(12);
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.cameras[0].facts.future_stamps, 3);
  EXPECT_NEAR(found.cameras[0].facts.future_ms, 12, 0.5);
  EXPECT_THAT(kinds(found), Contains("a future_stamps"));
}

TEST(Diagnose, AWrapOfTheRegisterIsNoFault) {
  std::vector<RecordedStream> streams = rig();
  constexpr Nanoseconds kRegister = Microseconds(std::int64_t{1} << 32);
  for (StampedFrame& frame : streams[1].frames) {
    frame.sensor = (frame.sensor + kRegister - std::chrono::seconds(40)) % kRegister;
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.cameras[1].facts.wraps, 1);
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks) << found.verdict.reason;
  EXPECT_THAT(kinds(found), ElementsAre("b register_wraps"));
}

TEST(Diagnose, FindsAnUnsteadyCamera) {
  std::vector<RecordedStream> streams = rig();
  for (std::size_t i = 0; i < 1800; ++i) {
    streams[0].frames[i].sensor += from_ms(i % 2 == 0 ? 2 : -2);  // intervals of 29 and 37 ms
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_NEAR(found.cameras[0].facts.interval_jitter_ms, 4, 0.1);
  EXPECT_THAT(kinds(found), ElementsAre("a unsteady"));
  EXPECT_EQ(found.cameras[0].standing.follows, Follows::kTrigger);
}

TEST(Diagnose, FindsWhatStallsStartsLateAndEndsEarly) {
  std::vector<RecordedStream> streams = rig();
  auto& stalled = streams[0].frames;
  stalled.erase(stalled.begin() + 800, stalled.begin() + 890);  // three seconds
  auto& late = streams[1].frames;
  late.erase(late.begin(), late.begin() + 60);
  auto& early = streams[2].frames;
  early.resize(early.size() - 300);
  EXPECT_THAT(kinds(diagnose(streams, {})),
              ElementsAre("a lost_frames", "a stalled", "c ended_early", "b late_start"));
}

TEST(Diagnose, HostsWhoseClocksDifferCannotBeToldFromTriggers) {
  std::vector<RecordedStream> streams = rig();
  streams.push_back(record({.name = "d", .host = "other", .host_ppm = 20}));
  streams.push_back(record({.name = "e", .host = "other", .host_ppm = 20}));
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kCannotBeTold);
  EXPECT_THAT(found.verdict.reason, HasSubstr("differ between hosts"));
  EXPECT_THAT(kinds(found), ElementsAre("d host_or_free_running"));
  EXPECT_THAT(found.findings[0].text, HasSubstr("host other (Depth 0 of cameras d, e)"));
  EXPECT_EQ(diagnose(streams, {.one_host = true}).verdict.status, SyncStatus::kDoesNotWork);
}

TEST(Diagnose, AHostIsReportedThoughItsFirstCameraHasTooFewFrames) {
  std::vector<RecordedStream> streams = rig();
  streams.push_back(record({.name = "d", .host = "other", .host_ppm = 20, .frames = 1}));
  streams.push_back(record({.name = "e", .host = "other", .host_ppm = 20}));
  streams.push_back(record({.name = "f", .host = "other", .host_ppm = 20}));
  const Diagnosis found = diagnose(streams, {});
  EXPECT_THAT(kinds(found), ElementsAre("e host_or_free_running", "d too_few_frames"));
  EXPECT_THAT(found.findings.front().text, HasSubstr("host other (Depth 0 of cameras e, f)"));
}

TEST(Diagnose, AFreeRunningCameraAmongOthersOfItsHostIsFound) {
  std::vector<RecordedStream> streams = rig();
  streams.push_back(record({.name = "d", .host = "other", .host_ppm = 20}));
  streams.push_back(
      record({.name = "e", .host = "other", .period_ms = kPeriodMs * 1.00004, .host_ppm = 20}));
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kDoesNotWork);
}

TEST(Diagnose, SynchronisedHostsOfOneCameraEachAreRecognised) {
  std::vector<RecordedStream> streams = rig();
  for (RecordedStream& stream : streams) stream.host = stream.camera;
  EXPECT_EQ(diagnose(streams, {}).verdict.status, SyncStatus::kWorks);
}

TEST(Diagnose, DepthAndColourOfOneCamera) {
  std::vector<RecordedStream> streams;
  for (const char* name : {"a", "b"}) {
    streams.push_back(record({.name = name, .stream = "Color 0", .phase_ms = 3}));
    streams.push_back(record({.name = name}));
  }
  streams[2] = record({.name = "b", .stream = "Color 0", .period_ms = kPeriodMs * 1.0005});
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.stream, "Depth 0");
  EXPECT_EQ(found.verdict.status, SyncStatus::kWorks);
  EXPECT_EQ(found.groups[1].status, SyncStatus::kDoesNotWork);
  ASSERT_EQ(found.pairs.size(), 2U);
  EXPECT_EQ(found.pairs[0].against, "Depth 0");
  EXPECT_NEAR(found.pairs[0].offset_ms, 3, 1e-6);
  EXPECT_NEAR(found.pairs[0].spread_ms, 0, 1e-6);
  EXPECT_FALSE(found.pairs[0].runs_free);
  EXPECT_TRUE(found.pairs[1].runs_free);
  EXPECT_NEAR(found.pairs[1].moves_ms_per_minute, 30, 0.1);
  EXPECT_THAT(kinds(found), Contains("b stream_runs_free"));
}

TEST(Diagnose, AShortRecordingSaysHowLongItShouldBe) {
  std::vector<RecordedStream> streams = rig();
  for (RecordedStream& stream : streams) stream.frames.resize(150);
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kCannotBeTold);
  EXPECT_THAT(found.verdict.reason, HasSubstr("record about"));
}

TEST(Diagnose, OneCameraAloneCannotShowATrigger) {
  const Diagnosis found = diagnose({record({.name = "a"})}, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kCannotBeTold);
  EXPECT_THAT(found.verdict.reason, HasSubstr("one camera alone"));
}

TEST(Diagnose, DoubtfulStampsAreSaid) {
  std::vector<RecordedStream> streams = rig();
  EXPECT_THAT(kinds(diagnose(streams, {})), Not(Contains(HasSubstr("global_time"))));
  streams[0].realsense = true;
  for (StampedFrame& frame : streams[0].frames) frame.sensor += std::chrono::seconds(1'700'000'000);
  for (StampedFrame& frame : streams[1].frames) frame.sensor /= 1000;  // seconds, not milliseconds
  for (std::size_t i = 400; i < streams[2].frames.size(); ++i) {
    streams[2].frames[i].counter += std::uint64_t{1} << 32;
  }
  const Diagnosis found = diagnose(streams, {});
  EXPECT_THAT(kinds(found), Contains("a global_time"));
  EXPECT_THAT(kinds(found), Contains("b doubtful_rate"));
  EXPECT_THAT(kinds(found), Contains("c counter_jumps"));
  EXPECT_EQ(found.cameras[2].facts.account.lost, 0);
}

TEST(Diagnose, TooFewOrDamagedFramesAreSaid) {
  std::vector<RecordedStream> streams = rig();
  streams[0].frames.resize(1);
  for (StampedFrame& frame : streams[1].frames) frame.sensor = from_ms(7);
  std::vector<StampedFrame>& damaged = streams[2].frames;
  std::reverse(damaged.begin() + 500, damaged.begin() + 505);
  const Diagnosis found = diagnose(streams, {});
  EXPECT_EQ(found.verdict.status, SyncStatus::kCannotBeTold);
  EXPECT_THAT(kinds(found), Contains("a too_few_frames"));
  EXPECT_THAT(kinds(found), Contains("b too_few_frames"));
  EXPECT_THAT(kinds(found), Contains("c backward_stamps"));
  EXPECT_THAT(kinds(found), Contains("c counter_restarts"));
  EXPECT_EQ(found.cameras[2].facts.backward_stamps, 4);
  EXPECT_THAT(found.cameras[1].facts.host_period.period_ms, IsNan());
  EXPECT_EQ(diagnose({}, {}).verdict.status, SyncStatus::kCannotBeTold);
}

TEST(Diagnose, RandomStampsGiveAVerdictAndNoCrash) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    boost::random::mt19937_64 random(seed);
    std::vector<RecordedStream> streams(1 + seed % 3);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      streams[i] = {std::string(1, static_cast<char>('a' + i)), "pc", "Depth 0", {}};
      for (std::uint32_t frame = 0; frame < 1 + seed * 7; ++frame) {
        const auto limit = static_cast<std::uint64_t>(kLargestStampMs) * 1'000'000;
        streams[i].frames.push_back(
            {.counter = random(),
             .sensor = Nanoseconds(static_cast<std::int64_t>(random() % limit)),
             .arrival = Nanoseconds(static_cast<std::int64_t>(random() % limit))});
      }
    }
    EXPECT_NE(diagnose(streams, {}).verdict.status, SyncStatus::kWorks) << "seed " << seed;
  }
}

// The verdict's error rates: a minute at 30 FPS, arrivals late by 0.3 ms in the mean.
TEST(Diagnose, RarelyErrs) {
  int false_alarms = 0;
  int missed = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    std::vector<RecordedStream> streams;
    for (const char* name : {"a", "b", "c", "d"}) {
      streams.push_back(record({.name = name, .seed = seed * 31}));
    }
    false_alarms += diagnose(streams, {}).verdict.status != SyncStatus::kWorks ? 1 : 0;
    streams[3] = record({.name = "d", .period_ms = kPeriodMs * (1 + 10e-6), .seed = seed * 31});
    missed += diagnose(streams, {}).verdict.status != SyncStatus::kDoesNotWork ? 1 : 0;
  }
  EXPECT_LE(false_alarms, 1);
  EXPECT_LE(missed, 1);
}

}  // namespace
}  // namespace simbench::evaluation

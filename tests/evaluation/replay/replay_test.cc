#include "evaluation/replay/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "recording/rs_csv.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

constexpr double kReplayPeriodMs = 33.0;

// A camera whose clock runs `drift_ppm` slow against the host's; frames arrive `latency(i)` ms
// late.
template <class Latency>
CameraStream camera(const std::string& name, int frames, double drift_ppm, const Latency& latency,
                    double first_sensor_ms = 5000) {
  CameraStream stream{.camera = name, .host = name, .stream = "Depth 0", .frames = {}};
  for (int i = 0; i < frames; ++i) {
    const double host_ms = i * kReplayPeriodMs;
    stream.frames.push_back({.counter = static_cast<std::uint64_t>(i + 1),
                             .sensor = from_ms(first_sensor_ms + host_ms / (1 + drift_ppm * 1e-6)),
                             .arrival = from_ms(100 + host_ms + latency(i))});
  }
  return stream;
}

double no_latency(int) { return 0; }

std::string warnings_of(CameraStream stream) {
  std::string all;
  for (const std::string& warning : run_replay({std::move(stream)}).warnings) all += warning + "\n";
  return all;
}

const DeviceTimeReplay& replay_row(const CameraReplay& camera, const std::string& device_time) {
  const auto found = std::find_if(camera.rows.begin(), camera.rows.end(),
                                  [&](const auto& r) { return r.device_time == device_time; });
  EXPECT_NE(found, camera.rows.end()) << device_time;
  return *found;
}

const RigRow& replay_row(const RigReplay& rig, const std::string& device_time) {
  const auto found = std::find_if(rig.rows.begin(), rig.rows.end(),
                                  [&](const auto& r) { return r.device_time == device_time; });
  EXPECT_NE(found, rig.rows.end()) << device_time;
  return *found;
}

const GatheringReplay& gathering(const RigRow& row, const std::string& name) {
  const auto found = std::find_if(row.gatherings.begin(), row.gatherings.end(),
                                  [&](const auto& g) { return g.gathering == name; });
  EXPECT_NE(found, row.gatherings.end()) << name;
  return *found;
}

TEST(Replay, ACleanRecordingHasItsDriftAndNothingElse) {
  const Replay replay = run_replay({camera("a", 1000, 215, no_latency)});
  ASSERT_EQ(replay.cameras.size(), 1U);
  const CameraStatistics& found = replay.cameras[0].statistics;
  EXPECT_EQ(found.frames, 1000);
  EXPECT_EQ(found.missing_frames, 0);
  EXPECT_NEAR(found.drift_ppm, 215, 0.001);
  EXPECT_NEAR(found.envelope_drift_ppm, 215, 0.001);
  EXPECT_NEAR(found.excess.max_ms, 0, 2e-6);
  EXPECT_NEAR(found.sensor_period.mean_ms, kReplayPeriodMs / 1.000215, 1e-5);
  EXPECT_NEAR(found.arrival_period.mean_ms, kReplayPeriodMs, 1e-9);
  EXPECT_NEAR(replay_row(replay.cameras[0], "regression_offline").drift_ppm, 215, 0.01);
  EXPECT_NEAR(replay_row(replay.cameras[0], "regression_30").drift_ppm, 215, 0.1);
  EXPECT_NEAR(replay_row(replay.cameras[0], "raw_arrival").drift_ppm, 215, 0.01);
  EXPECT_LT(replay_row(replay.cameras[0], "regression_30").jitter_ms, 0.002);
  EXPECT_TRUE(replay.rigs.empty());
  EXPECT_TRUE(replay.warnings.empty());
}

TEST(Replay, DriftIsSoundAfterHours) {
  CameraStream stream = camera("a", 2000, -20, no_latency);
  for (StampedFrame& frame : stream.frames) {
    frame.arrival += std::chrono::hours(24 * 365 * 50);  // counts from 1970
    frame.sensor += std::chrono::hours(1000);
  }
  const Replay replay = run_replay({stream});
  EXPECT_NEAR(replay.cameras[0].statistics.drift_ppm, -20, 0.001);
  EXPECT_NEAR(replay_row(replay.cameras[0], "regression_offline").drift_ppm, -20, 0.01);
}

TEST(Replay, JitterStaysInRawArrivalsAndLeavesTheLine) {
  // Every other frame 2 ms late: about the line +-1 ms, from frame to frame +-2 ms.
  const Replay replay = run_replay({camera("a", 1001, 0, [](int i) { return i % 2 * 2.0; })});
  const CameraReplay& found = replay.cameras[0];
  EXPECT_NEAR(found.statistics.residual.sd_ms, 1, 2e-3);
  EXPECT_NEAR(found.statistics.excess.max_ms, 2, 1e-3);
  EXPECT_NEAR(replay_row(found, "raw_arrival").jitter_ms, 2, 2e-3);
  EXPECT_NEAR(replay_row(found, "raw_arrival").residual.sd_ms, 0, 1e-9);
  EXPECT_NEAR(replay_row(found, "regression_offline").jitter_ms, 0, 2e-3);
  EXPECT_NEAR(replay_row(found, "regression_offline").residual.sd_ms, 1, 2e-3);
}

TEST(Replay, RelativeStampsHaveNoDriftAndTheCommonAnchor) {
  const Replay replay = run_replay({camera("a", 50, 10, no_latency)});
  const DeviceTimeReplay& found = replay_row(replay.cameras[0], "sensor_normalised");
  EXPECT_TRUE(std::isnan(found.drift_ppm));
  EXPECT_TRUE(std::isnan(found.residual.sd_ms));
  const auto stamps = GlobalStamps(replay.cameras[0]).next();
  const std::size_t place = static_cast<std::size_t>(&found - replay.cameras[0].rows.data());
  EXPECT_EQ(stamps[place], GlobalTime(from_ms(100)));
}

TEST(Replay, TheRegisterWraps) {
  CameraStream stream = camera("a", 400, 0, no_latency, 4'294'967.296 - 3000);
  const std::vector<StampedFrame> going_on = stream.frames;
  for (StampedFrame& frame : stream.frames) {
    frame.sensor %= from_ms(4'294'967.296);
  }
  std::swap(stream.frames[150], stream.frames[151]);
  const Replay replay = run_replay({stream});
  EXPECT_EQ(replay.cameras[0].frames[399].sensor, going_on[399].sensor);
  EXPECT_EQ(replay.cameras[0].statistics.backward_steps, 1);
  ASSERT_EQ(replay.warnings.size(), 2U);
  EXPECT_NE(replay.warnings[0].find("go back once"), std::string::npos);
  EXPECT_NE(replay.warnings[1].find("arrivals go back once"), std::string::npos);
}

TEST(Replay, LostFramesAreCountedByTheCounter) {
  CameraStream stream = camera("a", 100, 0, no_latency);
  stream.frames.erase(stream.frames.begin() + 40, stream.frames.begin() + 43);
  const Replay replay = run_replay({stream});
  EXPECT_EQ(replay.cameras[0].statistics.missing_frames, 3);
  EXPECT_EQ(replay.cameras[0].statistics.long_intervals, 1);
}

TEST(Replay, TooFewFramesGiveNoNumbers) {
  const Replay replay = run_replay({camera("a", 1, 0, no_latency), camera("b", 2, 0, no_latency)});
  EXPECT_TRUE(std::isnan(replay.cameras[0].statistics.drift_ppm));
  EXPECT_TRUE(std::isnan(replay_row(replay.cameras[0], "raw_arrival").jitter_ms));
  EXPECT_FALSE(std::isnan(replay.cameras[1].statistics.drift_ppm));
}

TEST(Replay, CamerasAreComparedByGenlockOrder) {
  // Camera b's host is 1.5 ms ahead: that is the whole spread, and sqrt(1.5^2 / 2) the deviation.
  const Replay replay = run_replay(
      {camera("a", 300, 20, no_latency), camera(
                                             "b", 300, -40, [](int) { return 1.5; }, 9000)});
  ASSERT_EQ(replay.rigs.size(), 1U);
  const RigReplay& rig = replay.rigs[0];
  EXPECT_EQ(rig.complete_pulses, 300);
  EXPECT_NEAR(rig.first_arrival_range_ms, 1.5, 1e-9);
  EXPECT_TRUE(rig.common_start_plausible);
  EXPECT_NEAR(replay_row(rig, "raw_arrival").amd_ms, 1.5, 1e-9);
  EXPECT_NEAR(replay_row(rig, "raw_arrival").rmdv_ms, 1.5 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(replay_row(rig, "regression_30").amd_ms, 1.5, 2e-3);
  EXPECT_EQ(gathering(replay_row(rig, "regression_30"), "yoon2021").sets, 300);
  EXPECT_EQ(gathering(replay_row(rig, "regression_30"), "genlock").sets, 300);
  EXPECT_NEAR(gathering(replay_row(rig, "raw_arrival"), "yoon2021").amd_ms, 1.5, 1e-9);
}

TEST(Replay, ALostFrameLeavesItsPulseIncomplete) {
  CameraStream b = camera("b", 300, 0, no_latency);
  b.frames.erase(b.frames.begin() + 100);
  const Replay replay = run_replay({camera("a", 300, 0, no_latency), b});
  EXPECT_EQ(replay.rigs[0].complete_pulses, 299);
  EXPECT_NEAR(replay_row(replay.rigs[0], "raw_arrival").amd_ms, 0, 1e-9);
  EXPECT_EQ(gathering(replay_row(replay.rigs[0], "raw_arrival"), "yoon2021").sets, 299);
  EXPECT_EQ(gathering(replay_row(replay.rigs[0], "raw_arrival"), "yoon2021").discarded_frames, 1);
}

TEST(Replay, WithoutACommonStartItSaysSo) {
  CameraStream b = camera("b", 300, 0, no_latency);
  b.frames.erase(b.frames.begin());
  const Replay replay = run_replay({camera("a", 300, 0, no_latency), b});
  EXPECT_FALSE(replay.rigs[0].common_start_plausible);
  ASSERT_EQ(replay.warnings.size(), 1U);
  EXPECT_NE(replay.warnings[0].find("common start"), std::string::npos);
  // Order counts from the first frames and pairs neighbours; stamps do not.
  EXPECT_NEAR(replay_row(replay.rigs[0], "raw_arrival").amd_ms, kReplayPeriodMs, 1e-6);
  EXPECT_NEAR(gathering(replay_row(replay.rigs[0], "raw_arrival"), "yoon2021").amd_ms, 0, 1e-6);
}

TEST(Replay, WithoutAPeriodCamerasAreNotCompared) {
  const Replay replay = run_replay({camera("a", 1, 0, no_latency), camera("b", 1, 0, no_latency)});
  EXPECT_TRUE(replay.rigs.empty());
  ASSERT_EQ(replay.warnings.size(), 3U);
  EXPECT_NE(replay.warnings[2].find("no camera has a frame period"), std::string::npos);
}

TEST(Replay, EstimatorsThatNeedPollsHaveNoNumbers) {
  const Replay replay =
      run_replay({camera("a", 300, 0, no_latency), camera("b", 300, 0, no_latency)});
  for (const std::string name : {"two_way_poll", "librealsense_global"}) {
    for (const CameraReplay& each : nonempty(replay.cameras)) {
      const DeviceTimeReplay& found = replay_row(each, name);
      EXPECT_TRUE(found.needs_polls);
      EXPECT_TRUE(std::isnan(found.jitter_ms) && std::isnan(found.drift_ppm));
      EXPECT_TRUE(std::isnan(found.residual.max_ms));
      const std::size_t place = static_cast<std::size_t>(&found - each.rows.data());
      EXPECT_FALSE(GlobalStamps(each).next()[place].has_value());
    }
    EXPECT_TRUE(replay_row(replay.rigs[0], name).needs_polls);
    EXPECT_TRUE(std::isnan(replay_row(replay.rigs[0], name).amd_ms));
    EXPECT_TRUE(replay_row(replay.rigs[0], name).gatherings.empty());
  }
  EXPECT_FALSE(replay_row(replay.cameras[0], "raw_arrival").needs_polls);
}

TEST(Replay, DoubtfulNumbersHaveAWarning) {
  EXPECT_EQ(warnings_of(camera("a", 100, 9000, no_latency)), "");
  EXPECT_NE(warnings_of(camera("a", 100, -990'000, no_latency)).find("is no camera's"),
            std::string::npos);

  CameraStream back = camera("a", 100, 0, no_latency);
  for (std::size_t i = 50; i < 100; ++i) back.frames[i].arrival -= std::chrono::seconds(1);
  EXPECT_NE(warnings_of(back).find("arrivals go back once"), std::string::npos);

  CameraStream global = camera("a", 100, 0, no_latency, 1.7e12);
  EXPECT_NE(warnings_of(global).find("count from 1970"), std::string::npos);

  CameraStream restarted = camera("a", 100, 0, no_latency);
  for (std::size_t i = 50; i < 100; ++i) restarted.frames[i].counter -= 50;
  EXPECT_NE(warnings_of(restarted).find("stands still or goes back once"), std::string::npos);
}

TEST(Replay, AJumpOfTheCounterIsNoLoss) {
  for (const std::uint64_t jump :
       {std::uint64_t{1000}, std::uint64_t{1} << 32, (std::uint64_t{1} << 32) - 1}) {
    CameraStream stream = camera("a", 100, 0, no_latency);
    for (std::size_t i = 50; i < 100; ++i) stream.frames[i].counter += jump;
    EXPECT_NE(warnings_of(stream).find("counter jumps once"), std::string::npos) << jump;
    const Replay replay = run_replay({stream});
    EXPECT_EQ(replay.cameras[0].statistics.missing_frames, 0) << jump;
  }
  // A pause in which the camera went on counting is a loss.
  CameraStream paused = camera("a", 3000, 0, no_latency);
  paused.frames.erase(paused.frames.begin() + 500, paused.frames.begin() + 2500);
  EXPECT_EQ(warnings_of(paused), "");
  EXPECT_EQ(run_replay({paused}).cameras[0].statistics.missing_frames, 2000);
}

TEST(Replay, LongWorkReportsProgressAndEndsByWhatThatThrows) {
  const CameraStream stream = camera("a", 240'000, 0, no_latency);
  std::uint64_t last = 0;
  std::uint64_t all = 0;
  run_replay({stream}, [&](std::uint64_t done, std::uint64_t total) {
    EXPECT_GT(done, last);
    last = done;
    all = total;
  });
  EXPECT_GT(all, 4'000'000U);
  EXPECT_EQ(last, all);
  struct Stop {};
  EXPECT_THROW(run_replay({stream}, [](std::uint64_t, std::uint64_t) { throw Stop(); }), Stop);
}

TEST(Replay, StreamsOfDifferentKindsAreNotCompared) {
  CameraStream colour = camera("a", 30, 0, no_latency);
  colour.stream = "Color 0";
  EXPECT_TRUE(run_replay({camera("a", 30, 0, no_latency), colour}).rigs.empty());
}

TEST(Replay, DamagedStampsGiveNoUndefinedNumbers) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto any = [&](int sign) {
      const std::uint64_t limit = kLargestStampMs * 1'000'000;
      return Nanoseconds(static_cast<std::int64_t>(random() % limit) * sign);
    };
    std::vector<CameraStream> streams;
    for (const char* name : {"a", "b"}) {
      CameraStream stream = camera(name, 60, 0, no_latency);
      for (StampedFrame& frame : stream.frames) {
        if (random() % 4 == 0) frame.sensor = any(1);
        if (random() % 4 == 0) frame.arrival = any(random() % 2 ? 1 : -1);
        if (random() % 4 == 0) frame.counter = random();
      }
      streams.push_back(stream);
    }
    const Replay replay = run_replay(streams);
    for (const CameraReplay& found : nonempty(replay.cameras)) {
      EXPECT_GE(found.statistics.missing_frames, 0);
      EXPECT_TRUE(std::isfinite(found.statistics.drift_ppm));
      for (const DeviceTimeReplay& r : found.rows) {
        EXPECT_EQ(std::isnan(r.jitter_ms), r.needs_polls) << r.device_time;
      }
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation

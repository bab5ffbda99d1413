#include "evaluation/frames/camera_statistics.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "recording/rs_csv.h"
#include "tests/evaluation/frames/steady_stream.h"

namespace simbench::evaluation {
namespace {

CameraStatistics statistics_of(const RecordedStream& stream) {
  return camera_statistics(unwrapped(stream.frames));
}

std::string doubts_text(const RecordedStream& stream) {
  std::string all;
  for (const std::string& doubt : doubts_of(stream)) all += doubt + "\n";
  return all;
}

TEST(CameraStatistics, ACleanStreamHasItsDriftAndNothingElse) {
  const RecordedStream stream = steady_stream("a", 1000, 215, no_latency);
  const CameraStatistics found = statistics_of(stream);
  EXPECT_EQ(found.frames, 1000);
  EXPECT_EQ(found.long_intervals, 0);
  EXPECT_NEAR(found.drift_ppm, 215, 0.001);
  EXPECT_NEAR(found.envelope_drift_ppm, 215, 0.001);
  EXPECT_NEAR(found.excess.max_ms, 0, 2e-6);
  EXPECT_NEAR(found.sensor_period.mean_ms, kSteadyPeriodMs / 1.000215, 1e-5);
  EXPECT_NEAR(found.arrival_period.mean_ms, kSteadyPeriodMs, 1e-9);
  EXPECT_EQ(doubts_text(stream), "");
}

TEST(CameraStatistics, DriftIsSoundAfterHours) {
  RecordedStream stream = steady_stream("a", 2000, -20, no_latency);
  for (StampedFrame& frame : stream.frames) {
    frame.arrival += std::chrono::hours(24 * 365 * 50);  // counts from 1970
    frame.sensor += std::chrono::hours(1000);
  }
  EXPECT_NEAR(statistics_of(stream).drift_ppm, -20, 0.001);
}

TEST(CameraStatistics, LateFramesAreResidualAndExcess) {
  // Every other frame 2 ms late: about the line +-1 ms, from frame to frame +-2 ms.
  const CameraStatistics found =
      statistics_of(steady_stream("a", 1001, 0, [](int i) { return i % 2 * 2.0; }));
  EXPECT_NEAR(found.residual.sd_ms, 1, 2e-3);
  EXPECT_NEAR(found.excess.max_ms, 2, 1e-3);
}

TEST(CameraStatistics, TheRegisterWraps) {
  RecordedStream stream = steady_stream("a", 400, 0, no_latency, 4'294'967.296 - 3000);
  const std::vector<StampedFrame> going_on = stream.frames;
  for (StampedFrame& frame : stream.frames) frame.sensor %= from_ms(4'294'967.296);
  std::swap(stream.frames[150], stream.frames[151]);
  EXPECT_EQ(unwrapped(stream.frames)[399].sensor, going_on[399].sensor);
  EXPECT_EQ(statistics_of(stream).backward_steps, 1);
  EXPECT_NE(doubts_text(stream).find("sensor stamps go back once"), std::string::npos);
  EXPECT_NE(doubts_text(stream).find("arrivals go back once"), std::string::npos);
}

TEST(CameraStatistics, TooFewFramesGiveNoNumbers) {
  EXPECT_TRUE(std::isnan(statistics_of(steady_stream("a", 1, 0, no_latency)).drift_ppm));
  EXPECT_FALSE(std::isnan(statistics_of(steady_stream("a", 2, 0, no_latency)).drift_ppm));
  EXPECT_EQ(statistics_of({}).frames, 0);
  EXPECT_NE(doubts_text(steady_stream("a", 1, 0, no_latency)).find("has one frame"),
            std::string::npos);
}

TEST(CameraStatistics, StampsHaveTheirJitterAndTheirDelay) {
  const std::vector<StampedFrame> frames =
      unwrapped(steady_stream("a", 1001, 100, [](int i) { return i % 2 * 2.0; }).frames);
  std::vector<GlobalTime> arrivals;
  std::vector<GlobalTime> steady;
  for (const StampedFrame& frame : frames) {
    arrivals.emplace_back(frame.arrival);
    steady.emplace_back(frame.sensor);
  }
  const StampStatistics raw = stamp_statistics(frames, arrivals, false);
  EXPECT_NEAR(raw.jitter_ms, 2, 2e-3);
  EXPECT_NEAR(raw.residual.sd_ms, 0, 1e-9);
  EXPECT_NEAR(raw.drift_ppm, 100, 0.5);
  const StampStatistics relative = stamp_statistics(frames, steady, true);
  EXPECT_NEAR(relative.jitter_ms, 0, 1e-6);
  EXPECT_TRUE(std::isnan(relative.drift_ppm));
  EXPECT_TRUE(std::isnan(relative.residual.sd_ms));
  EXPECT_TRUE(std::isnan(stamp_statistics({}, {}, false).jitter_ms));
}

TEST(CameraStatistics, DoubtfulNumbersAreSaid) {
  EXPECT_EQ(doubts_text(steady_stream("a", 100, 9000, no_latency)), "");
  EXPECT_NE(doubts_text(steady_stream("a", 100, -990'000, no_latency)).find("is no camera's"),
            std::string::npos);

  RecordedStream back = steady_stream("a", 100, 0, no_latency);
  for (std::size_t i = 50; i < 100; ++i) back.frames[i].arrival -= std::chrono::seconds(1);
  EXPECT_NE(doubts_text(back).find("arrivals go back once"), std::string::npos);

  RecordedStream epoch = steady_stream("a", 100, 0, no_latency, 1.7e12);
  EXPECT_EQ(doubts_text(epoch), "") << "a camera under PTP";
  epoch.realsense = true;
  EXPECT_NE(doubts_text(epoch).find("count from 1970"), std::string::npos);

  RecordedStream restarted = steady_stream("a", 100, 0, no_latency);
  for (std::size_t i = 50; i < 100; ++i) restarted.frames[i].counter -= 50;
  EXPECT_NE(doubts_text(restarted).find("stands still or goes back once"), std::string::npos);

  RecordedStream jumped = steady_stream("a", 100, 0, no_latency);
  for (std::size_t i = 50; i < 100; ++i) jumped.frames[i].counter += 1000;
  EXPECT_NE(doubts_text(jumped).find("counter jumps once"), std::string::npos);
}

TEST(CameraStatistics, DamagedStampsGiveNoUndefinedNumbers) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto any = [&](int sign) {
      const std::uint64_t limit = kLargestStampMs * 1'000'000;
      return Nanoseconds(static_cast<std::int64_t>(random() % limit) * sign);
    };
    RecordedStream stream = steady_stream("a", 60, 0, no_latency);
    for (StampedFrame& frame : stream.frames) {
      if (random() % 4 == 0) frame.sensor = any(1);
      if (random() % 4 == 0) frame.arrival = any(random() % 2 ? 1 : -1);
    }
    EXPECT_TRUE(std::isfinite(statistics_of(stream).drift_ppm));
  }
}

}  // namespace
}  // namespace simbench::evaluation

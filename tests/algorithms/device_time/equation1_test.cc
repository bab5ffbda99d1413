#include <gtest/gtest.h>

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

using Reading = Equation1Reading;

std::vector<GlobalTime> by(Reading reading, const std::vector<DeviceSample>& samples) {
  return stamps(*make_equation1(reading), samples);
}

// Frames at a jittering 45 FPS with jittering arrivals, of a device 50 ppm off.
std::vector<DeviceSample> jittering(std::int64_t frames, std::uint32_t seed) {
  boost::random::mt19937 random(seed);
  boost::random::exponential_distribution<double> excess_ns(1e-6);
  std::vector<DeviceSample> samples;
  for (std::int64_t i = 0; i < frames; ++i) {
    const std::int64_t sensor_us = i * 22'222 + static_cast<std::int64_t>(random() % 3);
    samples.push_back(sample_at(
        kDeviceZeroUs + sensor_us,
        kHostZeroNs + 1000 * sensor_us + sensor_us / 20 + std::llround(excess_ns(random))));
  }
  return samples;
}

TEST(Equation1, FirstFrameIsItsArrival) {
  for (const Reading reading :
       {Reading::kPrinted, Reading::kIntervalPrevious, Reading::kIntervalCurrent}) {
    EXPECT_EQ(nanoseconds_of(make_equation1(reading)->stamp(sample_at(5, 77))), 77);
  }
}

TEST(Equation1, IntervalPreviousPredictsALineExactly) {
  // Sensor intervals vary, arrivals follow them at 1.0001 times the rate: slope and prediction
  // hold.
  std::int64_t sensor_us = kDeviceZeroUs;
  std::vector<DeviceSample> samples;
  for (std::int64_t i = 0; i < 100; ++i) {
    sensor_us += 20'000 + 10 * (i * i % 7);
    samples.push_back(sample_at(sensor_us, kHostZeroNs + 1000 * sensor_us + sensor_us / 10));
  }
  const std::vector<GlobalTime> estimates = by(Reading::kIntervalPrevious, samples);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(nanoseconds_of(estimates[i]), nanoseconds_of(samples[i].arrival)) << "frame " << i;
  }
}

TEST(Equation1, IntervalPreviousPredictsFromThePreviousArrival) {
  // Constant sensor intervals determine no slope: the prediction is the mean arrival interval.
  const std::vector<DeviceSample> samples = {sample_at(0, 0), sample_at(1000, 1'000'000),
                                             sample_at(2000, 2'300'000)};
  const std::vector<GlobalTime> estimates = by(Reading::kIntervalPrevious, samples);
  EXPECT_EQ(nanoseconds_of(estimates[1]), 1'000'000);
  EXPECT_EQ(nanoseconds_of(estimates[2]), 1'000'000 + (1'000'000 + 1'300'000) / 2);
}

TEST(Equation1, IntervalPreviousHasALineOfIntervals) {
  // Intervals (1000 us, 1.0 ms), (1002 us, 1.2 ms), (1001 us, 1.4 ms): the line through them is
  // 1.2 ms + 100 ns/us * (dx - 1001), so 1.2 ms at the last.
  const std::vector<DeviceSample> samples = {sample_at(0, 0), sample_at(1000, 1'000'000),
                                             sample_at(2002, 2'200'000),
                                             sample_at(3003, 3'600'000)};
  EXPECT_EQ(nanoseconds_of(by(Reading::kIntervalPrevious, samples).back()), 3'400'000);
  EXPECT_EQ(nanoseconds_of(by(Reading::kIntervalCurrent, samples).back()), 4'800'000);
  // As printed, in ms: slope 0.1 ms / 0.001 ms = 100, intercept 1.2 - 100 * 1.001 = -98.9;
  // -98.9 * 1.001 + 100 = 1.0011 ms.
  EXPECT_EQ(nanoseconds_of(by(Reading::kPrinted, samples).back()), 3'600'000 + 1'001'100);
}

TEST(Equation1, IntervalCurrentIsOneArrivalIntervalLater) {
  constexpr std::uint32_t kSeed = 8;
  const std::vector<DeviceSample> samples = jittering(300, kSeed);
  const std::vector<GlobalTime> previous = by(Reading::kIntervalPrevious, samples);
  const std::vector<GlobalTime> current = by(Reading::kIntervalCurrent, samples);
  double bias_ns = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    ASSERT_EQ((current[i] - previous[i]).count(),
              (samples[i].arrival - samples[i - 1].arrival).count())
        << "frame " << i << ", seed " << kSeed;
    bias_ns += to_ms(current[i] - previous[i]) * 1e6 / 299;
  }
  EXPECT_NEAR(bias_ns, 22'223'111, 50'000) << "a period, seed " << kSeed;
}

TEST(Equation1, WindowIsThirtyIntervals) {
  // Two late arrivals make three odd intervals; the last leaves the window at frame 131.
  std::vector<DeviceSample> samples = line(200, 20'000, 50, 0);
  samples[100].arrival += from_ms(3);
  samples[99].arrival += from_ms(1);
  const std::vector<GlobalTime> estimates = by(Reading::kIntervalPrevious, samples);
  const auto is_exact = [&](std::size_t i) {
    return nanoseconds_of(estimates[i]) == nanoseconds_of(samples[i].arrival);
  };
  EXPECT_TRUE(is_exact(98));
  EXPECT_FALSE(is_exact(129));  // holds the intervals 100 .. 129, which sum to -1 ms
  EXPECT_FALSE(is_exact(130));
  for (std::size_t i = 131; i < samples.size(); ++i) ASSERT_TRUE(is_exact(i)) << "frame " << i;
}

TEST(Equation1, PrintedIsNonsense) {
  // Orders of magnitude beyond any frame interval, as in docs/reference/paper.md section 3.
  constexpr std::uint32_t kSeed = 9;
  const std::vector<DeviceSample> samples = jittering(500, kSeed);
  const std::vector<GlobalTime> estimates = by(Reading::kPrinted, samples);
  double mean_ms = 0;
  for (std::size_t i = 31; i < samples.size(); ++i) {
    mean_ms += std::abs(to_ms(offset_between(estimates[i], samples[i].arrival))) / 469;
  }
  EXPECT_GT(mean_ms, 1e4) << "seed " << kSeed;
  EXPECT_LT(mean_ms, 1e7) << "seed " << kSeed;
}

TEST(Equation1, EqualAndDecreasingStampsGiveTheMeanInterval) {
  // All intervals alike: slope 1, intercept mean(dy - dx).
  const std::vector<DeviceSample> equal = {sample_at(5, 0), sample_at(5, 1000), sample_at(5, 3000)};
  EXPECT_EQ(nanoseconds_of(by(Reading::kIntervalPrevious, equal).back()), 1000 + 1500);
  const std::vector<DeviceSample> decreasing = {sample_at(30, 0), sample_at(20, 1000),
                                                sample_at(10, 3000)};
  EXPECT_EQ(nanoseconds_of(by(Reading::kIntervalPrevious, decreasing).back()), 1000 + 1500);
}

TEST(Equation1, CorrectionsAreLimited) {
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  const std::vector<DeviceSample> wild = {
      sample_at(0, 0),         sample_at(1'000'000'000'000'000, 0),
      sample_at(0, kHigh / 2), sample_at(1, -kHigh / 2),
      sample_at(kHigh, kHigh), sample_at(-kHigh, -kHigh)};
  for (const Reading reading :
       {Reading::kPrinted, Reading::kIntervalPrevious, Reading::kIntervalCurrent}) {
    const std::vector<GlobalTime> estimates = by(reading, wild);  // under UBSan: no overflow
    const std::int64_t correction_ns = nanoseconds_of(estimates[1]);
    EXPECT_LE(std::abs(correction_ns), 100'000'000'000'000'000);
  }
}

}  // namespace
}  // namespace simbench

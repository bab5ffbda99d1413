#include <gtest/gtest.h>

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

std::vector<GlobalTime> online(const std::vector<DeviceSample>& samples, std::size_t frames = 30) {
  return stamps(*make_regression(RegressionWindow{frames}), samples);
}

std::vector<GlobalTime> offline(const std::vector<DeviceSample>& samples) {
  return stamps(*make_offline_regression(), samples);
}

std::vector<std::int64_t> arrivals_of(const std::vector<DeviceSample>& samples) {
  std::vector<std::int64_t> all;
  all.reserve(samples.size());
  for (const DeviceSample& sample : samples) all.push_back(nanoseconds_of(sample.arrival));
  return all;
}

std::vector<std::int64_t> counts_of(const std::vector<GlobalTime>& times) {
  std::vector<std::int64_t> all;
  all.reserve(times.size());
  for (const GlobalTime time : times) all.push_back(nanoseconds_of(time));
  return all;
}

TEST(Regression, RecoversALineToTheNanosecond) {
  for (const std::int64_t rate_ppm : {0, 50, -50, 200, -200, 100'000}) {
    const std::vector<DeviceSample> samples = line(2000, 20'000, rate_ppm, 28'000'000);
    EXPECT_EQ(counts_of(online(samples)), arrivals_of(samples)) << rate_ppm << " ppm";
    EXPECT_EQ(counts_of(offline(samples)), arrivals_of(samples)) << rate_ppm << " ppm";
  }
}

TEST(Regression, FirstFrameIsItsArrival) {
  const std::vector<DeviceSample> one = {sample_at(17, kHostZeroNs)};
  EXPECT_EQ(counts_of(online(one)), arrivals_of(one));
  EXPECT_EQ(counts_of(offline(one)), arrivals_of(one));
  EXPECT_EQ(counts_of(online(one, 1)), arrivals_of(one));
}

TEST(Regression, EqualSensorStampsGiveTheMeanOffset) {
  const std::vector<DeviceSample> samples = {sample_at(5, 1000), sample_at(5, 3000),
                                             sample_at(5, 8000)};
  EXPECT_EQ(counts_of(online(samples)), (std::vector<std::int64_t>{1000, 2000, 4000}));
  EXPECT_EQ(counts_of(offline(samples)), (std::vector<std::int64_t>{4000, 4000, 4000}));
}

TEST(Regression, DecreasingStampsAreOnTheLineToo) {
  std::vector<DeviceSample> samples = line(50, 20'000, 50, 0);
  samples = std::vector<DeviceSample>(samples.rbegin(), samples.rend());
  EXPECT_EQ(counts_of(online(samples)), arrivals_of(samples));
  EXPECT_EQ(counts_of(offline(samples)), arrivals_of(samples));
}

TEST(Regression, WindowForgets) {
  // The host steps by 5 ms at frame 100. A window of 30 has forgotten it at frame 129, not before.
  std::vector<DeviceSample> samples = line(200, 20'000, 50, 0);
  for (std::size_t i = 100; i < samples.size(); ++i) samples[i].arrival += from_ms(5);
  const std::vector<std::int64_t> estimates = counts_of(online(samples));
  const std::vector<std::int64_t> arrivals = arrivals_of(samples);
  EXPECT_EQ(estimates[99], arrivals[99]);
  // One point of 30, h off at the end of the line, pulls the end by its leverage (4n-2)/(n(n+1)).
  EXPECT_NEAR(static_cast<double>(arrivals[100] - estimates[100]),
              5e6 * (1 - (4.0 * 30 - 2) / (30.0 * 31)), 1);
  EXPECT_NE(estimates[128], arrivals[128]);
  for (std::size_t i = 129; i < samples.size(); ++i) ASSERT_EQ(estimates[i], arrivals[i]) << i;
}

TEST(Regression, OneLatePointCountsWithItsLeverage) {
  // Until the window is full: at the last of n points, (4n-2)/(n(n+1)).
  for (std::int64_t n = 2; n <= 30; ++n) {
    std::vector<DeviceSample> samples = line(n, 20'000, 0, 0);
    const std::int64_t true_ns = nanoseconds_of(samples.back().arrival);
    samples.back().arrival += from_ms(1);
    const double leverage = static_cast<double>(4 * n - 2) / static_cast<double>(n * (n + 1));
    EXPECT_NEAR(error_ns(online(samples).back(), true_ns), 1e6 * leverage, 0.51) << n;
  }
}

TEST(Regression, WhiteNoiseLeavesTwoSigmaBySqrtN) {
  constexpr std::uint32_t kSeed = 3;
  boost::random::mt19937 random(kSeed);
  boost::random::normal_distribution<double> noise_ns(0, 1e6);
  constexpr std::int64_t kFrames = 60'000;
  std::vector<DeviceSample> samples = line(kFrames, 20'000, 50, 28'000'000);
  const std::vector<std::int64_t> truth = arrivals_of(samples);
  for (DeviceSample& sample : samples)
    sample.arrival += Nanoseconds(std::llround(noise_ns(random)));
  for (const std::size_t n : {std::size_t{30}, std::size_t{100}}) {
    const std::vector<GlobalTime> estimates = online(samples, n);
    double squares = 0;
    double sum = 0;
    for (std::size_t i = n; i < samples.size(); ++i) {
      const double error = error_ns(estimates[i], truth[i]);
      squares += error * error;
      sum += error;
    }
    const double frames = static_cast<double>(samples.size() - n);
    const double expected = 2 * 1e6 / std::sqrt(static_cast<double>(n));
    EXPECT_NEAR(std::sqrt(squares / frames), expected, 0.1 * expected)
        << "n " << n << ", seed " << kSeed;
    EXPECT_NEAR(sum / frames, 0, 0.1 * expected) << "n " << n << ", seed " << kSeed;
  }
}

TEST(Regression, OnlineOverAllFramesEndsWhereOfflineDoes) {
  constexpr std::uint32_t kSeed = 5;
  boost::random::mt19937 random(kSeed);
  boost::random::exponential_distribution<double> excess_ns(1e-6);
  std::vector<DeviceSample> samples = line(480, 20'000, 200, 0);
  for (DeviceSample& sample : samples) {
    sample.arrival += Nanoseconds(std::llround(excess_ns(random)));
  }
  EXPECT_EQ(online(samples, 480).back(), offline(samples).back()) << "seed " << kSeed;
  EXPECT_EQ(online(samples, 10'000).back(), offline(samples).back()) << "seed " << kSeed;
}

TEST(Regression, StaysFiniteOnAnything) {
  constexpr std::int64_t kLow = std::numeric_limits<std::int64_t>::min() / 1000;
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  const std::vector<DeviceSample> samples = {sample_at(kLow, kHigh), sample_at(0, -kHigh),
                                             sample_at(-kLow, kHigh), sample_at(kLow, -kHigh),
                                             sample_at(1, 0)};
  // Under UBSan: nothing overflows.
  EXPECT_EQ(counts_of(online(samples)).front(), kHigh);
  EXPECT_EQ(offline(samples).size(), samples.size());
}

TEST(OfflineRegressionDeathTest, StampBeforeLearnIsABug) {
  const auto estimator = make_offline_regression();
  EXPECT_DEATH(estimator->stamp({}), "learns the recording first");
}

}  // namespace
}  // namespace simbench

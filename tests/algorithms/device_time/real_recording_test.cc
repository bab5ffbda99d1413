// The estimators on 198 s of a real camera with a drift of -215 ppm (tests/data/README.md): the
// check values that come with it, and how far the estimators agree among themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/offset_filters.h"
#include "algorithms/device_time/unwrap.h"
#include "algorithms/device_time/yoon2021.h"
#include "tests/algorithms/device_time/streams.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

constexpr std::int64_t kOffsetsPerSecond = 3072 * 8000;

// "2020-08-19T12:42:57.7903616-04:00 2330554981": the host's local time, the 128 s cycle clock.
std::vector<DeviceSample> read(const std::string& path) {
  std::ifstream file(path);
  std::string time;
  std::uint32_t reading = 0;
  CounterUnwrapper<128 * kOffsetsPerSecond> unwrapper;
  std::vector<DeviceSample> samples;
  while (file >> time >> reading) {
    const std::int64_t seconds = std::stoll(time.substr(11, 2)) * 3600 +
                                 std::stoll(time.substr(14, 2)) * 60 +
                                 std::stoll(time.substr(17, 2));
    const std::int64_t arrival_ns = seconds * 1'000'000'000 + std::stoll(time.substr(20, 7)) * 100;
    const std::int64_t offsets = unwrapper.unwrap(
        (reading >> 25) * kOffsetsPerSecond + (reading >> 12 & 0x1fff) * 3072 + (reading & 0xfff));
    const double sensor_us = 1e6 * static_cast<double>(offsets) / kOffsetsPerSecond;
    samples.push_back(sample_at(std::llround(sensor_us), arrival_ns));
  }
  return samples;
}

class RealRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    samples_ = read(test_data_path("ibl/_iblrig_bodyCamera.timestamps.ssv"));
    ASSERT_EQ(samples_.size(), 6001U);
  }

  // The skew of the host's clock against the camera's, by the first and the last stamp.
  double skew_ppm(const std::vector<GlobalTime>& stamps) const {
    const double host_ns =
        static_cast<double>(nanoseconds_of(stamps.back()) - nanoseconds_of(stamps.front()));
    const double device_ns = static_cast<double>(nanoseconds_of(samples_.back().sensor) -
                                                 nanoseconds_of(samples_.front().sensor));
    return 1e6 * (host_ns / device_ns - 1);
  }

  std::vector<DeviceSample> samples_;
};

TEST_F(RealRecording, OfflineSlopesAreTheCheckValues) {
  const double least_squares = skew_ppm(stamps(*make_offline_regression(), samples_));
  const double hull = skew_ppm(stamps(*make_offline_hull(), samples_));
  EXPECT_NEAR(least_squares, -215.385, 0.02);
  EXPECT_NEAR(hull, -214.932, 0.5);
  EXPECT_LT(std::abs(least_squares - hull), 1);
}

TEST_F(RealRecording, OnlineEstimatorsFollowTheLowerEnvelope) {
  const std::vector<GlobalTime> offline = stamps(*make_offline_hull(), samples_);
  for (const auto& make :
       {+[] { return make_window_hull({}); }, +[] { return make_switching_hull({}); },
        +[] { return make_sliding_minimum({}); }}) {
    const std::vector<GlobalTime> online = stamps(*make(), samples_);
    for (std::size_t i = 600; i < online.size(); ++i) {
      // Half of the arrivals exceed the envelope by 0.16 ms, one in 20 by 0.6 ms.
      ASSERT_NEAR(1e-3 * error_ns(online[i], nanoseconds_of(offline[i])), 0, 250) << i;
      ASSERT_LE(online[i].time_since_epoch(),
                samples_[i].arrival.time_since_epoch() + Nanoseconds(1));
    }
  }
}

}  // namespace
}  // namespace simbench

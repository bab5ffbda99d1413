// The regressions against least squares in long double by QR, over hours.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

constexpr std::uint32_t kNoiseSeed = 2021;

// A device 200 ppm off, its stamps rounded to 1 us, arrivals 28 ms later with exponential excess.
std::vector<DeviceSample> hours(double length_h, double rate_hz) {
  boost::random::mt19937 random(kNoiseSeed);
  boost::random::exponential_distribution<double> excess_ns(1 / 0.3e6);
  std::vector<DeviceSample> samples;
  const auto frames = static_cast<std::int64_t>(length_h * 3600 * rate_hz);
  for (std::int64_t i = 0; i < frames; ++i) {
    const auto true_ns = static_cast<std::int64_t>(1e9 / rate_hz) * i;
    const std::int64_t device_us = kDeviceZeroUs + (true_ns + true_ns / 5000 + 500) / 1000;
    samples.push_back(
        sample_at(device_us, kHostZeroNs + true_ns + 28'000'000 + std::llround(excess_ns(random))));
  }
  return samples;
}

// The stamp of window.back() in ns after kHostZeroNs, by QR of the centred window.
long double reference_ns(std::span<const DeviceSample> window) {
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const auto n = static_cast<Eigen::Index>(window.size());
  Eigen::Matrix<long double, Eigen::Dynamic, 2> design(n, 2);
  Vector y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const DeviceSample& sample = window[static_cast<std::size_t>(i)];
    design(i, 0) = 1;
    design(i, 1) = static_cast<long double>(nanoseconds_of(sample.sensor) -
                                            nanoseconds_of(window.front().sensor));
    y(i) = static_cast<long double>(nanoseconds_of(sample.arrival) - kHostZeroNs);
  }
  const long double mean = design.col(1).mean();
  design.col(1).array() -= mean;
  const Vector solution = design.householderQr().solve(y);
  return solution(0) + solution(1) * design(n - 1, 1);
}

TEST(RegressionPrecision, WindowAgreesWithTheReferenceForHours) {
  const std::vector<DeviceSample> samples = hours(3, 15);
  const auto estimator = make_regression(RegressionWindow{30});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const GlobalTime stamp = estimator->stamp(samples[i]);
    if (i % 997 != 0 && i + 100 < samples.size()) continue;
    const std::size_t first = i < 29 ? 0 : i - 29;
    const long double expected =
        i == 0 ? static_cast<long double>(nanoseconds_of(samples[0].arrival) - kHostZeroNs)
               : reference_ns(std::span(samples).subspan(first, i + 1 - first));
    ASSERT_NEAR(error_ns(stamp, kHostZeroNs), static_cast<double>(expected), 1)
        << "frame " << i << ", seed " << kNoiseSeed;
  }
}

TEST(RegressionPrecision, OfflineAgreesWithTheReferenceOverHours) {
  const std::vector<DeviceSample> samples = hours(3, 15);
  const std::vector<GlobalTime> estimates = stamps(*make_offline_regression(), samples);
  EXPECT_NEAR(error_ns(estimates.back(), kHostZeroNs), static_cast<double>(reference_ns(samples)),
              1)
      << "seed " << kNoiseSeed;
  // The slope: -200 ppm to a part in 1e8, from the first and the last stamp.
  const double host_s = error_ns(estimates.back(), nanoseconds_of(estimates.front())) * 1e-9;
  const double device_s =
      std::chrono::duration<double>(samples.back().sensor - samples.front().sensor).count();
  EXPECT_NEAR(host_s / device_s, 1 / 1.0002, 1e-8);
}

}  // namespace
}  // namespace simbench

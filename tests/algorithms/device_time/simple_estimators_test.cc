// Passive synchronisation, sliding minimum, Theil-Sen, Kalman, expanding regression.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "algorithms/device_time/offset_filters.h"
#include "algorithms/device_time/yoon2021.h"
#include "bench/device_time_worlds.h"
#include "laws/median.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

// Stamps less the undelayed arrivals, in us.
std::vector<double> errors_us(DeviceTimeEstimator& estimator,
                              const std::vector<DeviceSample>& samples,
                              const std::vector<DeviceSample>& truth) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    errors.push_back(1e-3 *
                     error_ns(estimator.stamp(samples[i]), nanoseconds_of(truth[i].arrival)));
  }
  return errors;
}

TEST(Olson, FollowsADropAtOnceAndARiseAtAlpha) {
  const std::vector<DeviceSample> truth = line(300, 20'000, 0, 0);
  std::vector<DeviceSample> samples = truth;
  for (std::size_t i = 100; i < 300; ++i) samples[i].arrival += from_ms(1);
  samples[200].arrival -= from_ms(1);
  const auto estimator = make_olson({.alpha_ppm = 50});
  const std::vector<double> errors = errors_us(*estimator, samples, truth);
  // 50 ppm of 20 ms is 1 us a frame.
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(errors[i], 0) << i;
  for (std::size_t i = 100; i < 200; ++i) EXPECT_NEAR(errors[i], static_cast<double>(i - 99), 1e-3);
  for (std::size_t i = 200; i < 300; ++i)
    EXPECT_NEAR(errors[i], static_cast<double>(i - 200), 1e-3);
}

TEST(Olson, AnAlphaBelowTheSkewCannotFollow) {
  // The offset grows by 100 ppm, the estimate by 50: 1 us a frame is lost.
  const std::vector<DeviceSample> samples = line(300, 20'000, 100, 0);
  const auto estimator = make_olson({.alpha_ppm = 50});
  EXPECT_NEAR(errors_us(*estimator, samples, samples).back(), -299, 1e-3);
}

TEST(SlidingMinimum, IsTheLeastOffsetOfTheLastSecond) {
  const std::vector<DeviceSample> truth = line(500, 20'000, 0, 0);
  std::vector<DeviceSample> samples = truth;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].arrival += Microseconds((i * 7919) % 1000);
  }
  const auto estimator = make_sliding_minimum({.window_s = 1});
  const std::vector<double> errors = errors_us(*estimator, samples, truth);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::size_t least = 1000;
    for (std::size_t j = i < 49 ? 0 : i - 49; j <= i; ++j) least = std::min(least, j * 7919 % 1000);
    EXPECT_DOUBLE_EQ(errors[i], static_cast<double>(least)) << i;
  }
}

TEST(SlidingMinimum, QueueIsBounded) {
  // Offsets that increase for longer than the queue, 20,000 frames within the window.
  std::vector<DeviceSample> samples;
  for (std::int64_t i = 0; i < 40'000; ++i) {
    samples.push_back(sample_at(kDeviceZeroUs + 50 * i, kHostZeroNs + 50'000 * i + i));
  }
  const auto estimator = make_sliding_minimum({.window_s = 1});
  std::int64_t newest = 0;
  for (const DeviceSample& sample : samples) newest = nanoseconds_of(estimator->stamp(sample));
  // The least of the window is that of frame 20,000 in truth, here that of one within the window.
  const std::int64_t offset_ns = newest - kHostZeroNs - 50'000 * 39'999;
  EXPECT_GE(offset_ns, 20'000);
  EXPECT_LE(offset_ns, 39'999);
}

TEST(TheilSen, RecoversALineAndIgnoresAQuarterOfOutliers) {
  const std::vector<DeviceSample> truth = line(1000, 20'000, 200, 28'000'000);
  std::vector<DeviceSample> samples = truth;
  const auto clean = make_theil_sen({.frames = 300});
  for (const double error : errors_us(*clean, samples, truth)) EXPECT_NEAR(error, 0, 1e-3);
  for (std::size_t i = 0; i < samples.size(); i += 4) samples[i].arrival += from_ms(15);
  const auto estimator = make_theil_sen({.frames = 300});
  const std::vector<double> errors = errors_us(*estimator, samples, truth);
  for (std::size_t i = 10; i < errors.size(); ++i) EXPECT_NEAR(errors[i], 0, 1e-3) << i;
}

TEST(TheilSen, IsTheMedianOfSlopesAndResiduals) {
  // Offsets 0, 1, 5 us at 0, 1, 2 s: slopes 1, 4, 2.5 ppm, residuals 0, -1.5, 0.
  std::vector<DeviceSample> samples = line(3, 1'000'000, 0, 0);
  const std::vector<DeviceSample> truth = samples;
  samples[1].arrival += Microseconds(1);
  samples[2].arrival += Microseconds(5);
  const auto estimator = make_theil_sen({.frames = 300});
  EXPECT_NEAR(errors_us(*estimator, samples, truth).back(), 5, 1e-3);
}

// The definition: all slopes and residuals of a window, anew for each refit.
class PlainTheilSen {
 public:
  explicit PlainTheilSen(std::size_t frames) : frames_(frames) {}

  // The offset, in ns, at sensor time x_us.
  double offset(double x_us, double y_ns) {
    points_.emplace_back(x_us, y_ns);
    if (points_.size() > frames_) points_.erase(points_.begin());
    if (points_.size() == 1 || ++since_refit_ >= points_.size() / 20) refit();
    return level_ + slope_ * (x_us - origin_);
  }

 private:
  void refit() {
    since_refit_ = 0;
    origin_ = points_.back().first;
    std::vector<double> slopes;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        slopes.push_back((points_[i].second - points_[j].second) /
                         (points_[i].first - points_[j].first));
      }
    }
    slope_ = slopes.empty() ? 0 : median_in_place(slopes);
    std::vector<double> levels;
    for (const auto& [x, y] : points_) levels.push_back(y - slope_ * (x - origin_));
    level_ = median_in_place(levels);
  }

  std::size_t frames_;
  std::size_t since_refit_ = 0;
  std::vector<std::pair<double, double>> points_;
  double origin_ = 0;
  double slope_ = 0;
  double level_ = 0;
};

TEST(TheilSen, IsThatOfItsDefinitionToTheLastBit) {
  for (const std::uint32_t levels : {1U, 3U, 1'000'000U}) {  // the first two: many equal slopes
    for (const std::size_t frames : {1U, 2U, 45U, 90U}) {
      std::mt19937_64 random(levels + frames);
      const auto estimator = make_theil_sen({.frames = frames});
      PlainTheilSen plain(frames);
      std::int64_t first_ns = 0;
      for (std::int64_t i = 0; i < 600; ++i) {
        const std::int64_t x_us = 20'000 * i;
        const std::int64_t drift_ns = i > 300 ? 100 * i * i : 20 * i;
        const auto y_ns = drift_ns + static_cast<std::int64_t>(random() % levels);
        const DeviceSample sample =
            sample_at(kDeviceZeroUs + x_us, kHostZeroNs + 1000 * x_us + y_ns);
        if (i == 0) first_ns = y_ns;
        const double offset =
            plain.offset(static_cast<double>(x_us), static_cast<double>(y_ns - first_ns));
        EXPECT_EQ(nanoseconds_of(estimator->stamp(sample)),
                  kHostZeroNs + 1000 * x_us + first_ns + std::llrint(offset))
            << levels << " " << frames << " " << i;
      }
    }
  }
}

TEST(Kalman, ConvergesOnALine) {
  const std::vector<DeviceSample> samples = line(3000, 20'000, 200, 28'000'000);
  const auto estimator = make_kalman({});
  const std::vector<double> errors = errors_us(*estimator, samples, samples);
  for (std::size_t i = 500; i < errors.size(); ++i) EXPECT_NEAR(errors[i], 0, 1) << i;
}

TEST(Kalman, RejectsOutliers) {
  const std::vector<DeviceSample> truth = line(3000, 20'000, 0, 0);
  std::vector<DeviceSample> samples = truth;
  for (std::size_t i = 500; i < samples.size(); i += 20) samples[i].arrival += from_ms(15);
  const auto estimator = make_kalman({});
  for (const double error : errors_us(*estimator, samples, truth)) EXPECT_NEAR(error, 0, 1e-3);
}

// The divergence trap: a gated filter whose first frame is 23.88 ms late rejects all others. World
// C.
class KalmanTrap : public ::testing::Test {
 protected:
  KalmanTrap() {
    DeviceTimeWorld world;
    world.length_s = 120;
    world.drop_probability = 0.02;
    run_ = make_device_time_run(world, 1);
    run_.frames[0].arrival = HostTime(Nanoseconds(run_.undelayed_ns[0])) + from_ms(23.88);
  }

  double worst_us(const KalmanSettings& settings, double skip_s) {
    const auto estimator = make_kalman(settings);
    return device_time_errors(run_, device_time_stamps(*estimator, run_), skip_s).worst_us;
  }

  DeviceTimeRun run_;
};

TEST_F(KalmanTrap, LockOutRuleLeadsOut) {
  EXPECT_LT(worst_us({}, 5), 800);
  EXPECT_LT(worst_us({.rejections_to_restart = 50}, 5), 800);
}

TEST_F(KalmanTrap, WithoutTheRuleThereIsNoWayBack) {
  EXPECT_GT(worst_us({.rejections_to_restart = 1'000'000}, 60), 10'000);
}

TEST(ExpandingRegression, EndsWhereOfflineDoes) {
  DeviceTimeWorld world;
  world.length_s = 60;
  const DeviceTimeRun run = make_device_time_run(world, 4);
  const GlobalTime online = stamps(*make_expanding_regression(), run.frames).back();
  const GlobalTime offline = stamps(*make_offline_regression(), run.frames).back();
  EXPECT_NEAR(error_ns(online, nanoseconds_of(offline)), 0, 1);
}

TEST(ExpandingRegression, RecoversALineForHours) {
  const std::vector<DeviceSample> samples = line(72'000, 1'000'000, 200, 28'000'000);
  const auto estimator = make_expanding_regression();
  for (const double error : errors_us(*estimator, samples, samples)) ASSERT_NEAR(error, 0, 1e-3);
}

TEST(ExpandingRegression, EqualSensorStampsGiveTheMeanOffset) {
  const std::vector<DeviceSample> samples = {sample_at(5, 1000), sample_at(5, 3000),
                                             sample_at(5, 8000)};
  EXPECT_EQ(nanoseconds_of(stamps(*make_expanding_regression(), samples).back()), 4000);
}

}  // namespace
}  // namespace simbench

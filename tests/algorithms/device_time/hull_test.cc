#include "algorithms/device_time/hull.h"

#include <gtest/gtest.h>

#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/offset_stream.h"
#include "algorithms/device_time/unwrap.h"
#include "laws/lower_hull.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

struct Hull {
  std::string name;
  std::function<std::unique_ptr<DeviceTimeEstimator>()> make;
};

class EveryHull : public ::testing::TestWithParam<Hull> {};

INSTANTIATE_TEST_SUITE_P(Hulls, EveryHull,
                         ::testing::Values(Hull{"window", [] { return make_window_hull({}); }},
                                           Hull{"switching",
                                                [] { return make_switching_hull({}); }},
                                           Hull{"offline", [] { return make_offline_hull(); }}),
                         [](const auto& test) { return test.param.name; });

// Exponential excess of `mean_ms` on every arrival.
std::vector<DeviceSample> late(std::vector<DeviceSample> samples, double mean_ms,
                               std::uint32_t seed) {
  boost::random::mt19937 random(seed);
  boost::random::exponential_distribution<double> excess_ms(1 / mean_ms);
  for (DeviceSample& sample : samples) sample.arrival += from_ms(excess_ms(random));
  return samples;
}

TEST_P(EveryHull, RecoversALineToTheNanosecond) {
  for (const std::int64_t rate_ppm : {0, 50, -50, 200, -200, 1000}) {
    const std::vector<DeviceSample> samples = line(3000, 20'000, rate_ppm, 28'000'000);
    const auto estimator = GetParam().make();
    const std::vector<GlobalTime> all = stamps(*estimator, samples);
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_NEAR(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 0, 1)
          << rate_ppm << " ppm, frame " << i;
    }
  }
}

TEST_P(EveryHull, IsBelowTheArrivalsAndNearTheTruth) {
  constexpr std::uint32_t kSeed = 11;
  const std::vector<DeviceSample> truth = line(3000, 20'000, 50, 28'000'000);
  const std::vector<DeviceSample> samples = late(truth, 0.3, kSeed);
  const std::vector<GlobalTime> all = stamps(*GetParam().make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_LE(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 1) << i << ", seed " << kSeed;
    if (i < 600) continue;
    // A window of n errs by some b / n: 1 us of 300, so 40 us are never seen.
    ASSERT_NEAR(error_ns(all[i], nanoseconds_of(truth[i].arrival)), 0, 40e3)
        << i << ", seed " << kSeed;
  }
}

TEST_P(EveryHull, FirstFrameIsItsArrival) {
  const std::vector<DeviceSample> one = {sample_at(17, kHostZeroNs)};
  EXPECT_EQ(nanoseconds_of(stamps(*GetParam().make(), one)[0]), kHostZeroNs);
}

TEST_P(EveryHull, ReorderedFramesLieOnTheLineToo) {
  std::vector<DeviceSample> samples = line(400, 20'000, 50, 28'000'000);
  for (std::size_t i = 10; i + 1 < samples.size(); i += 10) std::swap(samples[i], samples[i + 1]);
  const std::vector<GlobalTime> all = stamps(*GetParam().make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 0, 1) << i;
  }
}

TEST_P(EveryHull, AWrapOfTheRegisterIsNoEvent) {
  std::vector<DeviceSample> samples = line(400, 20'000, 50, 28'000'000);
  DeviceStampUnwrapper unwrapper;
  const std::int64_t shift_us = (std::int64_t{1} << 32) - kDeviceZeroUs - 4'000'000;
  for (DeviceSample& sample : samples) {
    const std::int64_t register_us = sample.sensor.time_since_epoch().count() + shift_us;
    sample.sensor = unwrapper.unwrap({static_cast<std::uint32_t>(register_us)});
  }
  const std::vector<GlobalTime> all = stamps(*GetParam().make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 0, 1) << i;
  }
}

TEST_P(EveryHull, ARestartedCameraBeginsAnew) {
  // The camera's clock starts again from zero; the host's goes on.
  std::vector<DeviceSample> samples = line(600, 20'000, 50, 28'000'000);
  for (std::size_t i = 300; i < samples.size(); ++i)
    samples[i].sensor -= Microseconds(3'000'000'000);
  const std::vector<GlobalTime> all = stamps(*GetParam().make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 0, 1) << i;
  }
}

TEST_P(EveryHull, ALateFirstFrameDoesNotTurnTheLine) {
  // The first two frames give a slope of -1.2: no clock's. With the slope limited, the third is
  // stamped 20 us off at most (1000 ppm over a period) instead of 23.88 ms early.
  std::vector<DeviceSample> samples = line(300, 20'000, 0, 8'000'000);
  std::vector<std::int64_t> truth;
  truth.reserve(samples.size());
  for (const DeviceSample& sample : samples) truth.push_back(nanoseconds_of(sample.arrival));
  samples[0].arrival += from_ms(23.88);
  const std::vector<GlobalTime> all = stamps(*GetParam().make(), samples);
  for (std::size_t i = 1; i < all.size(); ++i)
    ASSERT_NEAR(error_ns(all[i], truth[i]), 0, 20e3) << i;
}

TEST_P(EveryHull, HoursCostNoPrecision) {
  // 20 h at 1 Hz and 200 ppm, so the offset grows to 14 s.
  std::vector<DeviceSample> samples = line(72'000, 1'000'000, 200, 28'000'000);
  const std::vector<GlobalTime> all = stamps(*GetParam().make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 0, 1) << i;
  }
}

TEST(WindowHullEstimator, AgreesWithARecomputedHull) {
  constexpr std::uint32_t kSeed = 21;
  const std::vector<DeviceSample> samples = late(line(1500, 20'000, 50, 0), 0.3, kSeed);
  const auto estimator = make_window_hull({.frames = 300});
  const SampleAnchor anchor(samples.front());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    LowerHull hull;
    for (std::size_t j = i < 299 ? 0 : i - 299; j <= i; ++j) hull.add(anchor.point(samples[j]));
    const LinePoint point = anchor.point(samples[i]);
    const GlobalTime expected =
        anchor.stamp(samples[i].sensor, middle_line(hull.vertices(), 1).at(point.x));
    ASSERT_EQ(estimator->stamp(samples[i]), expected) << i << ", seed " << kSeed;
  }
}

TEST(WindowHullEstimator, ForgetsAStepAfterItsWindow) {
  std::vector<DeviceSample> samples = line(1000, 20'000, 50, 0);
  for (std::size_t i = 500; i < samples.size(); ++i) samples[i].arrival += from_ms(0.5);
  const auto estimator = make_window_hull({.frames = 300});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error = error_ns(estimator->stamp(samples[i]), nanoseconds_of(samples[i].arrival));
    if (i < 500 || i >= 799) {
      ASSERT_NEAR(error, 0, 1) << i;
    }
    if (i == 550) {
      ASSERT_NEAR(error, -0.5e6, 1);
    }
  }
}

TEST(SwitchingHullEstimator, ForgetsAStepAfterTwoPeriods) {
  std::vector<DeviceSample> samples = line(3000, 20'000, 50, 0);
  for (std::size_t i = 600; i < samples.size(); ++i) samples[i].arrival += from_ms(0.5);
  const auto estimator = make_switching_hull({.period_s = 10});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error = error_ns(estimator->stamp(samples[i]), nanoseconds_of(samples[i].arrival));
    if (i < 600 || i >= 600 + 1000) {
      ASSERT_NEAR(error, 0, 1) << i;
    }
    if (i == 700) {
      ASSERT_NEAR(error, -0.5e6, 1);
    }
  }
}

TEST(SwitchingHullEstimator, AGapSwitchesAtOnce) {
  std::vector<DeviceSample> samples = line(1000, 20'000, 50, 0);
  for (std::size_t i = 500; i < samples.size(); ++i) {
    samples[i].sensor += Microseconds(3'600'000'000);
    samples[i].arrival += Nanoseconds(3'600'180'000'000);  // at 50 ppm
  }
  const std::vector<GlobalTime> all = stamps(*make_switching_hull({}), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(error_ns(all[i], nanoseconds_of(samples[i].arrival)), 0, 1) << i;
  }
}

TEST(OfflineHull, TakesTheEdgeOverTheMeanStamp) {
  // Offset 0 until 4 s, then a rise of 1 us a second: two edges that meet at 4 s. The middle of the
  // recording, 5 s, lies under the second; the mean stamp, 4.14 s, too, until one frame is moved.
  std::vector<DeviceSample> samples;
  for (const std::int64_t s : {0, 1, 2, 3, 4, 9, 10}) {
    samples.push_back(sample_at(kDeviceZeroUs + s * 1'000'000,
                                kHostZeroNs + s * 1'000'000'000 + (s > 4 ? (s - 4) * 1000 : 0)));
  }
  const std::vector<GlobalTime> all = stamps(*make_offline_hull(), samples);
  EXPECT_NEAR(error_ns(all.back(), kHostZeroNs + 10'000'000'000), 6000, 1);
  samples[5] = sample_at(kDeviceZeroUs + 4'500'000, kHostZeroNs + 4'500'000'500);
  const std::vector<GlobalTime> earlier = stamps(*make_offline_hull(), samples);
  EXPECT_NEAR(error_ns(earlier.back(), kHostZeroNs + 10'000'000'000), 0, 1);
}

TEST(OfflineHullDeathTest, StampBeforeLearnIsABug) {
  const auto estimator = make_offline_hull();
  EXPECT_DEATH(estimator->stamp({}), "learns the recording first");
}

}  // namespace
}  // namespace simbench

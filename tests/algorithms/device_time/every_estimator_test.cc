// Degenerate streams through every registered device_time estimator and its variants: always a
// number, the same each time, and from the estimators that learn the clocks a sensible one.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "tests/algorithms/device_time/polls.h"
#include "tests/algorithms/device_time/registered.h"
#include "tests/algorithms/device_time/streams.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

constexpr std::int64_t kHourUs = 3'600'000'000;

class EveryEstimator : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<DeviceTimeEstimator> make() const { return make_registered(GetParam()); }

  // The paper's estimators have no rule against clocks that are set; RocSync's and a coded
  // trigger's use no host's.
  bool knows_steps() const {
    const std::string& family =
        find_algorithm<DeviceTimeEntry>(parse_device_time_name(GetParam()).base)->info.family;
    return family != "regression" && family != "eq1" && family != "raw_arrival" &&
           family != "sensor_normalised" && family != "rocsync_led" && family != "coded_trigger";
  }
};

INSTANTIATE_TEST_SUITE_P(Registered, EveryEstimator, ::testing::ValuesIn(registered_estimators()),
                         [](const auto& test) { return test.param; });

// Stamps, with an adjustment before the first frame and a poll of the same clocks before each.
std::vector<std::int64_t> stamped(DeviceTimeEstimator& estimator,
                                  const std::vector<DeviceSample>& samples) {
  if (estimator.offline()) estimator.learn(samples);
  estimator.on_adjustment({.host = 0,
                           .at = SteadyTime(Nanoseconds(0)),
                           .before = HostTime(Nanoseconds(0)),
                           .after = HostTime(Nanoseconds(0)),
                           .rate_ppb = 0});
  std::vector<std::int64_t> all;
  for (const DeviceSample& sample : samples) {
    PollSample poll;
    poll.device = sample.sensor;
    poll.t1 = sample.arrival;
    poll.t1_steady = sample.arrival_steady;
    const bool has_room = nanoseconds_of(sample.arrival) > 0;
    poll.t0 = has_room ? sample.arrival - Nanoseconds(400'000) : sample.arrival;
    poll.t0_steady =
        has_room ? sample.arrival_steady - Nanoseconds(400'000) : sample.arrival_steady;
    estimator.on_poll(poll);
    all.push_back(nanoseconds_of(estimator.stamp(sample)));
  }
  return all;
}

std::vector<DeviceSample> without_exposure(std::vector<DeviceSample> samples) {
  for (DeviceSample& sample : samples) sample.exposure_us = 0;
  return samples;
}

double seconds_from_arrival(std::int64_t stamp_ns, const DeviceSample& sample) {
  return 1e-9 *
         (static_cast<double>(stamp_ns) - static_cast<double>(nanoseconds_of(sample.arrival)));
}

TEST_P(EveryEstimator, OneFrame) {
  const auto estimator = make();
  const auto samples = without_exposure({sample_at(kDeviceZeroUs, kHostZeroNs)});
  const std::int64_t stamp = stamped(*estimator, samples)[0];
  EXPECT_NEAR(seconds_from_arrival(estimator->relative() ? stamp + kHostZeroNs : stamp, samples[0]),
              0, 0.001);
}

TEST_P(EveryEstimator, IdenticalStamps) {
  if (make()->relative()) return;
  std::vector<DeviceSample> samples(400, sample_at(kDeviceZeroUs, kHostZeroNs));
  samples = without_exposure(samples);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].arrival += Microseconds(i % 7);
  const std::vector<std::int64_t> all = stamped(*make(), samples);
  const double bound_s = GetParam().starts_with("eq1_printed") ? 2 : 0.001;
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(seconds_from_arrival(all[i], samples[i]), 0, bound_s) << i;
  }
}

TEST_P(EveryEstimator, DecreasingStamps) {
  if (!knows_steps()) return;
  // Both run backwards by a period a frame, or the camera's alone does: late frames, until one is a
  // second late and the clocks begin anew.
  for (const std::int64_t arrival_sign : {-1, 1}) {
    std::vector<DeviceSample> samples;
    for (std::int64_t i = 0; i < 400; ++i) {
      samples.push_back(
          sample_at(kDeviceZeroUs - 20'000 * i, kHostZeroNs + arrival_sign * 20'000'000 * i));
    }
    samples = without_exposure(samples);
    const std::vector<std::int64_t> all = stamped(*make(), samples);
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_NEAR(seconds_from_arrival(all[i], samples[i]), 0, 1.01) << arrival_sign << ", " << i;
    }
  }
}

TEST_P(EveryEstimator, GapsOfHours) {
  if (!knows_steps()) return;
  std::vector<DeviceSample> samples = without_exposure(line(900, 20'000, 50, 28'000'000));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto gaps = static_cast<std::int64_t>(i / 300);
    samples[i].sensor += Microseconds(7 * kHourUs * gaps);
    samples[i].arrival += Nanoseconds(7 * kHourUs * gaps * 1000 + 7 * kHourUs * gaps / 20);
    samples[i].arrival_steady = SteadyTime(samples[i].arrival.time_since_epoch());
  }
  const std::vector<std::int64_t> all = stamped(*make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    // The offset grows by 1.26 s in a gap; half of a poll's round trip is left.
    ASSERT_NEAR(seconds_from_arrival(all[i], samples[i]), 0, 0.001) << i;
  }
}

TEST_P(EveryEstimator, ClocksThatAreSet) {
  if (!knows_steps()) return;
  std::vector<DeviceSample> samples = without_exposure(line(1200, 20'000, 50, 28'000'000));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // The host is set by an hour forth and by two back, then the camera starts from zero.
    const std::int64_t host_us = i < 300 ? 0 : i < 600 ? kHourUs : -kHourUs;
    samples[i].arrival += Microseconds(host_us);
    samples[i].arrival_steady = SteadyTime(samples[i].arrival.time_since_epoch());
    if (i >= 900) samples[i].sensor -= Microseconds(kDeviceZeroUs);
  }
  const std::vector<std::int64_t> all = stamped(*make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(seconds_from_arrival(all[i], samples[i]), 0, 0.001) << i;
  }
}

TEST_P(EveryEstimator, AnythingAtAll) {
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    boost::random::mt19937 random(seed);
    boost::random::uniform_int_distribution<int> kind(0, 5);
    boost::random::uniform_int_distribution<std::int64_t> any(-kHigh, kHigh);
    boost::random::uniform_int_distribution<std::int64_t> near(-100'000, 100'000);
    std::vector<DeviceSample> samples;
    DeviceSample sample = sample_at(kDeviceZeroUs, kHostZeroNs);
    for (int i = 0; i < 700; ++i) {
      switch (kind(random)) {
        case 0:
          sample = sample_at(any(random) / 1000, any(random));
          break;
        case 1:
          sample.arrival = HostTime(Nanoseconds(any(random)));
          break;
        case 2:
          sample.sensor = DeviceTime(Microseconds(any(random) / 1000));
          break;
        default:
          sample = sample_at(sample.sensor.time_since_epoch().count() / 2 + near(random),
                             nanoseconds_of(sample.arrival) / 2 + near(random));
      }
      sample.exposure_us = static_cast<std::uint32_t>(near(random));
      samples.push_back(sample);
    }
    // Under UBSan: nothing overflows, and nothing is undefined.
    const std::vector<std::int64_t> all = stamped(*make(), samples);
    ASSERT_EQ(all, stamped(*make(), samples)) << "seed " << seed;
  }
}

// Windows' coarse tick, and a delivery that stands for 0.4 s.
TEST_P(EveryEstimator, CoarseAndStandingArrivals) {
  if (GetParam().starts_with("eq1_printed") || make()->relative()) return;
  std::vector<DeviceSample> samples = without_exposure(line(1000, 20'000, 50, 28'000'000));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::int64_t ns = nanoseconds_of(samples[i].arrival);
    const std::int64_t standing = i < 600 || i >= 620 ? ns : nanoseconds_of(samples[599].arrival);
    samples[i].arrival = HostTime(Nanoseconds(standing - standing % 15'600'000));
    samples[i].arrival_steady = SteadyTime(samples[i].arrival.time_since_epoch());
  }
  const std::vector<std::int64_t> all = stamped(*make(), samples);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_NEAR(seconds_from_arrival(all[i], samples[i]), 0, 0.45) << i;
  }
}

TEST(DeviceTimeRegistry, PollEstimatorsSaySo) {
  for (const DeviceTimeEntry& entry : nonempty(algorithms<DeviceTimeEntry>())) {
    const bool polls =
        entry.info.name == "two_way_poll" || entry.info.name == "librealsense_global";
    EXPECT_EQ(std::count(entry.info.needs.begin(), entry.info.needs.end(), Need::kPolls), polls)
        << entry.info.name;
  }
}

TEST(DeviceTimeRegistry, OnlyPollsAreOfUseDuringTheWarmUp) {
  for (const DeviceTimeEntry& entry : nonempty(algorithms<DeviceTimeEntry>())) {
    if (!entry.make || entry.info.source == "test") continue;
    const auto estimator = entry.make(check_parameters(entry.info.parameters, {}));
    const bool polls = std::ranges::count(entry.info.needs, Need::kPolls) > 0;
    EXPECT_EQ(estimator->from_first_frame(), polls) << entry.info.name;
  }
}

TEST(DeviceTimeRegistry, ParametersReachTheirEstimators) {
  // Olson's alpha: 1000 ppm leak 20 us in a frame of 20 ms.
  const DeviceTimeEntry* olson = find_algorithm<DeviceTimeEntry>("olson_50ppm");
  const auto estimator =
      olson->make(check_parameters(olson->info.parameters, {{"alpha_ppm", 1000.0}}));
  const auto samples = line(3, 20'000, 1000, 0);
  EXPECT_EQ(nanoseconds_of(stamps(*estimator, samples)[2]), nanoseconds_of(samples[2].arrival));
  EXPECT_THROW(check_parameters(olson->info.parameters, {{"alpha_ppm", -1.0}}), ParameterError);
  const DeviceTimeEntry* kalman = find_algorithm<DeviceTimeEntry>("kalman");
  EXPECT_THROW(check_parameters(kalman->info.parameters, {{"gate", 0.0}}), ParameterError);
}

}  // namespace
}  // namespace simbench

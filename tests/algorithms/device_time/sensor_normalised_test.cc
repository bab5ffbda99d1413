#include <gtest/gtest.h>

#include "algorithms/device_time/yoon2021.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

TEST(SensorNormalised, CountsFromTheFirstSensorStamp) {
  const auto estimator = make_sensor_normalised();
  EXPECT_TRUE(estimator->relative());
  EXPECT_EQ(estimator->stamp(sample_at(kDeviceZeroUs, 1)), GlobalTime{});
  EXPECT_EQ(estimator->stamp(sample_at(kDeviceZeroUs + 22'222, 99)),
            GlobalTime(Microseconds(22'222)));
  EXPECT_EQ(estimator->stamp(sample_at(kDeviceZeroUs - 3, 5)), GlobalTime(Microseconds(-3)));
}

TEST(RawArrival, IsTheArrivalOnTheSystemClock) {
  DeviceSample sample = sample_at(kDeviceZeroUs, kHostZeroNs);
  sample.arrival_steady += from_ms(1000);
  const auto estimator = make_raw_arrival();
  EXPECT_FALSE(estimator->relative());
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample)), kHostZeroNs);
}

}  // namespace
}  // namespace simbench

// Samples counted from a first one: what is fitted is the offset arrival - sensor over the sensor
// stamp, in small exact integers, so that hours and dates cost no precision.
//
//   SampleAnchor anchor(first);
//   LinePoint p = anchor.point(sample);              // us, ns
//   GlobalTime t = anchor.stamp(sample.sensor, offset_ns);
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_SAMPLE_ANCHOR_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_SAMPLE_ANCHOR_H_

#include <cstdint>

#include "algorithms/device_time/device_time.h"
#include "algorithms/device_time/line_fit.h"
#include "algorithms/device_time/saturate.h"

namespace simbench {

class SampleAnchor {
 public:
  explicit SampleAnchor(const DeviceSample& first)
      : sensor_us_(first.sensor.time_since_epoch().count()),
        arrival_ns_(nanoseconds_of(first.arrival)) {}

  // x: sensor stamp in us; y: offset of arrival to sensor in ns; both from the first sample's.
  LinePoint point(const DeviceSample& sample) const {
    const Int128 x = elapsed_us(sample.sensor);
    const Int128 y = Int128{nanoseconds_of(sample.arrival)} - arrival_ns_ - 1000 * x;
    return {saturate(x), saturate(y)};
  }

  std::int64_t x(DeviceTime sensor) const { return saturate(elapsed_us(sensor)); }

  // The host's reading at sensor stamp `sensor` when the offset is `offset_ns`.
  GlobalTime stamp(DeviceTime sensor, double offset_ns) const {
    return GlobalTime(
        Nanoseconds(saturate(arrival_ns_ + 1000 * elapsed_us(sensor) + saturate_round(offset_ns))));
  }

 private:
  Int128 elapsed_us(DeviceTime sensor) const {
    return Int128{sensor.time_since_epoch().count()} - sensor_us_;
  }

  std::int64_t sensor_us_;
  std::int64_t arrival_ns_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_SAMPLE_ANCHOR_H_

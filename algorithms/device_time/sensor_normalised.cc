#include "algorithms/device_time/sensor_normalised.h"

#include <optional>

#include "algorithms/device_time/saturate.h"

namespace simbench {
namespace {

class SensorNormalised final : public DeviceTimeEstimator {
 public:
  bool relative() const override { return true; }

  GlobalTime stamp(const DeviceSample& sample) override {
    const std::int64_t sensor_us = sample.sensor.time_since_epoch().count();
    if (!first_us_) first_us_ = sensor_us;
    return GlobalTime(Nanoseconds(saturate(1000 * (Int128{sensor_us} - *first_us_))));
  }

 private:
  std::optional<std::int64_t> first_us_;
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_sensor_normalised() {
  return std::make_unique<SensorNormalised>();
}

}  // namespace simbench

#include "algorithms/device_time/raw_arrival.h"

namespace simbench {
namespace {

class RawArrival final : public DeviceTimeEstimator {
 public:
  GlobalTime stamp(const DeviceSample& sample) override {
    return GlobalTime(sample.arrival.time_since_epoch());
  }
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_raw_arrival() { return std::make_unique<RawArrival>(); }

}  // namespace simbench

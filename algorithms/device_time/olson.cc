#include "algorithms/device_time/olson.h"

#include "algorithms/device_time/lower_hull.h"
#include "algorithms/device_time/offset_stream.h"

namespace simbench {
namespace {

class Olson final : public DeviceTimeEstimator {
 public:
  explicit Olson(OlsonSettings settings)
      : leak_({.touches = {}, .slope = settings.alpha_ppm * 1e-3}) {}

  GlobalTime stamp(const DeviceSample& sample) override {
    const OffsetStream::Sample kind = stream_.push(sample);
    const LinePoint point = stream_.point();
    if (kind == OffsetStream::Sample::kFirst ||
        (kind == OffsetStream::Sample::kNext &&
         leak_.at(point.x) >= static_cast<double>(point.y))) {
      leak_.touches = point;
    }
    return stream_.stamp(leak_.at(point.x));
  }

 private:
  OffsetStream stream_;
  SupportLine leak_;  // from (p, q) on
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_olson(OlsonSettings settings) {
  return std::make_unique<Olson>(settings);
}

}  // namespace simbench

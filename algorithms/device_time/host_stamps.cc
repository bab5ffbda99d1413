#include "algorithms/device_time/host_stamps.h"

#include <cstdint>

#include "algorithms/registry.h"
#include "laws/saturate.h"

namespace simbench {
namespace {

class HostStamps final : public DeviceTimeEstimator {
 public:
  GlobalTime stamp(const DeviceSample& sample) override {
    const DeviceStamp reading{static_cast<std::uint32_t>(sample.sensor.time_since_epoch().count())};
    const Nanoseconds age = age_of(reading, sample.arrival_steady);
    return GlobalTime(Nanoseconds(saturate(Int128{nanoseconds_of(sample.arrival)} - age.count())));
  }
};

}  // namespace

std::unique_ptr<DeviceTimeEstimator> make_host_stamps() { return std::make_unique<HostStamps>(); }

std::vector<DeviceTimeEntry> device_time_host_stamps() {
  return {{.info = {.name = "host_stamps",
                    .family = "host_stamps",
                    .summary = "the camera's stamps are its host's own: nothing is estimated",
                    .source = "docs/reference/capture_alignment.md section 8 (Android Camera2)",
                    .needs = {Need::kHostStamps}},
           .make = [](const Parameters&) { return make_host_stamps(); }}};
}

}  // namespace simbench

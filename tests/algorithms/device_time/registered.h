// The registered device_time estimators of cameras with clocks of their own that can be made here,
// also with all variants.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "tests/algorithms/coded_trigger/coded_frames.h"

namespace simbench {

inline std::vector<std::string> registered_estimators() {
  std::vector<std::string> names;
  for (const DeviceTimeEntry& entry : algorithms<DeviceTimeEntry>()) {
    if (!entry.make || entry.info.source == "test") continue;
    if (entry.info.name == "host_stamps") continue;  // of cameras that stamp with their host's
    names.push_back(entry.info.name);
    names.push_back(entry.info.name + "_steady_calibrated");
  }
  return names;
}

// With the default parameters.
inline std::unique_ptr<DeviceTimeEstimator> make_registered(const std::string& full_name) {
  const DeviceTimeName name = parse_device_time_name(full_name);
  const DeviceTimeEntry* entry = find_algorithm<DeviceTimeEntry>(name.base);
  auto made = make_variant(name, entry->make(check_parameters(entry->info.parameters, {})), {});
  made->on_coded_pulses(pulses_of(short_code()));
  return made;
}

}  // namespace simbench

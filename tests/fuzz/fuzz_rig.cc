// The rig loader: any text is a rig or an InputError, nothing else.
#include <cstddef>
#include <cstdint>
#include <string>

#include "hardware/rig/rig.h"

namespace simbench {

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  static const scenarios::Scenario scenario = scenarios::load_scenario("6cam_2host_30fps");
  try {
    const hardware::Rig rig = hardware::load_rig_text(text, "rigs/fuzz.json");
    hardware::host_named(rig, rig.hosts.front().name);
    hardware::check_rig_fits(rig, scenario);
    hardware::check_rig_is_guarded(rig, false);
    hardware::host_named(rig, "no such host");
  } catch (const scenarios::InputError&) {
  }
  return 0;
}

}  // namespace simbench

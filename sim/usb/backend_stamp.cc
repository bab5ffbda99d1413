#include "sim/usb/backend_stamp.h"

namespace simbench::sim {

Nanoseconds through_float_ms(Nanoseconds since_boot) {
  constexpr std::int64_t kTickNs = 100;  // of Media Foundation
  const auto ticks = static_cast<float>(floor_div(since_boot.count(), kTickNs));
  return from_ms(static_cast<double>(ticks / 10000.0F));
}

BackendStamps::BackendStamps(const std::optional<scenarios::BackendStamp>& settings,
                             Granularity arrival_quantum)
    : is_converted_(settings.has_value()), resolution_(arrival_quantum) {
  if (!settings) return;
  uptime_ = from_seconds(settings->host_uptime_h * 3600);
  resolution_ = Granularity(from_ms(settings->resolution_ms));
}

HostTime BackendStamps::converted(SteadyTime capture_start,
                                  const SystemClock::Reading& delivered) const {
  const SteadyTime monotonic(delivered.steady - (capture_start - uptime_));
  const Nanoseconds since_boot = monotonic.time_since_epoch();
  const Nanoseconds kernel = uptime_.count() > 0 ? through_float_ms(since_boot) : since_boot;
  const Nanoseconds cut = resolution_.round_down(monotonic).time_since_epoch();
  return resolution_.round_down(resolution_.round_down(delivered.system) + (kernel - cut));
}

}  // namespace simbench::sim

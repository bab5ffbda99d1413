#include "scenarios/calibration.h"

#include <algorithm>
#include <cmath>

namespace simbench::scenarios {
namespace {

// As careful as a user's reading of it.
double rounded(double value_ms) { return std::round(value_ms * 100) / 100; }

// How many cameras of a host share a controller's bandwidth while they deliver this stream.
std::int64_t sharing_cameras(const Scenario& scenario, const Stream& stream) {
  if (scenario.usb.sharing == UsbSharing::kDedicated) return 1;
  if (!scenario.cameras.follows_trigger(stream)) return 1;
  const std::vector<std::size_t> counts = scenario.cameras_by_host();
  const auto most = static_cast<std::int64_t>(*std::max_element(counts.begin(), counts.end()));
  return std::min(scenario.usb.cameras_per_controller, most);
}

// The bytes that a controller carries from the offer of a frame to the end of its transfer, if all
// frames are offered at once: its share of each, or those before it.
double bytes_until(const Scenario& scenario, const Stream& stream) {
  const auto cameras = static_cast<double>(sharing_cameras(scenario, stream));
  const bool triggered = scenario.cameras.follows_trigger(stream);
  double of_a_camera = 0;
  double together = 0;
  double up_to_it = 0;
  for (const Stream& other : scenario.cameras.streams) {
    if (&other != &stream && !(triggered && scenario.cameras.follows_trigger(other))) continue;
    of_a_camera += other.image_bytes();
    together += std::min(other.image_bytes(), stream.image_bytes());
    if (&other <= &stream) up_to_it += other.image_bytes();
  }
  if (scenario.usb.sharing == UsbSharing::kFair) return cameras * together;
  return (cameras - 1) / 2 * of_a_camera + up_to_it;
}

double transfer_ms(const Scenario& scenario, double bytes) {
  return bytes * 1e-3 / scenario.usb.bandwidth_mb_per_s;
}

// How much sooner than with all others at once fair sharing delivers frames that are offered one
// after the other: twice as much as they come after the first on average, as long as they overlap.
double sooner_ms(const Scenario& scenario, const Stream& stream) {
  if (scenario.usb.sharing != UsbSharing::kFair) return 0;
  const auto cameras = static_cast<double>(sharing_cameras(scenario, stream));
  const double drawn_ms = scenario.cameras.latency_camera_max_ms * (0.5 - 1 / (cameras + 1));
  const double chained_ms = scenario.trigger.daisy_chain_delay_us * 1e-3 * (cameras - 1) / 2;
  return 2 * (drawn_ms + chained_ms);
}

// The level of the jitter that a host's cameras share (sim/usb/host_stack.h).
double common_jitter_ms(const Scenario& scenario, const Stream& stream) {
  const double correlation = scenario.usb.host_jitter_correlation;
  const double mean_ms =
      scenario.usb.host_jitter_transfers * transfer_ms(scenario, stream.image_bytes());
  return mean_ms * (1 - std::sqrt((1 - correlation) / (1 + correlation)));
}

}  // namespace

double calibrated_delay_ms(const Scenario& scenario, const Stream& stream) {
  if (stream.calibrated_delay_ms) return *stream.calibrated_delay_ms;
  const double readout_ms = stream.shutter == ShutterKind::kRolling ? stream.readout_ms : 0;
  const double offered_ms = stream.pipeline_latency_ms +
                            stream.latency_mode_periods * 1e3 / stream.mode_rate_hz +
                            scenario.cameras.latency_camera_max_ms / 2;
  const std::vector<double>& table_ms = scenario.usb.delivery_quantiles_ms;
  return rounded(
      readout_ms / 2 + offered_ms + transfer_ms(scenario, bytes_until(scenario, stream)) -
      sooner_ms(scenario, stream) + common_jitter_ms(scenario, stream) +
      (table_ms.empty() ? 0 : table_ms.front()) - scenario.hosts.clock.arrival_quantum_ms / 2);
}

double calibrated_asymmetry_ms(const ClockPoll& polls) {
  return polls.calibrated_asymmetry_ms.value_or(rounded(polls.request_ms - polls.reply_ms));
}

}  // namespace simbench::scenarios

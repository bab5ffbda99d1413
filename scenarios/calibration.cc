#include "scenarios/calibration.h"

#include <algorithm>
#include <cmath>

namespace simbench::scenarios {
namespace {

// As careful as a user's reading of it.
double rounded(double value_ms) { return std::round(value_ms * 100) / 100; }

// How many cameras of a host share a controller's bandwidth.
std::int64_t sharing_cameras(const Scenario& scenario) {
  if (scenario.usb.sharing == UsbSharing::kDedicated) return 1;
  const std::vector<std::size_t> counts = scenario.cameras_by_host();
  const auto most = static_cast<std::int64_t>(*std::max_element(counts.begin(), counts.end()));
  return std::min(scenario.usb.cameras_per_controller, most);
}

// From the offer to the end of the transfer, all frames of the controller being offered at once.
double transfer_ms(const Scenario& scenario, const Stream& stream) {
  const double ms_per_byte = 1e-3 / scenario.usb.bandwidth_mb_per_s;
  const auto cameras = static_cast<double>(sharing_cameras(scenario));
  double bytes = 0;
  for (const Stream& other : scenario.cameras.streams) {
    const double ahead = scenario.usb.sharing == UsbSharing::kFair
                             ? std::min(other.image_bytes(), stream.image_bytes())
                             : other.image_bytes();
    bytes += ahead;
  }
  const bool one_by_one = scenario.usb.sharing == UsbSharing::kFifo;
  return ms_per_byte * (one_by_one ? bytes * (cameras + 1) / 2 : bytes * cameras);
}

// How much sooner than with all others at once fair sharing delivers frames that are offered one
// after the other: twice as much as they come after the first on average, as long as they overlap.
double sooner_ms(const Scenario& scenario) {
  if (scenario.usb.sharing != UsbSharing::kFair) return 0;
  const auto cameras = static_cast<double>(sharing_cameras(scenario));
  const double drawn_ms = scenario.cameras.latency_camera_max_ms * (0.5 - 1 / (cameras + 1));
  const double chained_ms = scenario.trigger.daisy_chain_delay_us * 1e-3 * (cameras - 1) / 2;
  return 2 * (drawn_ms + chained_ms);
}

}  // namespace

double calibrated_delay_ms(const Scenario& scenario, const Stream& stream) {
  if (stream.calibrated_delay_ms) return *stream.calibrated_delay_ms;
  const double readout_ms = stream.shutter == ShutterKind::kRolling ? stream.readout_ms : 0;
  const double offered_ms = stream.pipeline_latency_ms +
                            stream.latency_mode_periods * 1e3 / stream.mode_rate_hz +
                            scenario.cameras.latency_camera_max_ms / 2;
  return rounded(readout_ms / 2 + offered_ms + transfer_ms(scenario, stream) - sooner_ms(scenario) -
                 scenario.hosts.clock.arrival_quantum_ms / 2);
}

double calibrated_asymmetry_ms(const ClockPoll& polls) {
  return polls.calibrated_asymmetry_ms.value_or(rounded(polls.request_ms - polls.reply_ms));
}

}  // namespace simbench::scenarios

#include "scenarios/calibration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "algorithms/ports/time.h"
#include "laws/generators.h"
#include "laws/usb_controller.h"

namespace simbench::scenarios {
namespace {

// Rounds as a careful user would read it.
double rounded(double value_ms) { return std::round(value_ms * 100) / 100; }

double latency_ms(const Stream& stream) {
  return stream.pipeline_latency_ms + stream.latency_mode_periods * 1e3 / stream.mode_rate_hz;
}

double readout_ms(const Stream& stream) {
  return stream.shutter == ShutterKind::kRolling ? stream.readout_ms : 0;
}

double transfer_ms(const Scenario& scenario, const Stream& stream) {
  return stream.image_bytes() * 1e-3 / scenario.usb.bandwidth_mb_per_s;
}

// U(0, 1), alike with every compiler.
class Uniform {
 public:
  double operator()() { return unit_share(generator_()); }

 private:
  std::mt19937_64 generator_;  // begins alike each time, too
};

// A frame on its way over a controller: offered, and transferred in so long if it is alone.
struct Offer {
  double at_ms = 0;
  double transfer_ms = 0;
  double hold_ms = 0;        // that it may take then; 0: any time
  bool is_measured = false;  // of the stream whose delay is asked for
  double delay_ms = 0;       // end of exposure to offer; then also to the end of the transfer
};

bool sooner(const Offer& a, const Offer& b) { return a.at_ms < b.at_ms; }

// Adds to each delay how long the transfer takes. Offers come in order of time; one that the bus
// does not take in time is not measured, and no buffer is full.
void transfer(std::vector<Offer>& offers, UsbSharing sharing) {
  UsbController controller({.bytes_per_ns = 1,
                            .buffered_frames = static_cast<std::uint32_t>(offers.size()),
                            .is_fair = sharing == UsbSharing::kFair},
                           1);
  const auto complete_before = [&](Nanoseconds limit) {
    while (controller.next_completion() < limit) {
      const Nanoseconds now = controller.next_completion();
      while (const auto done = controller.take_completed(now)) {
        offers[*done].delay_ms += to_ms(now) - offers[*done].at_ms;
      }
    }
  };
  for (std::uint32_t i = 0; i < offers.size(); ++i) {
    const Nanoseconds at = from_ms(offers[i].at_ms);
    complete_before(at);
    const Nanoseconds latest =
        offers[i].hold_ms > 0 ? at + from_ms(offers[i].hold_ms) : Nanoseconds::max();
    if (!controller.submit(at, 0, offers[i].transfer_ms * 1e6, i, latest)) {
      offers[i].is_measured = false;
    }
  }
  complete_before(Nanoseconds::max());
}

// How much later one camera's exposure ends than another's, from the same pulse.
double exposure_spread_ms(const Cameras& cameras, double period_ms, Uniform& uniform) {
  if (!cameras.begins_at_pulse()) return 0;  // exposures end together
  const AutoExposure& automatic = cameras.auto_exposure;
  const double part = uniform();
  return automatic.is_on() ? part * (automatic.max_ms - automatic.min_ms)
                           : part * cameras.exposure_camera_periods * period_ms;
}

// The frames of one pulse on a controller with so many cameras, in order of their offers.
std::vector<Offer> offers_of_pulse(const Scenario& scenario, const Stream& stream,
                                   std::int64_t sharers, Uniform& uniform) {
  const Cameras& cameras = scenario.cameras;
  const bool follows = cameras.follows_trigger(stream);
  std::vector<Offer> offers;
  for (std::int64_t camera = 0; camera < sharers; ++camera) {
    const double late_ms = uniform() * cameras.latency_camera_max_ms;
    const double exposed_ms =
        scenario.trigger.daisy_chain_delay_us * 1e-3 * static_cast<double>(camera) +
        uniform() * scenario.trigger.cable_delay_max_us * 1e-3 +
        exposure_spread_ms(cameras, scenario.trigger.period_ms(), uniform);
    for (const Stream& other : cameras.streams) {
      const bool is_measured = &other == &stream;
      if (!is_measured && !(follows && cameras.follows_trigger(other))) continue;
      if (uniform() < cameras.drop_probability) continue;
      const double rows_ms = cameras.begins_at_pulse() ? readout_ms(other) : 0;
      const double delay_ms = latency_ms(other) + late_ms;
      offers.push_back({.at_ms = exposed_ms + rows_ms + delay_ms,
                        .transfer_ms = transfer_ms(scenario, other),
                        .hold_ms = scenario.usb.hold_mode_periods * 1e3 / other.mode_rate_hz,
                        .is_measured = is_measured,
                        .delay_ms = delay_ms});
    }
  }
  std::stable_sort(offers.begin(), offers.end(), sooner);
  return offers;
}

// How many cameras of a host share a controller while they deliver this stream.
std::int64_t sharing_cameras(const Scenario& scenario, const Stream& stream) {
  if (scenario.usb.sharing == UsbSharing::kDedicated) return 1;
  if (!scenario.cameras.follows_trigger(stream)) return 1;
  const std::vector<std::size_t> counts = scenario.cameras_by_host();
  const auto most = static_cast<std::int64_t>(*std::max_element(counts.begin(), counts.end()));
  return std::min(scenario.usb.cameras_per_controller, most);
}

// Whether all pulses are alike.
bool is_regular(const Cameras& cameras, const Trigger& trigger) {
  return trigger.cable_delay_max_us == 0 && cameras.latency_camera_max_ms == 0 &&
         cameras.exposure_camera_periods == 0 && cameras.drop_probability == 0 &&
         !cameras.auto_exposure.is_on();
}

// From the end of the exposure to the end of the transfer, on average.
double mean_transferred_ms(const Scenario& scenario, const Stream& stream) {
  constexpr std::int64_t kFrames = 6000;
  const std::int64_t sharers = sharing_cameras(scenario, stream);
  const std::int64_t pulses = is_regular(scenario.cameras, scenario.trigger)
                                  ? 1
                                  : std::max<std::int64_t>(1, kFrames / sharers);
  Uniform uniform;
  double sum_ms = 0;
  double frames = 0;
  for (std::int64_t pulse = 0; pulse < pulses; ++pulse) {
    std::vector<Offer> offers = offers_of_pulse(scenario, stream, sharers, uniform);
    transfer(offers, scenario.usb.sharing);
    for (const Offer& offer : offers) {
      if (!offer.is_measured) continue;
      sum_ms += offer.delay_ms;
      ++frames;
    }
  }
  return frames > 0 ? sum_ms / frames : latency_ms(stream) + transfer_ms(scenario, stream);
}

// The level of the jitter that a host's cameras share (sim/usb/host_stack.h).
double common_jitter_ms(const Scenario& scenario, const Stream& stream) {
  const double correlation = scenario.usb.host_jitter_correlation;
  const double mean_ms = scenario.usb.host_jitter_transfers * transfer_ms(scenario, stream);
  return mean_ms * (1 - std::sqrt((1 - correlation) / (1 + correlation)));
}

}  // namespace

double calibrated_delay_ms(const Scenario& scenario, const Stream& stream) {
  if (stream.calibrated_delay_ms) return *stream.calibrated_delay_ms;
  const std::vector<double>& table_ms = scenario.usb.delivery_quantiles_ms;
  return rounded(readout_ms(stream) / 2 + mean_transferred_ms(scenario, stream) +
                 common_jitter_ms(scenario, stream) + (table_ms.empty() ? 0 : table_ms.front()) -
                 scenario.hosts.clock.arrival_quantum_ms / 2);
}

double calibrated_asymmetry_ms(const ClockPoll& polls) {
  return polls.calibrated_asymmetry_ms.value_or(rounded(polls.request_ms - polls.reply_ms));
}

}  // namespace simbench::scenarios

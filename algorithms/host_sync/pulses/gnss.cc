#include "algorithms/host_sync/pulses/gnss.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// No oscillator is so far off: the stamps are wrong.
constexpr double kMostSlope = 1e-3;

// Without `outcome` for the master, whose own clock is nobody's outcome.
Task<void> follow(Host& host, GnssSettings settings, std::optional<OutcomeReport> outcome) {
  PulseInput* const input = host.pulse_input(PulseLine::kPps);
  if (input == nullptr) {
    if (outcome) outcome->failed(1, "the host has no PPS line (Host::pulse_input)");
    co_return;
  }
  SteeredClock clock(host, settings.steering);
  GnssEstimator estimator(settings.window);
  while (true) {
    const std::optional<PulseStamp> pulse =
        co_await input->next(host.steady_clock().now() + Gnss::kPatience);
    if (!pulse || !pulse->gnss) {
      const char* const why = pulse
                                  ? "the receiver sends no time with its pulses (PulseStamp::gnss)"
                                  : "no pulse on the PPS line";
      if (outcome) outcome->failed(1, why);
      continue;
    }
    clock.observe(pulse->system, pulse->steady);
    estimator.add(*pulse->gnss, pulse->steady);
    const std::optional<ClockLine> line = estimator.line();
    if (!line) continue;
    co_await clock.steer(*line);
    if (outcome) outcome->synchronised(1);
  }
}

}  // namespace

GnssEstimator::GnssEstimator(Nanoseconds window) : lateness_(to_ns(window)) {}

void GnssEstimator::add(Nanoseconds gnss, SteadyTime seen) {
  if (has_zero_) {
    const std::optional<ClockLine> known = line();
    const bool has_jumped = known && std::abs(to_ns(known->read(seen) - HostTime(gnss))) > kJumpNs;
    if (has_jumped) has_zero_ = false;
  }
  if (!has_zero_) {
    has_zero_ = true;
    zero_gnss_ = gnss;
    zero_seen_ = seen;
    pulses_ = 0;
    lateness_.clear();
  }
  const Nanoseconds since = gnss - zero_gnss_;
  lateness_.add(to_ns(since), to_ns((seen - zero_seen_) - since));
  ++pulses_;
}

std::optional<ClockLine> GnssEstimator::line() const {
  if (pulses_ < kFewestPulses || lateness_.span() <= 0) return std::nullopt;
  const auto [first, slope] = middle_line(lateness_.vertices());
  if (std::abs(slope) > kMostSlope) return std::nullopt;
  // Steady time runs 1 + slope while GNSS time runs 1.
  const auto seen_ns = static_cast<std::int64_t>(std::llround(first.x + first.y));
  return ClockLine{.at = zero_seen_ + Nanoseconds(seen_ns),
                   .value = HostTime(zero_gnss_ + from_ns(first.x)),
                   .rate_ppb = (1 / (1 + slope) - 1) * 1e9};
}

Task<void> Gnss::run_master(Host& host, std::vector<PeerId> /*slaves*/) {
  co_await follow(host, settings_, std::nullopt);
}

Task<void> Gnss::run_slave(Host& host, PeerId /*master*/) {
  co_await follow(host, settings_, OutcomeReport(host));
}

namespace {

HostSyncEntry gnss() {
  HostSyncEntry entry;
  entry.info.name = "gnss";
  entry.info.family = "gnss";
  entry.info.summary = "every host, the master too, follows a GNSS receiver of its own";
  entry.info.source = "PPS and time of day of a receiver; theory";
  entry.info.needs = {Need::kPps, Need::kGnss};
  entry.info.parameters = {
      number_parameter("warm_up_s", 60, 1, 1e6, "how long the service has run before the capture",
                       "assumption"),
      number_parameter("window_s", 60, 4, 1e5, "span of the pulses that the line is fitted to",
                       "assumption: short against the wander of a quartz"),
  };
  append_steering_parameters(entry.info.parameters);
  entry.make = [](const Parameters& parameters) {
    GnssSettings settings;
    settings.service_time = from_seconds(parameters.number("warm_up_s"));
    settings.window = from_seconds(parameters.number("window_s"));
    settings.steering = steering_settings(parameters);
    return std::make_unique<Gnss>(settings);
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> host_sync_gnss() { return {gnss()}; }

}  // namespace simbench

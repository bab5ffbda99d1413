#include "algorithms/host_sync/pulses/gnss.h"

#include <cmath>

#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

// No oscillator is so far off: the stamps are wrong.
constexpr double kMostSlope = 1e-3;
// A line without a pulse for so long has none.
constexpr Nanoseconds kGnssPatience{10'000'000'000};

// The master passes no `outcome`: its own clock is nobody's outcome.
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
        co_await input->next(host.steady_clock().now() + kGnssPatience);
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

Task<void> serve_gnss(Host& host, std::vector<PeerId> /*slaves*/, GnssSettings settings) {
  co_await follow(host, settings, std::nullopt);
}

Task<void> follow_gnss(Host& host, PeerId /*master*/, GnssSettings settings) {
  co_await follow(host, settings, OutcomeReport(host));
}

void GnssSettings::bind(ParameterBinder& parameters) {
  bind_warm_up(parameters, service_time);
  parameters.number("window_s", window, 4, 1e5, "span of the pulses that the line is fitted to",
                    "assumption: short against the wander of a quartz");
  steering.bind(parameters);
}

std::vector<HostSyncEntry> host_sync_gnss() {
  return {with_settings<HostSyncEntry>(
      {.name = "gnss",
       .family = "gnss",
       .summary = "every host, the master too, follows a GNSS receiver of its own",
       .source = "PPS and time of day of a receiver; theory",
       .needs = {Need::kPps, Need::kGnss}},
      GnssSettings{}, kMake<Gnss>)};
}

}  // namespace simbench

#include "algorithms/host_sync/ntp/w32time.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {

bool W32TimeSpikes::accept(Nanoseconds offset, SteadyTime at) {
  const bool is_large = offset >= kLargePhaseOffset || offset <= -kLargePhaseOffset;
  if (held_ < kHoldPeriod) {
    ++held_;
    return true;
  }
  if (!is_large) {
    suspicion_.reset();
    return true;
  }
  if (!suspicion_) suspicion_ = at;
  if (at - *suspicion_ < kSpikeWatchPeriod) return false;
  suspicion_.reset();
  held_ = 0;
  return true;
}

namespace {

constexpr double kUnitNs = 100;             // unit of the adjustment
constexpr double kClockRateUnits = 156250;  // one tick, 15.625 ms
constexpr double kPollFactor = 16;
constexpr std::uint8_t kSntpVersion = 3;
constexpr double kLocalClockDispersion = 10;  // s, the documented default

Nanoseconds magnitude(Nanoseconds interval) {
  return interval < Nanoseconds{0} ? -interval : interval;
}

Task<void> correct(Host& host, Nanoseconds offset, W32TimeSettings settings) {
  const W32TimeCorrection correction = w32time_correction(offset, settings);
  if (!correction.set) {
    co_await host.clock().slew(offset, correction.rate_ppb);
    co_return;
  }
  const HostTime now = co_await host.clock().now();
  co_await host.clock().set(now + offset);
}

// Repeats the request until there is a reply, and corrects the clock by it. The arguments must
// outlive the call.
Task<void> poll(Host& host, PeerId server, NtpAssociation& association,
                const W32TimeSettings& settings, W32TimeSpikes& spikes, OutcomeReport& outcome) {
  for (std::uint32_t request = 1; request <= W32Time::kRequestLimit; ++request) {
    const std::optional<NtpMeasurement> reply =
        co_await association.exchange(W32Time::kReplyTimeout);
    if (!reply) continue;
    const Nanoseconds offset = clock_offset(reply->t1, reply->t2, reply->t3, reply->t4);
    if (settings.max_phase_correction && magnitude(offset) > *settings.max_phase_correction) {
      outcome.failed(request, "the clock is off by " + std::to_string(to_seconds(offset)) +
                                  " s, more than W32Time corrects (MaxPosPhaseCorrection " +
                                  std::to_string(to_seconds(*settings.max_phase_correction)) +
                                  " s); set it by hand");
      co_return;
    }
    if (spikes.accept(offset, host.steady_clock().now())) {
      co_await correct(host, offset, settings);
    }
    outcome.synchronised(request);
    co_return;
  }
  outcome.failed(W32Time::kRequestLimit, "no valid reply from time server " +
                                             std::to_string(server) + " to " +
                                             std::to_string(W32Time::kRequestLimit) +
                                             " requests; is it running and reachable?");
}

}  // namespace

W32TimeSettings w32time_domain_settings() {
  W32TimeSettings settings;
  settings.poll_interval = from_ms(1024e3);
  settings.phase_correct_rate = 1;
  settings.max_allowed_phase_offset = from_ms(300e3);
  settings.max_phase_correction.reset();
  settings.service_time = from_ms(4 * 3600e3);
  settings.start_spread = from_ms(1024e3);
  return settings;
}

W32TimeCorrection w32time_correction(Nanoseconds offset, const W32TimeSettings& settings) {
  const Nanoseconds size = magnitude(offset);
  const double units = static_cast<double>(size.count()) / kUnitNs;
  W32TimeCorrection correction;
  correction.units_per_tick =
      units / (kPollFactor * settings.phase_correct_rate * to_seconds(settings.poll_interval));
  correction.rate_ppb = correction.units_per_tick / kClockRateUnits * 1e9;
  correction.set =
      size >= settings.max_allowed_phase_offset || correction.units_per_tick > kClockRateUnits / 2;
  return correction;
}

Task<void> W32Time::run_master(Host& host, std::vector<PeerId> slaves) {
  co_await serve_ntp(host, std::move(slaves), kLocalClockDispersion);
}

Task<void> W32Time::run_slave(Host& host, PeerId master) {
  const double part = host.random_uniform();
  co_await host.sleep_for(from_ms(part * to_ms(settings_.start_spread)));
  NtpAssociation association(host, master, NtpStamps::kApplication, kSntpVersion);
  W32TimeSpikes spikes;
  OutcomeReport outcome(host);
  while (true) {
    co_await poll(host, master, association, settings_, spikes, outcome);
    co_await host.sleep_for(settings_.poll_interval);
  }
}

namespace {

// w32time_domain is a family of its own: a scenario's parameters for a stand-alone machine are not
// meant for it.
HostSyncEntry w32time(const std::string& name, std::string summary,
                      const W32TimeSettings& defaults) {
  const std::string documentation =
      "Microsoft documentation of W32Time (docs/reference/host_sync.md section 2)";
  HostSyncEntry entry;
  entry.info.name = name;
  entry.info.family = name;
  entry.info.summary = std::move(summary);
  entry.info.source = documentation + "; RFC 4330";
  entry.info.parameters = {
      number_parameter("poll_interval_s", to_seconds(defaults.poll_interval), 16, 604800,
                       "time between polls: SpecialPollInterval (MinPollInterval in a domain)",
                       documentation),
      number_parameter("phase_correct_rate", defaults.phase_correct_rate, 1, 1e3,
                       "PhaseCorrectRate, divides the slew rate", documentation),
      number_parameter("max_allowed_phase_offset_s", to_seconds(defaults.max_allowed_phase_offset),
                       0, 1e6, "MaxAllowedPhaseOffset, from which on the clock is set, not slewed",
                       documentation),
      number_parameter("service_hours", to_seconds(defaults.service_time) / 3600, 0, 1e4,
                       "how long the service has run when the capture starts",
                       "assumption: at least two polls"),
      number_parameter("start_spread_s", to_seconds(defaults.start_spread), 0, 1e6,
                       "the services start at random times within this span",
                       "assumption: one poll interval, so that the hosts' polls are spread evenly"),
  };
  entry.make = [defaults](const Parameters& parameters) {
    W32TimeSettings settings = defaults;
    settings.poll_interval = from_seconds(parameters.number("poll_interval_s"));
    settings.phase_correct_rate = parameters.number("phase_correct_rate");
    settings.max_allowed_phase_offset =
        from_seconds(parameters.number("max_allowed_phase_offset_s"));
    settings.service_time = from_ms(parameters.number("service_hours") * 3600e3);
    settings.start_spread = from_seconds(parameters.number("start_spread_s"));
    return std::make_unique<W32Time>(settings);
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> host_sync_w32time() {
  return {
      w32time("w32time", "SNTP in the manner of stand-alone Windows Time, as documented",
              W32TimeSettings{}),
      w32time("w32time_domain",
              "SNTP in the manner of Windows Time on a member of a domain, as documented",
              w32time_domain_settings()),
  };
}

}  // namespace simbench

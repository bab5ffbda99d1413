#include "algorithms/host_sync/ntp/w32time.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "algorithms/host_sync/ntp/ntp_association.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/registry.h"

namespace simbench {

bool W32TimeSpikes::accept(Nanoseconds offset, SteadyTime at) {
  const bool is_large = offset >= kLargePhaseOffset || offset <= -kLargePhaseOffset;
  was_held_ = held_ < kHoldPeriod;
  if (was_held_) {
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
constexpr double kBasePoll = 64;              // s, to which FrequencyCorrectRate refers
constexpr double kFllAverage = 4;             // CLOCK_AVG
constexpr double kFllBegin = 256;             // s, CLOCK_MINSEC
constexpr double kFllIntercept = 1024;        // s, CLOCK_ALLAN

Nanoseconds magnitude(Nanoseconds interval) {
  return interval < Nanoseconds{0} ? -interval : interval;
}

// The client on one slave. The host must outlive the client, and the client its coroutines.
class W32TimeClient {
 public:
  W32TimeClient(Host& host, PeerId server, const W32TimeSettings& settings)
      : host_(host),
        server_(server),
        settings_(settings),
        association_(host, server, NtpStamps::kApplication, kSntpVersion),
        outcome_(host) {}

  Task<void> run();

 private:
  // Repeats the request until there is a reply, and corrects the clock by it.
  Task<void> poll();
  Task<void> correct(Nanoseconds offset);
  Task<void> correct_rate(Nanoseconds offset);

  Host& host_;
  PeerId server_;
  W32TimeSettings settings_;
  NtpAssociation association_;
  W32TimeSpikes spikes_;
  double rate_ = 0;  // correction, as a fraction
  std::optional<SteadyTime> accepted_;
  OutcomeReport outcome_;
};

Task<void> W32TimeClient::run() {
  const std::optional<StoredFrequency> stored = host_.stored_frequency();
  if (stored) {
    rate_ = std::clamp(stored->ppb * 1e-9, -kW32TimeMaxRate, kW32TimeMaxRate);
    co_await host_.clock().adjust_frequency(rate_ * 1e9);
  }
  const double part = host_.random_uniform();
  co_await host_.sleep_for(from_ms(part * to_ms(settings_.start_spread)));
  while (true) {
    co_await poll();
    co_await host_.sleep_for(settings_.poll_interval);
  }
}

Task<void> W32TimeClient::poll() {
  for (std::uint32_t request = 1; request <= kW32TimeRequestLimit; ++request) {
    const std::optional<NtpMeasurement> reply =
        co_await association_.exchange(kW32TimeReplyTimeout);
    if (!reply) continue;
    const Nanoseconds offset = clock_offset(reply->t1, reply->t2, reply->t3, reply->t4);
    if (settings_.max_phase_correction && magnitude(offset) > *settings_.max_phase_correction) {
      outcome_.failed(request, "the clock is off by " + std::to_string(to_seconds(offset)) +
                                   " s, more than W32Time corrects (MaxPosPhaseCorrection " +
                                   std::to_string(to_seconds(*settings_.max_phase_correction)) +
                                   " s); set it by hand");
      co_return;
    }
    if (spikes_.accept(offset, host_.steady_clock().now())) co_await correct(offset);
    outcome_.synchronised(request);
    co_return;
  }
  outcome_.failed(kW32TimeRequestLimit, "no valid reply from time server " +
                                            std::to_string(server_) + " to " +
                                            std::to_string(kW32TimeRequestLimit) +
                                            " requests; is it running and reachable?");
}

Task<void> W32TimeClient::correct(Nanoseconds offset) {
  co_await correct_rate(offset);
  const W32TimeCorrection correction = w32time_correction(offset, settings_);
  if (!correction.set) {
    co_await host_.clock().slew(offset, correction.rate_ppb);
    co_return;
  }
  const HostTime now = co_await host_.clock().now();
  co_await host_.clock().set(now + offset);
}

Task<void> W32TimeClient::correct_rate(Nanoseconds offset) {
  const SteadyTime now = host_.steady_clock().now();
  const std::optional<SteadyTime> before = std::exchange(accepted_, now);
  if (!before || !spikes_.corrects_rate()) co_return;
  const double change = w32time_rate_change(offset, now - *before, settings_);
  if (change == 0) co_return;
  rate_ = std::clamp(rate_ + change, -kW32TimeMaxRate, kW32TimeMaxRate);
  co_await host_.clock().adjust_frequency(rate_ * 1e9);
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

double w32time_rate_change(Nanoseconds offset, Nanoseconds interval,
                           const W32TimeSettings& settings) {
  const double offset_s = to_seconds(offset);
  const double mu_s = to_seconds(interval);
  if (settings.rate == W32TimeRate::kHeld || mu_s <= 0) return 0;
  const double polls = std::max(to_seconds(settings.poll_interval) / kBasePoll, 1.0);
  const double gain_s = settings.frequency_correct_rate * kBasePoll * polls;
  const double pll = offset_s * mu_s / (16 * gain_s * gain_s);
  if (settings.rate == W32TimeRate::kPll) return pll;
  const double part = std::clamp((mu_s - kFllBegin) / kFllIntercept, 0.0, 1.0);
  return pll + offset_s * part / (kFllAverage * std::max(mu_s, kFllIntercept));
}

Task<void> serve_w32time(Host& host, std::vector<PeerId> slaves, W32TimeSettings /*settings*/) {
  co_await serve_ntp(host, std::move(slaves), {.root_dispersion_s = kLocalClockDispersion});
}

Task<void> follow_w32time(Host& host, PeerId master, W32TimeSettings settings) {
  W32TimeClient client(host, master, settings);
  co_await client.run();
}

namespace {

const char* const kW32TimeDocumentation =
    "Microsoft documentation of W32Time (docs/reference/host_sync.md section 2)";

}  // namespace

void W32TimeSettings::bind(ParameterBinder& parameters) {
  parameters.number("poll_interval_s", poll_interval, 16, 604800,
                    "time between polls: SpecialPollInterval (MinPollInterval in a domain)",
                    kW32TimeDocumentation);
  parameters.number("phase_correct_rate", phase_correct_rate, 1, 1e3,
                    "PhaseCorrectRate, divides the slew rate", kW32TimeDocumentation);
  parameters.number("frequency_correct_rate", frequency_correct_rate, 1, 1e3,
                    "FrequencyCorrectRate, divides the correction of the rate",
                    kW32TimeDocumentation);
  parameters.choice(
      "rate_correction", rate,
      {{"hybrid", W32TimeRate::kHybrid}, {"pll", W32TimeRate::kPll}, {"held", W32TimeRate::kHeld}},
      "how the clock's rate is corrected after the hold, of which little is "
      "documented: by PLL and FLL, by PLL, not at all",
      "[MS-W32T] 2.2.7 and UDel TR 97-3, which it names; Microsoft, "
      "FrequencyCorrectRate Entry, for the PLL");
  parameters.number("max_allowed_phase_offset_s", max_allowed_phase_offset, 0, 1e6,
                    "MaxAllowedPhaseOffset, from which on the clock is set, not slewed",
                    kW32TimeDocumentation);
  parameters.number("service_hours", service_time, 0, 1e4,
                    "how long the service has run when the capture starts",
                    "assumption: at least two polls");
  parameters.number("start_spread_s", start_spread, 0, 1e6,
                    "the services start at random times within this span",
                    "assumption: one poll interval, so that the hosts' polls are spread evenly");
}

namespace {

// w32time_domain is a family of its own: a scenario's parameters for a stand-alone machine are not
// meant for it.
HostSyncEntry w32time(const std::string& name, std::string summary,
                      const W32TimeSettings& settings) {
  return with_settings<HostSyncEntry>({.name = name,
                                       .family = name,
                                       .summary = std::move(summary),
                                       .source = std::string(kW32TimeDocumentation) + "; RFC 4330"},
                                      settings, kMake<W32Time>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_w32time() {
  return {
      w32time("w32time", "SNTP in the manner of stand-alone Windows Time, as documented", {}),
      w32time("w32time_domain",
              "SNTP in the manner of Windows Time on a member of a domain, as documented",
              w32time_domain_settings()),
  };
}

}  // namespace simbench

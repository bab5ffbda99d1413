#include "algorithms/host_sync/ntp/registration_ntp.h"

#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/chrony/chrony_service.h"
#include "algorithms/host_sync/ntp/ntp_service.h"
#include "algorithms/host_sync/ntp/w32time.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

const char* const kReferenceNtp =
    "reference implementation (docs/reference/host_sync.md section 2)";

void check_poll_bounds(int low, int high) {
  if (low > high) throw ParameterError("max_poll", "max_poll must not be below min_poll");
}

NtpStamps stamps_of(const Parameters& parameters) {
  return parameters.text("stamps") == "kernel" ? NtpStamps::kKernel : NtpStamps::kApplication;
}

std::vector<ParameterSpec> ntp_parameters(double service_hours) {
  return {
      number_parameter("step_ms", 128, 0, 1e6, "offset above which the clock is stepped; 0: never",
                       kReferenceNtp),
      number_parameter("step_out_s", 300, 1, 1e5,
                       "how long such an offset must last, and how long the frequency is measured",
                       "reference implementation; RFC 5905: 900"),
      number_parameter("panic_s", 1000, 0, 1e9, "offset that ends the service; 0: none",
                       kReferenceNtp),
      number_parameter("min_poll", 6, 3, 17, "shortest poll interval, log2 s", kReferenceNtp),
      number_parameter("max_poll", 10, 3, 17, "longest poll interval, log2 s", kReferenceNtp),
      flag_parameter("iburst", true, "a burst of eight exchanges while the server is not reached",
                     "usual configuration (iburst)"),
      choice_parameter("stamps", {"application", "kernel"},
                       "t1 before the send, or from the kernel where it tells",
                       "ntpd stamps in the application"),
      number_parameter("broadcast_interval_s", 64, 8, 131072,
                       "between broadcasts (broadcast modes only)", "RFC 5905 section 9.2"),
      number_parameter("broadcast_delay_ms", 4, 0, 1e4,
                       "assumed one-way delay (ntp_broadcast_fixed only)",
                       "older documents of ntpd: 4 ms, 3 to 7 typical"),
      number_parameter("service_hours", service_hours, 0, 1e4,
                       "how long the service has run when the capture starts",
                       "assumption: most of the start-up transient is over"),
  };
}

HostSyncEntry ntp(std::string name, std::string summary, NtpMode mode, double service_hours) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = "ntp";
  entry.info.summary = std::move(summary);
  entry.info.source = "RFC 5905; docs/reference/host_sync.md section 2";
  entry.info.parameters = ntp_parameters(service_hours);
  entry.make = [mode](const Parameters& parameters) {
    NtpSettings settings;
    settings.mode = mode;
    settings.discipline.step_s = parameters.number("step_ms") * 1e-3;
    settings.discipline.step_out_s = parameters.number("step_out_s");
    settings.discipline.panic_s = parameters.number("panic_s");
    settings.discipline.poll_min = static_cast<int>(parameters.number("min_poll"));
    settings.discipline.poll_max = static_cast<int>(parameters.number("max_poll"));
    check_poll_bounds(settings.discipline.poll_min, settings.discipline.poll_max);
    settings.initial_burst = parameters.flag("iburst");
    settings.stamps = stamps_of(parameters);
    settings.broadcast_interval = from_ms(parameters.number("broadcast_interval_s") * 1e3);
    settings.broadcast_delay_s = parameters.number("broadcast_delay_ms") * 1e-3;
    settings.service_time = from_ms(parameters.number("service_hours") * 3600e3);
    return std::make_unique<NtpService>(settings);
  };
  return entry;
}

const char* const kChronyDocumentation =
    "chrony.conf documentation (docs/reference/host_sync.md section 2)";

std::vector<ParameterSpec> chrony_parameters() {
  return {
      number_parameter("min_poll", 6, 0, 17, "shortest poll interval, log2 s",
                       kChronyDocumentation),
      number_parameter("max_poll", 10, 0, 17, "longest poll interval, log2 s",
                       kChronyDocumentation),
      number_parameter("poll_target", 8, 3, 60, "samples that the poll interval aims at",
                       kChronyDocumentation),
      flag_parameter("iburst", true, "four good exchanges at 2 s to begin with",
                     "usual configuration (iburst)"),
      number_parameter("min_samples", 6, 3, 64, "samples that the runs test leaves",
                       kChronyDocumentation),
      number_parameter("max_samples", 64, 4, 64, "samples that are kept", kChronyDocumentation),
      number_parameter("max_delay_ratio", 10, 0.1, 1e6,
                       "largest delay above the minimum, in standard deviations of the samples",
                       kChronyDocumentation),
      number_parameter("correction_ratio", 3, 0.01, 100,
                       "duration of a slew over the time between updates (corrtimeratio)",
                       kChronyDocumentation),
      number_parameter("max_slew_ppm", 83333.333, 1, 100000, "fastest slew (maxslewrate)",
                       kChronyDocumentation),
      number_parameter("max_update_skew_ppm", 1000, 0.001, 1e6,
                       "skew above which a frequency is not used (maxupdateskew)",
                       kChronyDocumentation),
      choice_parameter("stamps", {"application", "kernel"},
                       "t1 before the send, or from the kernel where it tells",
                       "the other stamps are the application's"),
      number_parameter("service_hours", 4, 0, 1e4,
                       "how long the service has run when the capture starts",
                       "assumption: start-up transients are over"),
  };
}

std::unique_ptr<HostSync> make_chrony(const Parameters& parameters) {
  ChronySettings settings;
  settings.poll_min = static_cast<int>(parameters.number("min_poll"));
  settings.poll_max = static_cast<int>(parameters.number("max_poll"));
  check_poll_bounds(settings.poll_min, settings.poll_max);
  settings.poll_target = parameters.number("poll_target");
  settings.initial_burst = parameters.flag("iburst");
  settings.stats.min_samples = static_cast<std::size_t>(parameters.number("min_samples"));
  settings.stats.max_samples = static_cast<std::size_t>(parameters.number("max_samples"));
  settings.stats.max_delay_ratio = parameters.number("max_delay_ratio");
  settings.reference.correction_ratio = parameters.number("correction_ratio");
  settings.reference.max_slew_rate = parameters.number("max_slew_ppm") * 1e-6;
  settings.reference.max_update_skew = parameters.number("max_update_skew_ppm") * 1e-6;
  settings.stamps = stamps_of(parameters);
  settings.service_time = from_ms(parameters.number("service_hours") * 3600e3);
  return std::make_unique<ChronyService>(settings);
}

HostSyncEntry chrony() {
  HostSyncEntry entry;
  entry.info.name = "chrony";
  entry.info.family = "chrony";
  entry.info.summary = "NTP client in the manner of chronyd: weighted regression, slews only";
  entry.info.source = "chrony (docs/reference/host_sync.md sections 1 and 2); RFC 5905";
  entry.info.parameters = chrony_parameters();
  entry.make = make_chrony;
  return entry;
}

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
    settings.poll_interval = from_ms(parameters.number("poll_interval_s") * 1e3);
    settings.phase_correct_rate = parameters.number("phase_correct_rate");
    settings.max_allowed_phase_offset =
        from_ms(parameters.number("max_allowed_phase_offset_s") * 1e3);
    settings.service_time = from_ms(parameters.number("service_hours") * 3600e3);
    settings.start_spread = from_ms(parameters.number("start_spread_s") * 1e3);
    return std::make_unique<W32Time>(settings);
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> ntp_host_syncs() {
  return {
      ntp("ntp", "NTP client and server: clock filter, PLL/FLL discipline, adaptive poll",
          NtpMode::kUnicast, 16),
      ntp("ntp_broadcast_volley", "NTP broadcast, its delay calibrated by one volley of exchanges",
          NtpMode::kBroadcastVolley, 6),
      ntp("ntp_broadcast_fixed", "NTP broadcast with an assumed delay", NtpMode::kBroadcastFixed,
          6),
      w32time("w32time", "SNTP in the manner of stand-alone Windows Time, as documented",
              W32TimeSettings{}),
      w32time("w32time_domain",
              "SNTP in the manner of Windows Time on a member of a domain, as documented",
              w32time_domain_settings()),
      chrony(),
  };
}

}  // namespace simbench

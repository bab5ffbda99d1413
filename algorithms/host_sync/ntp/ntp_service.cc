#include "algorithms/host_sync/ntp/ntp_service.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/ntp/ntp_client.h"
#include "algorithms/registry.h"

namespace simbench {

void check_poll_bounds(int low, int high) {
  if (low > high) throw ParameterError("max_poll", "max_poll must not be below min_poll");
}

NtpStamps stamps_of(const Parameters& parameters) {
  return parameters.text("stamps") == "kernel" ? NtpStamps::kKernel : NtpStamps::kApplication;
}

NtpService::NtpService(const NtpSettings& settings) : settings_(settings) {
  if (settings_.mode == NtpMode::kUnicast) return;
  const int poll =
      static_cast<int>(std::lround(std::log2(to_seconds(settings.broadcast_interval))));
  settings_.discipline.poll_min = poll;
  settings_.discipline.poll_max = poll;
}

Task<void> NtpService::run_master(Host& host, std::vector<PeerId> slaves) {
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) servers.push_back(serve_ntp(host, slave));
  if (settings_.mode != NtpMode::kUnicast) {
    servers.push_back(broadcast_ntp(host, std::move(slaves), settings_.broadcast_interval));
  }
  co_await join_all(std::move(servers));
}

Task<void> NtpService::run_slave(Host& host, PeerId master) {
  NtpClient client(host, master, settings_);
  co_await client.run();
}

namespace {

const char* const kReferenceNtp =
    "reference implementation (docs/reference/host_sync.md section 2)";

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

}  // namespace

std::vector<HostSyncEntry> host_sync_ntp() {
  return {
      ntp("ntp", "NTP client and server: clock filter, PLL/FLL discipline, adaptive poll",
          NtpMode::kUnicast, 16),
      ntp("ntp_broadcast_volley", "NTP broadcast, its delay calibrated by one volley of exchanges",
          NtpMode::kBroadcastVolley, 6),
      ntp("ntp_broadcast_fixed", "NTP broadcast with an assumed delay", NtpMode::kBroadcastFixed,
          6),
  };
}

}  // namespace simbench

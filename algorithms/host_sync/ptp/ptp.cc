#include "algorithms/host_sync/ptp/ptp.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/ptp/ptp_port.h"
#include "algorithms/parameters.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

Task<void> serve_ptp(Host& host, PeerId slave, PtpSettings settings,
                     std::shared_ptr<const bool> is_ready) {
  PtpMaster master(host, slave, settings, std::move(is_ready));
  co_await master.run();
}

}  // namespace

Task<void> Ptp::run_master(Host& host, std::vector<PeerId> slaves) {
  const bool needs_card = settings_.stamps == StampSource::kCard;
  // The slaves will report that no Sync came.
  if (needs_card && host.hardware_clock() == nullptr) co_return;
  auto is_ready = std::make_shared<bool>(!needs_card);
  std::vector<Task<void>> tasks;
  tasks.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) tasks.push_back(serve_ptp(host, slave, settings_, is_ready));
  if (needs_card) {
    tasks.push_back(keep_coupled(host, ClockKind::kHardware, settings_.servo_limits, is_ready));
  }
  co_await join_all(std::move(tasks));
}

Task<void> Ptp::run_slave(Host& host, PeerId master) {
  PtpSlave slave(host, master, settings_);
  co_await slave.run();
}

namespace {

const char* const kLinuxPtp = "linuxptp (ptp4l, phc2sys), defaults";
const char* const kLogInterval = "linuxptp: logSyncInterval, logMinDelayReqInterval, defaults 0";

// One of the registered forms.
struct PtpForm {
  bool is_peer_delay = false;
  bool has_hardware_stamps = false;
  double log_interval = 0;
};

std::vector<ParameterSpec> ptp_parameters(const PtpForm& form) {
  const std::string source =
      form.log_interval == 0 ? kLogInterval : "sixteen a second: G.8275.1's rate";
  std::vector<ParameterSpec> specs = {
      number_parameter("warm_up_s", form.has_hardware_stamps ? 60 : 300, 1, 1e6,
                       "how long the service has run before the capture",
                       "assumption: until the default servo has settled"),
      choice_parameter("servo", {"pi", "linreg"}, "the servo that steers the clock that stamps",
                       kLinuxPtp),
      number_parameter("log_sync_interval", form.log_interval, -7, 12,
                       "log2 of the seconds between two Sync messages: -4 is 16 a second", source),
      number_parameter("log_delay_interval", form.log_interval, -7, 12,
                       "log2 of the mean seconds between two measurements of the delay", source),
      number_parameter("delay_median", 10, 1, 1e4, "length of the delay's moving median",
                       kLinuxPtp),
      number_parameter("first_step_threshold_us", 20, 0, 1e12,
                       "the first correction is a step above this; 0: never", kLinuxPtp),
      number_parameter("step_threshold_us", 0, 0, 1e12, "later ones are steps above this; 0: never",
                       kLinuxPtp),
      number_parameter("max_frequency_ppm", 500, 1, 4e5, "largest correction of a frequency",
                       "adjtimex(2)"),
  };
  if (!form.has_hardware_stamps) specs.push_back(software_stamps_parameter());
  return specs;
}

Nanoseconds interval_of(const Parameters& parameters, const char* log_interval) {
  return from_seconds(std::exp2(parameters.number(log_interval)));
}

PtpSettings ptp_settings(const Parameters& parameters, const PtpForm& form) {
  PtpSettings settings;
  settings.is_peer_delay = form.is_peer_delay;
  settings.stamps = form.has_hardware_stamps ? StampSource::kCard : software_stamps(parameters);
  settings.service_time = from_seconds(parameters.number("warm_up_s"));
  settings.servo = parameters.text("servo") == "pi" ? ServoKind::kPi : ServoKind::kLinearRegression;
  settings.sync_interval = interval_of(parameters, "log_sync_interval");
  settings.delay_interval = interval_of(parameters, "log_delay_interval");
  settings.median_length = static_cast<std::size_t>(parameters.number("delay_median"));
  settings.servo_limits.first_step_threshold_ns =
      parameters.number("first_step_threshold_us") * 1e3;
  settings.servo_limits.step_threshold_ns = parameters.number("step_threshold_us") * 1e3;
  settings.servo_limits.max_frequency_ppb = parameters.number("max_frequency_ppm") * 1e3;
  return settings;
}

HostSyncEntry ptp(std::string name, std::string summary, PtpForm form) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = form.has_hardware_stamps ? "ptp_hardware" : "ptp_software";
  entry.info.summary = std::move(summary);
  entry.info.source = "IEEE 1588-2008; linuxptp (docs/reference/host_sync.md section 1)";
  entry.info.parameters = ptp_parameters(form);
  if (form.has_hardware_stamps) entry.info.needs = {Need::kHardwareStamps};
  entry.make = [form](const Parameters& parameters) {
    return std::make_unique<Ptp>(ptp_settings(parameters, form));
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> host_sync_ptp() {
  constexpr double kSixteenPerSecond = -4;
  return {
      ptp("ptp_e2e_software", "PTP end to end with software stamps, steering the system clock",
          {.is_peer_delay = false, .has_hardware_stamps = false}),
      ptp("ptp_e2e_software_16hz", "the same with 16 Syncs and delay requests a second",
          {.is_peer_delay = false,
           .has_hardware_stamps = false,
           .log_interval = kSixteenPerSecond}),
      ptp("ptp_p2p_software", "PTP with peer delay and software stamps, steering the system clock",
          {.is_peer_delay = true, .has_hardware_stamps = false}),
      ptp("ptp_e2e_hardware",
          "PTP end to end with the network cards' stamps and clocks, then phc2sys",
          {.is_peer_delay = false, .has_hardware_stamps = true}),
      ptp("ptp_e2e_hardware_16hz", "the same with 16 Syncs and delay requests a second",
          {.is_peer_delay = false, .has_hardware_stamps = true, .log_interval = kSixteenPerSecond}),
      ptp("ptp_p2p_hardware",
          "PTP with peer delay, the network cards' stamps and clocks, then phc2sys",
          {.is_peer_delay = true, .has_hardware_stamps = true}),
  };
}

}  // namespace simbench

#include "algorithms/host_sync/ptp/ptp.h"

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

// The master's card follows its system clock.
Task<void> couple_card(Host& host, PtpSettings settings, std::shared_ptr<bool> is_ready) {
  ClockCoupling coupling(host, ClockKind::kHardware, settings);
  while (true) {
    co_await coupling.update();
    *is_ready = coupling.is_locked();
    co_await host.sleep_for(ClockCoupling::kInterval);
  }
}

}  // namespace

Task<void> Ptp::run_master(Host& host, std::vector<PeerId> slaves) {
  const bool needs_card = settings_.has_hardware_stamps;
  // The slaves will report that no Sync came.
  if (needs_card && host.hardware_clock() == nullptr) co_return;
  auto is_ready = std::make_shared<bool>(!needs_card);
  std::vector<Task<void>> tasks;
  tasks.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) tasks.push_back(serve_ptp(host, slave, settings_, is_ready));
  if (needs_card) tasks.push_back(couple_card(host, settings_, is_ready));
  co_await join_all(std::move(tasks));
}

Task<void> Ptp::run_slave(Host& host, PeerId master) {
  PtpSlave slave(host, master, settings_);
  co_await slave.run();
}

namespace {

const char* const kLinuxPtp = "linuxptp (ptp4l, phc2sys), defaults";

std::vector<ParameterSpec> ptp_parameters(double warm_up_s) {
  return {
      number_parameter("warm_up_s", warm_up_s, 1, 1e6,
                       "how long the service has run before the capture",
                       "assumption: until the default servo has settled"),
      choice_parameter("servo", {"pi", "linreg"}, "the servo that steers the clock that stamps",
                       kLinuxPtp),
      number_parameter("sync_interval_s", 1, 1e-3, 1e4, "time between two Sync messages",
                       kLinuxPtp),
      number_parameter("delay_interval_s", 1, 1e-3, 1e4,
                       "mean time between two measurements of the delay", kLinuxPtp),
      number_parameter("delay_median", 10, 1, 1e4, "length of the delay's moving median",
                       kLinuxPtp),
      number_parameter("first_step_threshold_us", 20, 0, 1e12,
                       "the first correction is a step above this; 0: never", kLinuxPtp),
      number_parameter("step_threshold_us", 0, 0, 1e12, "later ones are steps above this; 0: never",
                       kLinuxPtp),
      number_parameter("max_frequency_ppm", 500, 1, 4e5, "largest correction of a frequency",
                       "adjtimex(2)"),
  };
}

HostSyncEntry ptp(std::string name, std::string summary, bool is_peer_delay, bool has_hardware) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = has_hardware ? "ptp_hardware" : "ptp_software";
  entry.info.summary = std::move(summary);
  entry.info.source = "IEEE 1588-2008; linuxptp (docs/reference/host_sync.md section 1)";
  entry.info.parameters = ptp_parameters(has_hardware ? 60 : 300);
  if (has_hardware) entry.info.needs = {Need::kHardwareStamps};
  entry.make = [is_peer_delay, has_hardware](const Parameters& parameters) {
    PtpSettings settings;
    settings.is_peer_delay = is_peer_delay;
    settings.has_hardware_stamps = has_hardware;
    settings.service_time = from_seconds(parameters.number("warm_up_s"));
    settings.servo =
        parameters.text("servo") == "pi" ? ServoKind::kPi : ServoKind::kLinearRegression;
    settings.sync_interval = from_seconds(parameters.number("sync_interval_s"));
    settings.delay_interval = from_seconds(parameters.number("delay_interval_s"));
    settings.median_length = static_cast<std::size_t>(parameters.number("delay_median"));
    settings.first_step_threshold_us = parameters.number("first_step_threshold_us");
    settings.step_threshold_us = parameters.number("step_threshold_us");
    settings.max_frequency_ppm = parameters.number("max_frequency_ppm");
    return std::make_unique<Ptp>(settings);
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> host_sync_ptp() {
  return {
      ptp("ptp_e2e_software", "PTP end to end with software stamps, steering the system clock",
          false, false),
      ptp("ptp_p2p_software", "PTP with peer delay and software stamps, steering the system clock",
          true, false),
      ptp("ptp_e2e_hardware",
          "PTP end to end with the network cards' stamps and clocks, then phc2sys", false, true),
      ptp("ptp_p2p_hardware",
          "PTP with peer delay, the network cards' stamps and clocks, then phc2sys", true, true),
  };
}

}  // namespace simbench

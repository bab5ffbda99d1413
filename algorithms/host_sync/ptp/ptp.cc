#include "algorithms/host_sync/ptp/ptp.h"

#include <memory>
#include <utility>
#include <vector>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/ptp/ptp_port.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

Task<void> serve_ptp_slave(Host& host, PeerId slave, PtpSettings settings,
                           std::shared_ptr<const bool> is_ready) {
  PtpMaster master(host, slave, settings, std::move(is_ready));
  co_await master.run();
}

ServeSlave serving(Host& host, const PtpSettings& settings) {
  return [&host, settings](PeerId slave, std::shared_ptr<const bool> is_ready) {
    return serve_ptp_slave(host, slave, settings, std::move(is_ready));
  };
}

}  // namespace

Task<void> serve_ptp(Host& host, std::vector<PeerId> slaves, PtpSettings settings) {
  return serve_slaves(host, std::move(slaves), settings.stamps, settings.servo_limits,
                      serving(host, settings));
}

Task<void> follow_ptp(Host& host, PeerId master, PtpSettings settings) {
  PtpSlave slave(host, master, settings);
  co_await slave.run();
}

Task<void> relay_ptp(Host& host, PeerId master, std::vector<PeerId> slaves, PtpSettings settings) {
  PtpSlave port(host, master, settings);
  std::vector<Task<void>> ports;
  ports.push_back(port.run());
  ports.push_back(
      serve_slaves_of_relay(std::move(slaves), port.is_locked(), serving(host, settings)));
  co_await join_all(std::move(ports));
}

namespace {

const char* const kLinuxPtp = "linuxptp (ptp4l, phc2sys), defaults";
constexpr Nanoseconds kSixteenPerSecond = from_seconds(1.0 / 16);

}  // namespace

void PtpSettings::bind(ParameterBinder& parameters) {
  const char* const log_interval =
      sync_interval == kSixteenPerSecond
          ? "sixteen a second: G.8275.1's rate"
          : "linuxptp: logSyncInterval, logMinDelayReqInterval, defaults 0";
  bind_warm_up(parameters, service_time, "assumption: until the default servo has settled");
  parameters.choice("servo", servo,
                    {{"pi", ServoKind::kPi}, {"linreg", ServoKind::kLinearRegression}},
                    "the servo that steers the clock that stamps", kLinuxPtp);
  parameters.log2_seconds("log_sync_interval", sync_interval, -7, 12,
                          "log2 of the seconds between two Sync messages: -4 is 16 a second",
                          log_interval);
  parameters.log2_seconds("log_delay_interval", delay_interval, -7, 12,
                          "log2 of the mean seconds between two measurements of the delay",
                          log_interval);
  parameters.number("delay_median", median_length, 1, 1e4, "length of the delay's moving median",
                    kLinuxPtp);
  parameters.number("domain", domain, 0, 127, "domainNumber: messages of others are ignored",
                    kLinuxPtp);
  servo_limits.bind_first_step(parameters, kLinuxPtp);
  parameters.scaled("step_threshold_us", servo_limits.step_threshold_ns, 1e3, 0, 1e12,
                    "later ones are steps above this; 0: never", kLinuxPtp);
  servo_limits.bind_max_frequency(parameters,
                                  "linuxptp: max_frequency; clockadj_max_freq(), phc_max_adj()");
  bind_software_stamps(parameters, stamps);
}

namespace {

HostSyncEntry ptp(std::string name, std::string summary, PtpSettings settings) {
  const bool has_card = settings.stamps == StampSource::kCard;
  if (has_card) settings.service_time = from_ms(60e3);
  return with_settings<HostSyncEntry>(
      {.name = std::move(name),
       .family = has_card ? "ptp_hardware" : "ptp_software",
       .summary = std::move(summary),
       .source = "IEEE 1588-2008; linuxptp (docs/reference/host_sync.md section 1)",
       .needs = needs_of(settings.stamps)},
      settings, kMake<Ptp>);
}

}  // namespace

std::vector<HostSyncEntry> host_sync_ptp() {
  return {
      ptp("ptp_e2e_software", "PTP end to end with software stamps, steering the system clock", {}),
      ptp("ptp_e2e_software_16hz", "the same with 16 Syncs and delay requests a second",
          {.sync_interval = kSixteenPerSecond, .delay_interval = kSixteenPerSecond}),
      ptp("ptp_p2p_software", "PTP with peer delay and software stamps, steering the system clock",
          {.is_peer_delay = true}),
      ptp("ptp_e2e_hardware",
          "PTP end to end with the network cards' stamps and clocks, then phc2sys",
          {.stamps = StampSource::kCard}),
      ptp("ptp_e2e_hardware_16hz", "the same with 16 Syncs and delay requests a second",
          {.stamps = StampSource::kCard,
           .sync_interval = kSixteenPerSecond,
           .delay_interval = kSixteenPerSecond}),
      ptp("ptp_p2p_hardware",
          "PTP with peer delay, the network cards' stamps and clocks, then phc2sys",
          {.is_peer_delay = true, .stamps = StampSource::kCard}),
  };
}

}  // namespace simbench

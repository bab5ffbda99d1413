#include "algorithms/host_sync/pulses/registration_pulse.h"

#include <memory>
#include <string>
#include <utility>

#include "algorithms/host_sync/pulses/common_view.h"
#include "algorithms/host_sync/pulses/gnss.h"
#include "algorithms/host_sync/steering_parameters.h"
#include "algorithms/host_sync/two_way/two_way_parameters.h"
#include "algorithms/parameter_specs.h"

namespace simbench {
namespace {

const char* const kAssumption = "assumption";

HostSyncEntry common_view(std::string name, std::string summary, std::string source,
                          PulseSource pulses, Need need) {
  HostSyncEntry entry;
  entry.info.name = std::move(name);
  entry.info.family = "common_view";
  entry.info.summary = std::move(summary);
  entry.info.source = std::move(source);
  entry.info.needs = {need};
  entry.info.parameters = two_way_parameters();
  entry.info.parameters.push_back(number_parameter(
      "pulse_window_s", 60, 1, 1e5, "span of the pulses that are compared", kAssumption));
  entry.info.parameters.push_back(number_parameter(
      "settle_s", 5, 0, 1e5, "frames of a camera's first seconds that are left out",
      "docs/reference/paper.md section 8: the first 5 s are unsteady"));
  entry.info.parameters.push_back(number_parameter(
      "asymmetry_sigma_us", 10, 0, 1e6,
      "asymmetry to expect of a link; a correction less certain than half of it counts less",
      "network of the *_lan scenarios"));
  entry.make = [pulses](const Parameters& parameters) {
    CommonViewSettings settings;
    settings.two_way = two_way_settings(parameters);
    settings.hull = two_way_hull_settings(parameters);
    settings.pulses.source = pulses;
    settings.pulses.window = from_ms(parameters.number("pulse_window_s") * 1e3);
    settings.pulses.settle = from_ms(parameters.number("settle_s") * 1e3);
    settings.asymmetry_sigma_us = parameters.number("asymmetry_sigma_us");
    return std::make_unique<CommonView>(settings);
  };
  return entry;
}

HostSyncEntry gnss() {
  HostSyncEntry entry;
  entry.info.name = "gnss";
  entry.info.family = "gnss";
  entry.info.summary = "every host, the master too, follows a GNSS receiver of its own";
  entry.info.source = "PPS and time of day of a receiver; theory";
  entry.info.needs = {Need::kPps, Need::kGnss};
  entry.info.parameters = {
      number_parameter("warm_up_s", 60, 1, 1e6, "how long the service has run before the capture",
                       kAssumption),
      number_parameter("window_s", 60, 4, 1e5, "span of the pulses that the line is fitted to",
                       "assumption: short against the wander of a quartz"),
  };
  for (ParameterSpec& spec : steering_parameters()) {
    entry.info.parameters.push_back(std::move(spec));
  }
  entry.make = [](const Parameters& parameters) {
    GnssSettings settings;
    settings.service_time = from_ms(parameters.number("warm_up_s") * 1e3);
    settings.window = from_ms(parameters.number("window_s") * 1e3);
    settings.steering = steering_settings(parameters);
    return std::make_unique<Gnss>(settings);
  };
  return entry;
}

}  // namespace

std::vector<HostSyncEntry> pulse_host_syncs() {
  return {
      common_view("common_view",
                  "two-way hull, its offset corrected by the pulses that all hosts see as frames",
                  "after TriggerSync; two_way_hull", PulseSource::kFrames, Need::kFrames),
      common_view("trigger_wired",
                  "two-way hull, its offset corrected by trigger pulses wired into each host",
                  "theory; two_way_hull", PulseSource::kTrigger, Need::kTriggerLine),
      common_view("pps", "two-way hull, its offset corrected by a PPS wired into each host",
                  "theory; two_way_hull", PulseSource::kPps, Need::kPps),
      gnss(),
  };
}

}  // namespace simbench

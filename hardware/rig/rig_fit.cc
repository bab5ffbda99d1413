// What a rig and a scenario must agree upon.
#include <fmt/format.h>

#include "hardware/rig/rig.h"
#include "scenarios/document.h"

namespace simbench::hardware {
namespace {

using scenarios::InputError;
using scenarios::Scenario;

[[noreturn]] void fail(const Rig& rig, const std::string& pointer, const std::string& problem) {
  throw InputError(fmt::format("{}: {}: {}", scenarios::shown_text(rig.file), pointer, problem));
}

std::string counted(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::vector<std::size_t> cameras_by_host(const Scenario& scenario) {
  std::vector<std::size_t> counts(static_cast<std::size_t>(scenario.hosts.count));
  for (std::int64_t camera = 0; camera < scenario.cameras.count; ++camera) {
    ++counts[static_cast<std::size_t>(scenario.host_of(camera))];
  }
  return counts;
}

void check_cameras(const Rig& rig, const Scenario& scenario) {
  const std::vector<std::size_t> wanted = cameras_by_host(scenario);
  for (std::size_t i = 0; i < rig.hosts.size(); ++i) {
    const std::size_t found = rig.hosts[i].cameras.size();
    if (found == wanted[i]) continue;
    fail(rig, fmt::format("/hosts/{}/cameras", i),
         fmt::format("found {} on {}, allowed {}: as many as scenario {} has there",
                     counted(found, "camera"), rig.hosts[i].name, wanted[i], scenario.name));
  }
  std::int64_t camera = 0;
  for (std::size_t i = 0; i < rig.hosts.size(); ++i) {
    for (std::size_t j = 0; j < rig.hosts[i].cameras.size(); ++j, ++camera) {
      if (scenario.host_of(camera) == static_cast<std::int64_t>(i)) continue;
      fail(rig, fmt::format("/hosts/{}/cameras/{}", i, j),
           fmt::format("found camera {} on host {}, allowed only on host {}, where scenario {} has "
                       "it: a rig's cameras are numbered host by host",
                       camera, i, scenario.host_of(camera), scenario.name));
    }
  }
}

bool needs_trigger(const Scenario& scenario) {
  const std::string& mode = scenario.cameras.sync_mode;
  return mode == "genlock" || mode == "slave" || mode == "full_slave";
}

}  // namespace

void check_rig_fits(const Rig& rig, const Scenario& scenario) {
  if (static_cast<std::int64_t>(rig.hosts.size()) != scenario.hosts.count) {
    fail(rig, "/hosts",
         fmt::format("found {}, allowed {}: as many as scenario {} has",
                     counted(rig.hosts.size(), "host"), scenario.hosts.count, scenario.name));
  }
  check_cameras(rig, scenario);
  if (needs_trigger(scenario) && !rig.trigger) {
    fail(rig, "/trigger",
         fmt::format("found nothing, allowed \"manual\" or {{\"on_command\": ..., \"off_command\": "
                     "...}}: scenario {} has sync mode {}, whose cameras wait for a trigger",
                     scenario.name, scenario.cameras.sync_mode));
  }
}

}  // namespace simbench::hardware

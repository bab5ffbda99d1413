#include "scenarios/checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/loader.h"
#include "scenarios/rates.h"
#include "scenarios/studio_checks.h"

namespace simbench::scenarios {
namespace {

// Names become file names, table cells and command line arguments.
void check_name(const Scenario& scenario, const std::string& pointer, const std::string& name) {
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  };
  if (std::all_of(name.begin(), name.end(), is_allowed) && name.front() != '-') return;
  fail_at(scenario, pointer,
          fmt::format("found \"{}\", allowed letters, digits, '_', '-' and '.', no '-' in front",
                      shown_text(name)));
}

void check_hosts(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const std::int64_t hosts = scenario.hosts.count;
  if (cameras.host_of_camera.empty()) {
    const std::int64_t last = cameras.count - 1;
    if (scenario.host_of(last) < hosts) return;
    fail_at(scenario, "/cameras/cameras_per_host",
            fmt::format("found {}, which puts camera {} on host {}, allowed hosts are 0 to {} "
                        "(/hosts/count is {})",
                        cameras.cameras_per_host, last, scenario.host_of(last), hosts - 1, hosts));
  }
  if (cameras.host_of_camera.size() != static_cast<std::size_t>(cameras.count)) {
    fail_at(scenario, "/cameras/host_of_camera",
            fmt::format("found {} hosts, allowed none or one for each of the {} cameras",
                        cameras.host_of_camera.size(), cameras.count));
  }
  for (std::size_t j = 0; j < cameras.host_of_camera.size(); ++j) {
    if (cameras.host_of_camera[j] < hosts) continue;
    fail_at(scenario, fmt::format("/cameras/host_of_camera/{}", j),
            fmt::format("found {}, allowed 0 to {} (/hosts/count is {})", cameras.host_of_camera[j],
                        hosts - 1, hosts));
  }
}

void check_skews(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const std::size_t found = cameras.skew_of_camera_ppm.size();
  if (found == 0 || found == static_cast<std::size_t>(cameras.count)) return;
  fail_at(scenario, "/cameras/skew_of_camera_ppm",
          fmt::format("found {} skews, allowed none or one for each of the {} cameras", found,
                      cameras.count));
}

void check_quantiles(const Scenario& scenario, const std::string& pointer,
                     const std::vector<double>& table) {
  if (table.size() == 1) {
    fail_at(scenario, pointer,
            "found 1 number, allowed none or 2 to 1001, from the least to the largest");
  }
  const auto descent = std::is_sorted_until(table.begin(), table.end());
  if (descent == table.end()) return;
  fail_at(scenario, fmt::format("{}/{}", pointer, descent - table.begin()),
          fmt::format("found {}, allowed at least {}, the number before it: a table of quantiles "
                      "ascends",
                      *descent, *(descent - 1)));
}

void check_tables(const Scenario& scenario) {
  check_quantiles(scenario, "/network/latency_quantiles_ms", scenario.network.latency_quantiles_ms);
  check_quantiles(scenario, "/usb/delivery_quantiles_ms", scenario.usb.delivery_quantiles_ms);
  const Usb& usb = scenario.usb;
  if (!usb.delivery_quantiles_ms.empty() || usb.delivery_correlation == 0) return;
  fail_at(scenario, "/usb/delivery_correlation",
          fmt::format("found {}, allowed 0 without /usb/delivery_quantiles_ms",
                      usb.delivery_correlation));
}

void check_streams(const Scenario& scenario) {
  std::set<std::string> kinds;
  const std::vector<Stream>& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (kinds.insert(streams[i].kind).second) continue;
    fail_at(scenario, fmt::format("/cameras/streams/{}/kind", i),
            fmt::format("found a second \"{}\", allowed one stream of a kind", streams[i].kind));
  }
  if (kinds.count(scenario.evaluation.stream) == 0) {
    fail_at(scenario, "/evaluation/stream",
            fmt::format("found \"{}\", allowed \"{}\", the captured streams",
                        scenario.evaluation.stream, fmt::join(kinds, "\", \"")));
  }
}

void check_shutters(const Scenario& scenario) {
  const std::vector<Stream>& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (streams[i].shutter == "rolling" || streams[i].readout_ms == 0) continue;
    fail_at(scenario, fmt::format("/cameras/streams/{}/readout_ms", i),
            fmt::format("found {}, allowed 0: a global shutter exposes all rows at once",
                        streams[i].readout_ms));
  }
}

void check_auto_exposure(const Scenario& scenario) {
  // Shorter intervals would make more steps than a computer can hold.
  constexpr double kShortestIntervalMs = 1;
  const AutoExposure& automatic = scenario.cameras.auto_exposure;
  const double interval_ms = automatic.step_interval_exponential_ms;
  if (interval_ms > 0 && interval_ms < kShortestIntervalMs) {
    fail_at(scenario, "/cameras/auto_exposure/step_interval_exponential_ms",
            fmt::format("found {}, allowed 0 (no auto-exposure) or at least {}", interval_ms,
                        kShortestIntervalMs));
  }
  if (automatic.min_ms > automatic.max_ms) {
    fail_at(scenario, "/cameras/auto_exposure/min_ms",
            fmt::format("found {}, allowed at most /cameras/auto_exposure/max_ms, {}",
                        automatic.min_ms, automatic.max_ms));
  }
}

void check_faults(const Scenario& scenario) {
  // What each kind of fault needs; the rest of a Fault's members it may not state.
  struct Need {
    std::string_view kind;
    std::vector<std::string_view> members;
  };
  static const std::vector<Need> needs = {
      {"camera_vanishes", {"camera", "at_ms", "duration_ms"}},
      {"late_first_frame", {"camera", "duration_ms"}},
      {"clock_step", {"host", "at_ms", "step_ms"}},
      {"host_stops", {"host", "at_ms", "duration_ms"}},
      {"link_stops", {"host", "at_ms", "duration_ms"}},
  };
  const auto stated = nlohmann::json::parse(scenario.resolved_json).at("faults");
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const Fault& fault = scenario.faults[i];
    const std::string pointer = fmt::format("/faults/{}", i);
    const auto& members = std::find_if(needs.begin(), needs.end(), [&](const Need& need) {
                            return need.kind == fault.kind;
                          })->members;
    for (const std::string_view member : members) {
      if (stated[i].contains(member)) continue;
      fail_at(scenario, fmt::format("{}/{}", pointer, member),
              fmt::format("found nothing, \"{}\" needs {}", fault.kind, fmt::join(members, ", ")));
    }
    for (const auto& [key, value] : stated[i].items()) {
      if (key == "kind" || std::find(members.begin(), members.end(), key) != members.end()) {
        continue;
      }
      fail_at(scenario, fmt::format("{}/{}", pointer, key),
              fmt::format("found {}, \"{}\" uses {} alone", value.dump(), fault.kind,
                          fmt::join(members, ", ")));
    }
    if (fault.camera >= scenario.cameras.count) {
      fail_at(scenario, pointer + "/camera",
              fmt::format("found {}, allowed 0 to {} (/cameras/count is {})", fault.camera,
                          scenario.cameras.count - 1, scenario.cameras.count));
    }
    if (fault.host >= scenario.hosts.count) {
      fail_at(scenario, pointer + "/host",
              fmt::format("found {}, allowed 0 to {} (/hosts/count is {})", fault.host,
                          scenario.hosts.count - 1, scenario.hosts.count));
    }
  }
}

template <class Result>
void check_published(const Scenario& scenario, const std::string& pointer,
                     const std::map<std::string, Result>& published,
                     const std::vector<std::string>& pipelines) {
  for (const auto& [name, result] : published) {
    if (std::find(pipelines.begin(), pipelines.end(), name) != pipelines.end()) continue;
    const std::vector<std::string> similar = nearest(name, pipelines);
    fail_at(
        scenario, child_pointer(pointer, name),
        similar.empty()
            ? fmt::format("found no such pipeline, allowed {}", fmt::join(pipelines, ", "))
            : fmt::format("found no such pipeline, did you mean {}?", fmt::join(similar, " or ")));
  }
}

void check_pipelines(const Scenario& scenario) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scenario.pipelines.size(); ++i) {
    const std::string& name = scenario.pipelines[i].name;
    const std::string pointer = fmt::format("/pipelines/{}/name", i);
    check_name(scenario, pointer, name);
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      fail_at(scenario, pointer,
              fmt::format("found a second \"{}\", allowed a name for each pipeline", name));
    }
    names.push_back(name);
  }
  check_published(scenario, "/published", scenario.published, names);
  if (scenario.studio) {
    check_published(scenario, "/studio/published", scenario.studio->published, names);
  }
}

}  // namespace

void check(const Scenario& scenario) {
  check_name(scenario, "/name", scenario.name);
  check_hosts(scenario);
  check_skews(scenario);
  check_tables(scenario);
  check_streams(scenario);
  check_rates(scenario);
  check_shutters(scenario);
  check_auto_exposure(scenario);
  check_faults(scenario);
  check_pipelines(scenario);
  check_studio(scenario);
}

}  // namespace simbench::scenarios

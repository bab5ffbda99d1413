#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/camera_checks.h"
#include "scenarios/camera_profile.h"
#include "scenarios/document.h"
#include "scenarios/frame_control_checks.h"
#include "scenarios/law_checks.h"
#include "scenarios/load_checks.h"
#include "scenarios/loader.h"
#include "scenarios/published_checks.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema.h"
#include "scenarios/schema_walk.h"
#include "scenarios/trigger_code.h"
#include "scenarios/wifi_checks.h"

namespace simbench::scenarios {
namespace {

// Names become file names, table cells and command line arguments.
// A pipeline may be named by its parts, as in chrony+hull_300+yoon2021.
void check_name(const Scenario& scenario, const std::string& pointer, const std::string& name,
                bool takes_plus = false) {
  const auto is_allowed = [takes_plus](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || (takes_plus && c == '+');
  };
  const bool starts_well = name.front() != '-' && name.front() != '+';
  if (std::all_of(name.begin(), name.end(), is_allowed) && starts_well) return;
  fail_at(
      scenario, pointer,
      fmt::format("found \"{}\", allowed letters, digits, '_', '-'{} and '.', no '-'{} in front",
                  shown_text(name), takes_plus ? ", '+'" : "", takes_plus ? " or '+'" : ""));
}

// `found` values where there may be none or one for each of the `count` things.
void check_size(const Scenario& scenario, const std::string& pointer, std::size_t found,
                std::string_view values, std::int64_t count, std::string_view things) {
  if (found == 0 || found == static_cast<std::size_t>(count)) return;
  fail_at(scenario, pointer,
          fmt::format("found {} {}, allowed none or one for each of the {} {}", found, values,
                      count, things));
}

// Scores keep some 20 bytes of each evaluated frame: half a gigabyte.
constexpr std::int64_t kMostEvaluatedFrames = 25'000'000;

void check_frames(const Scenario& scenario) {
  const std::int64_t most = kMostEvaluatedFrames / scenario.cameras.count;
  if (scenario.timeline.frames <= most) return;
  fail_at(
      scenario, "/timeline/frames",
      fmt::format("found {}, allowed at most {} of {} cameras (of all together {})",
                  scenario.timeline.frames, most, scenario.cameras.count, kMostEvaluatedFrames));
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
  check_size(scenario, "/cameras/host_of_camera", cameras.host_of_camera.size(), "hosts",
             cameras.count, "cameras");
}

// Lists with a value for each camera.
void check_lists_of_cameras(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  check_size(scenario, "/cameras/skew_of_camera_ppm", cameras.skew_of_camera_ppm.size(), "skews",
             cameras.count, "cameras");
  check_size(scenario, "/trigger/delay_of_camera_us", scenario.trigger.delay_of_camera_us.size(),
             "delays", cameras.count, "cameras");
  const char* const epochs = "/cameras/stamp_epoch_of_camera_s";
  check_size(scenario, epochs, cameras.stamp_epoch_of_camera_s.size(), "epochs", cameras.count,
             "cameras");
  if (cameras.stamp_epoch_of_camera_s.empty() || cameras.stamp_clock == ClockOwner::kHost) return;
  fail_at(
      scenario, epochs,
      "found epochs, allowed none where /cameras/stamp_clock is \"camera\": such a clock begins "
      "anywhere (/cameras/clock_epoch_max_ms)");
}

void check_host_clocks(const Scenario& scenario) {
  const Hosts& hosts = scenario.hosts;
  const std::vector<double>& skews_ppm = hosts.clock.skew_of_host_ppm;
  const std::vector<double>& offsets_ms = hosts.clock.initial_offset_of_host_ms;
  check_size(scenario, "/hosts/clock/skew_of_host_ppm", skews_ppm.size(), "skews", hosts.count,
             "hosts");
  check_size(scenario, "/hosts/clock/initial_offset_of_host_ms", offsets_ms.size(), "offsets",
             hosts.count, "hosts");
  if (hosts.master_is_exact && !skews_ppm.empty() && skews_ppm.front() != 0) {
    fail_at(scenario, "/hosts/clock/skew_of_host_ppm/0",
            fmt::format("found {}, allowed 0: the master is exact (/hosts/master_is_exact)",
                        skews_ppm.front()));
  }
  if (!offsets_ms.empty() && offsets_ms.front() != 0) {
    fail_at(scenario, "/hosts/clock/initial_offset_of_host_ms/0",
            fmt::format("found {}, allowed 0: the master's clock is the reference, it reads 0 at "
                        "true zero",
                        offsets_ms.front()));
  }
}

// The latency is a table: then a link has none of its own.
void check_no_latency(const Scenario& scenario, const std::string& pointer,
                      const std::optional<double>& latency_ms) {
  if (!latency_ms) return;
  fail_at(scenario, pointer,
          fmt::format("found {}, allowed nothing where /network/latency_quantiles_ms has the "
                      "latency of every link",
                      *latency_ms));
}

// Neither way of a link may be shorter than none.
void check_asymmetry(const Scenario& scenario, const std::string& pointer, const Link& link) {
  const Network& network = scenario.network;
  const double fixed_ms = network.latency_quantiles_ms.empty()
                              ? link.latency_fixed_ms.value_or(network.latency_fixed_ms)
                              : network.latency_quantiles_ms.front();
  const double found_ms = link.asymmetry_ms.value_or(0);
  if (std::abs(found_ms) <= 2 * fixed_ms) return;
  fail_at(scenario, pointer,
          fmt::format("found {}, allowed from {} to {}, twice the least latency of the link",
                      found_ms, -2 * fixed_ms, 2 * fixed_ms));
}

void check_links(const Scenario& scenario) {
  const std::vector<Link>& links = scenario.network.links;
  std::set<std::int64_t> hosts;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    const std::string pointer = fmt::format("/network/links/{}", i);
    if (link.host == 0 || link.host >= scenario.hosts.count) {
      fail_at(scenario, pointer + "/host",
              fmt::format("found {}, allowed a slave, whose link with the master (host 0) this is: "
                          "from 1 on and below /hosts/count, {}",
                          link.host, scenario.hosts.count));
    }
    if (!hosts.insert(link.host).second) {
      fail_at(scenario, pointer + "/host",
              fmt::format("found a second link of host {}, allowed one of each slave with the "
                          "master",
                          link.host));
    }
    if (!scenario.network.latency_quantiles_ms.empty()) {
      check_no_latency(scenario, pointer + "/latency_fixed_ms", link.latency_fixed_ms);
      check_no_latency(scenario, pointer + "/latency_exponential_ms", link.latency_exponential_ms);
    }
    check_asymmetry(scenario, pointer + "/asymmetry_ms", link);
  }
}

void check_cpu_load(const Scenario& scenario) {
  if (!scenario.hosts.cpu_load) return;
  const CpuLoad& load = *scenario.hosts.cpu_load;
  check_delay_law(scenario, "/hosts/cpu_load/cold_transmit", load.cold_transmit);
  check_delay_law(scenario, "/hosts/cpu_load/cold_wake_up", load.cold_wake_up);
  check_delay_law(scenario, "/hosts/cpu_load/wake_up", load.wake_up);
  check_delay_law(scenario, "/hosts/cpu_load/receive", load.receive);
}

void check_io_load(const Scenario& scenario) {
  if (!scenario.hosts.io_load) return;
  check_delay_law(scenario, "/hosts/io_load/receive", scenario.hosts.io_load->receive);
  check_delay_law(scenario, "/hosts/io_load/wake_up", scenario.hosts.io_load->wake_up);
}

void check_stack(const Scenario& scenario) {
  if (!scenario.hosts.stack) return;
  const Stack& stack = *scenario.hosts.stack;
  check_delay_law(scenario, "/hosts/stack/transmit", stack.transmit);
  check_delay_law(scenario, "/hosts/stack/transmit_to_card", stack.transmit_to_card);
  check_delay_law(scenario, "/hosts/stack/receive", stack.receive);
  check_delay_law(scenario, "/hosts/stack/wake_up", stack.wake_up);
}

void check_radio_laws(const Scenario& scenario) {
  const std::optional<Wifi>& wifi = scenario.network.wifi;
  if (wifi && wifi->tsf) {
    check_delay_law(scenario, "/network/wifi/tsf/read_before", wifi->tsf->read_before);
    check_delay_law(scenario, "/network/wifi/tsf/read_after", wifi->tsf->read_after);
  }
  if (wifi && wifi->ftm) {
    check_delay_law(scenario, "/network/wifi/ftm/counter_before", wifi->ftm->counter_before);
    check_delay_law(scenario, "/network/wifi/ftm/counter_after", wifi->ftm->counter_after);
  }
}

void check_switches(const Scenario& scenario) {
  const Network& network = scenario.network;
  check_size(scenario, "/network/switch_of_host", network.switch_of_host.size(), "switches",
             scenario.hosts.count, "hosts");
  if (network.cross_traffic_share == 0 || network.bandwidth_mbit_per_s > 0) return;
  fail_at(scenario, "/network/cross_traffic_share",
          fmt::format("found {}, allowed 0 where /network/bandwidth_mbit_per_s is 0 (infinite)",
                      network.cross_traffic_share));
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
  std::set<std::string_view> kinds;  // in alphabetical order
  const std::vector<Stream>& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (kinds.insert(to_text(streams[i].kind)).second) continue;
    fail_at(scenario, fmt::format("/cameras/streams/{}/kind", i),
            fmt::format("found a second \"{}\", allowed one stream of a kind",
                        to_text(streams[i].kind)));
  }
  if (scenario.scored_stream() == nullptr) {
    fail_at(scenario, "/evaluation/stream",
            fmt::format("found \"{}\", allowed \"{}\", the captured streams",
                        to_text(scenario.evaluation.stream), fmt::join(kinds, "\", \"")));
  }
}

void check_shutters(const Scenario& scenario) {
  const std::vector<Stream>& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (streams[i].shutter == ShutterKind::kRolling || streams[i].readout_ms == 0) continue;
    fail_at(scenario, fmt::format("/cameras/streams/{}/readout_ms", i),
            fmt::format("found {}, allowed 0: a global shutter exposes all rows at once",
                        streams[i].readout_ms));
  }
}

// A measured value and where it was measured belong together. `pointer` is of the object with both.
void check_stated_together(const Scenario& scenario, const std::string& pointer,
                           const std::string& value, bool is_stated, bool has_place) {
  if (is_stated == has_place) return;
  const std::string& missing = is_stated ? "calibrated_at" : value;
  fail_at(scenario, pointer + '/' + (is_stated ? value : "calibrated_at"),
          fmt::format("found no {} beside it, allowed both (a calibration holds where it was "
                      "measured) or neither (it is computed for this world)",
                      missing));
}

// `member` of the calibration's place, and of this world.
template <class Number>
void check_calibrated_at(const Scenario& scenario, const std::string& pointer,
                         std::string_view member, Number calibrated, Number present) {
  if (calibrated == present) return;
  fail_at(
      scenario, fmt::format("{}/calibrated_at/{}", pointer, member),
      fmt::format("found {}, allowed {}, {}/{}: a calibration holds where it was measured; null "
                  "in its place is computed for this world",
                  calibrated, present, pointer, member));
}

void check_calibrations(const Scenario& scenario) {
  const std::vector<Stream>& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const Stream& stream = streams[i];
    const std::string pointer = fmt::format("/cameras/streams/{}", i);
    const std::optional<StreamMode>& at = stream.calibrated_at;
    check_stated_together(scenario, pointer, "calibrated_delay_ms",
                          stream.calibrated_delay_ms.has_value(), at.has_value());
    if (!at) continue;
    check_calibrated_at(scenario, pointer, "width", at->width, stream.width);
    check_calibrated_at(scenario, pointer, "height", at->height, stream.height);
    check_calibrated_at(scenario, pointer, "mode_rate_hz", at->mode_rate_hz, stream.mode_rate_hz);
  }
  const ClockPoll& polls = scenario.cameras.clock_poll;
  const std::string pointer = "/cameras/clock_poll";
  check_stated_together(scenario, pointer, "calibrated_asymmetry_ms",
                        polls.calibrated_asymmetry_ms.has_value(), polls.calibrated_at.has_value());
  if (!polls.calibrated_at) return;
  check_calibrated_at(scenario, pointer, "request_ms", polls.calibrated_at->request_ms,
                      polls.request_ms);
  check_calibrated_at(scenario, pointer, "reply_ms", polls.calibrated_at->reply_ms, polls.reply_ms);
}

void check_auto_exposure(const Scenario& scenario) {
  const AutoExposure& automatic = scenario.cameras.auto_exposure;
  if (automatic.min_ms <= automatic.max_ms) return;
  fail_at(scenario, "/cameras/auto_exposure/min_ms",
          fmt::format("found {}, allowed at most /cameras/auto_exposure/max_ms, {}",
                      automatic.min_ms, automatic.max_ms));
}

// A fault must state the members of its kind, and no others.
void check_members(const Scenario& scenario, const std::string& pointer,
                   const nlohmann::ordered_json& kinds, const nlohmann::json& stated) {
  const auto kind = stated.at("kind").get<std::string>();
  const auto members = kinds.at(kind).at("needs").get<std::vector<std::string>>();
  for (const std::string& member : members) {
    if (stated.contains(member)) continue;
    fail_at(scenario, fmt::format("{}/{}", pointer, member),
            fmt::format("found nothing, \"{}\" needs {}", kind, fmt::join(members, ", ")));
  }
  for (const auto& [key, value] : stated.items()) {
    if (key == "kind" || std::find(members.begin(), members.end(), key) != members.end()) continue;
    fail_at(scenario, fmt::format("{}/{}", pointer, key),
            fmt::format("found {}, \"{}\" uses {} alone", value.dump(), kind,
                        fmt::join(members, ", ")));
  }
}

void check_faults(const Scenario& scenario, const nlohmann::json& document) {
  const nlohmann::json& faults = document.at("faults");
  const auto& kinds = ordered_schema().at("/properties/faults/items/x-kinds"_json_pointer);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    check_members(scenario, fmt::format("/faults/{}", i), kinds, faults[i]);
  }
}

// What the schema says of a value beside its own range: that it is below another member
// ("x-below"), or 0 or at least so much ("x-zero-or-from").
void check_values(const Scenario& scenario, const nlohmann::json& document) {
  for_each_value(
      "", ordered_schema(), document,
      [&](const std::string& pointer, const nlohmann::ordered_json& node,
          const nlohmann::json& value) {
        if (node.contains("x-below")) {
          const auto below = node["x-below"].get<std::string>();
          const auto count = document.at(nlohmann::json::json_pointer(below)).get<std::int64_t>();
          if (value < count) return;
          fail_at(scenario, pointer,
                  fmt::format("found {}, allowed 0 to {} ({} is {})", value.dump(), count - 1,
                              below, count));
        }
        if (node.contains("x-zero-or-from")) {
          const nlohmann::ordered_json& allowed = node["x-zero-or-from"];
          const auto found = value.get<double>();
          if (found == 0 || found >= allowed["from"].get<double>()) return;
          fail_at(scenario, pointer,
                  fmt::format("found {}, allowed 0 ({}) or at least {}", found,
                              allowed["zero"].get<std::string>(), allowed["from"].dump()));
        }
      });
}

// A name in a host's folder, or below it; none that leads out or is hidden.
bool is_file_name(const std::string& name) {
  if (name.empty() || name.front() == '/' || name.back() == '/') return false;
  for (const auto& part : std::filesystem::path(name)) {
    if (part.string().starts_with(".")) return false;
  }
  return name.find("//") == std::string::npos;
}

// Files of the host's folder, variables that leave the loader alone, paths that do not depend on
// where simbench runs.
void check_programs(const Scenario& scenario, const std::string& pointer,
                    const HostPrograms& programs) {
  for (const auto& [name, content] : programs.files) {
    if (!is_file_name(name)) {
      fail_at(scenario, child_pointer(pointer + "/files", name),
              fmt::format("found \"{}\", allowed: a path within the host's folder, such as "
                          "\"ntp.conf\" or \"etc/ntp.conf\", no part of which begins with a dot",
                          shown_text(name)));
    }
  }
  for (const auto& [name, value] : programs.environment) {
    if (name.empty() || name.find('=') != std::string::npos || name.starts_with("LD_") ||
        name.starts_with("SIMBENCH_")) {
      fail_at(scenario, child_pointer(pointer + "/environment", name),
              fmt::format("found \"{}\", allowed: a name without \"=\" that does not begin with "
                          "LD_ or SIMBENCH_",
                          shown_text(name)));
    }
  }
  for (std::size_t i = 0; i < programs.readable.size(); ++i) {
    if (programs.readable[i].starts_with('/')) continue;
    fail_at(
        scenario, fmt::format("{}/readable/{}", pointer, i),
        fmt::format("found \"{}\", allowed: an absolute path", shown_text(programs.readable[i])));
  }
}

void check_pipelines(const Scenario& scenario) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scenario.pipelines.size(); ++i) {
    const std::string& name = scenario.pipelines[i].name;
    const std::string pointer = fmt::format("/pipelines/{}/name", i);
    check_name(scenario, pointer, name, /*takes_plus=*/true);
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      fail_at(scenario, pointer,
              fmt::format("found a second \"{}\", allowed a name for each pipeline", name));
    }
    names.push_back(name);
    if (const std::optional<HostPrograms>& programs = scenario.pipelines[i].programs) {
      check_programs(scenario, fmt::format("/pipelines/{}/host_sync/program", i), *programs);
    }
  }
  check_published(scenario);
}

constexpr double kFullCircleDeg = 360;

// The depth stream's profile must have a focal length.
void check_depth_stream(const Scenario& scenario) {
  const Stream* depth = scenario.cameras.stream(StreamKind::kDepth);
  if (depth == nullptr) {
    fail_at(scenario, "/studio",
            "found a studio without a depth stream in /cameras/streams, allowed null");
  }
  const CameraProfile* camera = find_camera_profile(scenario.cameras.model);
  if (camera->stream(StreamKind::kDepth)->find_size(depth->width, depth->height)->focal_px > 0)
    return;
  fail_at(scenario, "/studio",
          fmt::format("found a studio with depth images of {}x{}, whose focal length the profile "
                      "of the {} does not state",
                      depth->width, depth->height, camera->name));
}

void check_room(const Scenario& scenario) {
  const Studio& studio = *scenario.studio;
  const auto heights = static_cast<std::int64_t>(studio.heights_m.size());
  const std::int64_t azimuths = (scenario.cameras.count + heights - 1) / heights;
  const double widest_deg = kFullCircleDeg / static_cast<double>(azimuths);
  if (studio.azimuth_step_deg <= widest_deg) return;
  fail_at(
      scenario, "/studio/azimuth_step_deg",
      fmt::format("found {}, allowed at most {:.4g}: {} cameras at {} height(s) need {} angles",
                  studio.azimuth_step_deg, widest_deg, scenario.cameras.count, heights, azimuths));
}

void check_subject(const Scenario& scenario) {
  const StudioSubject& subject = scenario.studio->subject;
  if (subject.kind == SubjectKind::kMesh && subject.mesh_file.empty()) {
    fail_at(scenario, "/studio/subject/mesh_file",
            "found \"\", allowed the path of a PLY, OBJ, OFF or STL file: the subject is a mesh");
  }
  if (subject.kind == SubjectKind::kPerson && !subject.mesh_file.empty()) {
    fail_at(scenario, "/studio/subject/mesh_file",
            fmt::format("found \"{}\", allowed \"\": the subject is a person",
                        shown_text(subject.mesh_file)));
  }
}

void check_studio(const Scenario& scenario) {
  if (!scenario.studio) return;
  check_depth_stream(scenario);
  check_room(scenario);
  check_subject(scenario);
  const Studio& studio = *scenario.studio;
  if (studio.min_distance_m < studio.max_distance_m) return;
  fail_at(scenario, "/studio/min_distance_m",
          fmt::format("found {}, allowed less than /studio/max_distance_m, {}",
                      studio.min_distance_m, studio.max_distance_m));
}

}  // namespace

void check(const Scenario& scenario, const nlohmann::json& document) {
  check_name(scenario, "/name", scenario.name);
  check_faults(scenario, document);
  check_hosts(scenario);
  check_values(scenario, document);
  check_frames(scenario);
  check_host_clocks(scenario);
  check_lists_of_cameras(scenario);
  check_tables(scenario);
  check_links(scenario);
  check_switches(scenario);
  check_wifi(scenario);
  check_radio_laws(scenario);
  check_stack(scenario);
  check_cpu_load(scenario);
  check_io_load(scenario);
  check_load(scenario);
  check_streams(scenario);
  check_camera_models(scenario);
  check_trigger_code(scenario);
  check_shutters(scenario);
  check_calibrations(scenario);
  check_auto_exposure(scenario);
  check_frame_control(scenario);
  check_pipelines(scenario);
  check_studio(scenario);
}

}  // namespace simbench::scenarios

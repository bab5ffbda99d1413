#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/calibration.h"
#include "scenarios/camera_groups.h"
#include "scenarios/camera_profile.h"
#include "scenarios/changes.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"
#include "scenarios/schema.h"
#include "scenarios/units.h"

namespace simbench::scenarios {
namespace {

using nlohmann::ordered_json;

}  // namespace

// An ending comes before the shorter ones that it ends in.
std::string unit_in_name(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 32> kUnits = {{
      {"_rad_per_s", "rad/s"},
      {"_m_per_s", "m/s"},
      {"_ppb_per_sqrt_s", "ppb/sqrt(s)"},
      {"_ppb_per_k", "ppb/K"},
      {"_mbit_per_s", "Mbit/s"},
      {"_mb_per_s", "MB/s"},
      {"_ppm_per_hour", "ppm/h"},
      {"_ppm", "ppm"},
      {"_ppb", "ppb"},
      {"_hz", "Hz"},
      {"_ms", "ms"},
      {"_us", "us"},
      {"_ns", "ns"},
      {"_s", "s"},
      {"_k", "K"},
      {"_h", "h"},
      {"_hours", "h"},
      {"hours_ago", "h"},
      {"minutes_since_baseline", "min"},
      {"_bytes", "bytes"},
      {"bytes_per_pixel", "bytes"},
      {"_mode_periods", "mode periods"},
      {"_after_periods", "mode periods"},
      {"_periods", "frame periods"},
      {"_transfers", "transfer times"},
      {"_deg", "degrees"},
      {"_px", "pixels"},
      {"_cm", "cm"},
      {"_mm", "mm"},
      {"_m", "m"},
      {"width", "pixels"},
      {"height", "pixels"},
  }};
  for (const auto& [ending, unit] : kUnits) {
    if (name.ends_with(ending)) return std::string(unit);
  }
  return "";
}

namespace {

// The source of a value below /cameras in the profile of the camera model; "" if none.
std::string profile_source(const Cameras& cameras, const std::string& pointer,
                           const ordered_json* node) {
  const CameraProfile* camera = find_camera_profile(cameras.model);
  if (camera == nullptr) return "";
  if (pointer == "/cameras/model") {
    return fmt::format("profile of the {} (simbench list cameras)", camera->name);
  }
  if (pointer == "/cameras/sync_mode") return camera->sync_source;
  if (node == nullptr || !node->value("x-profile", false)) return "";
  for (const Stream& each : cameras.streams) {
    const StreamProfile* stream = camera->stream(each.kind);
    const auto place = fmt::format("/cameras/streams/{}/", &each - cameras.streams.data());
    if (stream != nullptr && pointer.starts_with(place)) return stream->source;
  }
  return "";
}

// Calibrations that are computed are parameters too: stated beside the others.
std::set<std::string> state_calibrations(const Scenario& scenario, ordered_json& document) {
  std::set<std::string> computed;
  const auto state = [&](const std::string& parent, const char* member, double value) {
    document[ordered_json::json_pointer(parent)][member] = value;
    computed.insert(child_pointer(parent, member));
  };
  const std::vector<Stream>& streams = scenario.cameras.streams;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (streams[i].calibrated_delay_ms || !scenario.cameras.groups.empty()) continue;
    state(fmt::format("/cameras/streams/{}", i), "calibrated_delay_ms",
          calibrated_delay_ms(scenario, streams[i]));
  }
  const ClockPoll& polls = scenario.cameras.clock_poll;
  if (!polls.calibrated_asymmetry_ms) {
    state("/cameras/clock_poll", "calibrated_asymmetry_ms", calibrated_asymmetry_ms(polls));
  }
  return computed;
}

class Walker {
 public:
  // `computed`: the pointers of values that are not stated.
  Walker(const Scenario& scenario, std::set<std::string> computed)
      : cameras_(scenario.cameras),
        derivation_(scenario.derivation),
        places_(dynamic_cast<const Places&>(*scenario.origin)),
        computed_(std::move(computed)) {}

  void walk(const std::string& pointer, std::string_view name, const ordered_json* node,
            const ordered_json& value) {
    if (!value.is_structured() || value.empty() || is_table(value)) {
      add(pointer, name, node, value);
      return;
    }
    for (const auto& [key, member] : value.items()) {
      walk(child_pointer(pointer, key), value.is_array() ? name : key,
           node == nullptr ? nullptr : schema_of_child(*node, key), member);
    }
  }

  std::vector<ParameterLine> take() { return std::move(lines_); }

 private:
  void add(const std::string& pointer, std::string_view name, const ordered_json* node,
           const ordered_json& value) {
    ParameterLine line;
    line.pointer = pointer;
    line.value = value_text(value);
    line.unit = unit_in_name(name);
    if (node != nullptr) {
      line.meaning = node->value("description", "");
      line.source = node->value("x-source", "");
    }
    if (computed_.contains(pointer)) {
      line.source = "computed for this world (scenarios/calibration.h)";
      return lines_.push_back(std::move(line));
    }
    const std::string profile = profile_source(cameras_, pointer, node);
    if (!profile.empty()) line.source = profile;
    if (!places_.nearest(pointer).profile_source.empty()) {
      line.source = places_.nearest(pointer).profile_source;
      return lines_.push_back(std::move(line));
    }
    // The distribution's source does not hold for the user's values.
    const Place& place = places_.nearest(pointer);
    if (!place.is_builtin) {
      line.source =
          profile.empty() ? place.label : fmt::format("{}; offered: {}", place.label, profile);
    }
    if (name == "published" && line.source.empty()) line.source = unpublished_text(derivation_);
    lines_.push_back(std::move(line));
  }

  const Cameras& cameras_;
  const Derivation& derivation_;
  const Places& places_;
  std::set<std::string> computed_;
  std::vector<ParameterLine> lines_;
};

}  // namespace

std::string world_text(const Scenario& scenario) {
  std::string text =
      fmt::format("Cameras: {}, hosts: {}, frames: {}, sync mode {}, trigger at {} Hz",
                  scenario.cameras.count, scenario.hosts.count, scenario.timeline.frames,
                  to_text(scenario.cameras.sync_mode), scenario.trigger.rate_hz);
  for (std::size_t group = 0; group < group_count(scenario.cameras); ++group) {
    const Scenario alone = group_alone(scenario, group);
    const Stream* const stream = alone.scored_stream();
    if (stream == nullptr) break;
    text += scenario.cameras.groups.empty()
                ? ", "
                : fmt::format(", {} of {}: ", alone.cameras.count, alone.cameras.model);
    text += fmt::format("{} of {} x {} at {} Hz", to_text(stream->kind), stream->width,
                        stream->height, alone.frame_rate_hz(*stream));
  }
  return text + ".";
}

std::vector<ParameterLine> describe(const Scenario& scenario) {
  ordered_json document = ordered_json::parse(scenario.resolved_json());
  Walker walker(scenario, state_calibrations(scenario, document));
  walker.walk("", "", &ordered_schema(), document);
  return walker.take();
}

}  // namespace simbench::scenarios

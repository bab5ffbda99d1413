#include "scenarios/camera_profile.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/lazy.h"
#include "scenarios/scenario_json.h"

namespace simbench::scenarios {

using nlohmann::json;

// An unknown focal length is left out; the schema requires the rest.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(ImageSize, width, height, focal_px, rates_hz)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StreamProfile, kind, format, shutter, readout_periods,
                                   bytes_per_pixel, sizes, source)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(SyncModeProfile, mode, triggered, begins_at_pulse)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameControlProfile, adjust_frame, insert_frame, frame_length,
                                   start_at, source)

namespace {

StampProfile stamp_of(const json& in) {
  const json& wraps = in.at("wraps_after_s");
  return {.stamp = in.at("stamp"),
          .clock = in.at("clock"),
          .unit = in.at("unit"),
          .wraps_after_s = wraps.is_null() ? std::nullopt : std::optional(wraps.get<double>()),
          .meaning = in.at("meaning"),
          .source = in.at("source")};
}

CameraProfile profile_of(const json& in) {
  CameraProfile profile;
  in.at("model").get_to(profile.model);
  in.at("name").get_to(profile.name);
  in.at("maker").get_to(profile.maker);
  in.at("streams").get_to(profile.streams);
  const json& sync = in.at("sync");
  sync.at("modes").get_to(profile.sync_modes);
  sync.at("rates_hz").get_to(profile.sync_rates_hz);
  sync.at("wiring").get_to(profile.sync_wiring);
  sync.at("source").get_to(profile.sync_source);
  for (const json& stamp : in.at("stamps")) profile.stamps.push_back(stamp_of(stamp));
  const json& latency = in.at("latency");
  if (!latency.at("typical_ms").is_null()) {
    latency.at("typical_ms").get_to(profile.typical_latency_ms);
  }
  latency.at("source").get_to(profile.latency_source);
  if (const auto control = in.find("frame_control"); control != in.end()) {
    profile.frame_control = control->get<FrameControlProfile>();
  }
  return profile;
}

}  // namespace

const ImageSize* StreamProfile::find_size(std::int64_t width, std::int64_t height) const {
  const auto found = std::find_if(sizes.begin(), sizes.end(), [&](const ImageSize& size) {
    return size.width == width && size.height == height;
  });
  return found == sizes.end() ? nullptr : &*found;
}

const StreamProfile* CameraProfile::stream(StreamKind kind) const {
  const auto found = std::ranges::find(streams, kind, &StreamProfile::kind);
  return found == streams.end() ? nullptr : &*found;
}

const SyncModeProfile* CameraProfile::sync_mode(SyncMode mode) const {
  const auto found = std::ranges::find(sync_modes, mode, &SyncModeProfile::mode);
  return found == sync_modes.end() ? nullptr : &*found;
}

bool CameraProfile::triggers(SyncMode mode, StreamKind kind) const {
  const SyncModeProfile* found = sync_mode(mode);
  return found != nullptr && std::ranges::count(found->triggered, kind) > 0;
}

const CameraProfile* find_camera_profile(std::string_view model) {
  static const std::map<std::string_view, Lazy<CameraProfile>> profiles = [] {
    std::map<std::string_view, Lazy<CameraProfile>> all;
    for (const BuiltinFile& file : camera_files()) {
      all.emplace(file.name, [&file] { return profile_of(json::parse(file.text)); });
    }
    return all;
  }();
  const auto found = profiles.find(model);
  return found == profiles.end() ? nullptr : &found->second();
}

const std::vector<CameraProfile>& camera_profiles() {
  static const std::vector<CameraProfile> profiles = [] {
    std::vector<CameraProfile> all;
    for (const BuiltinFile& file : camera_files()) all.push_back(*find_camera_profile(file.name));
    return all;
  }();
  return profiles;
}

std::string camera_profiles_json() {
  auto all = nlohmann::ordered_json::array();
  for (const BuiltinFile& file : camera_files()) {
    auto profile = nlohmann::ordered_json::parse(file.text);
    profile.erase("$schema");
    all.push_back(std::move(profile));
  }
  return all.dump(2) + '\n';
}

}  // namespace simbench::scenarios

#include "hardware/realsense/realsense_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace simbench::hardware {
namespace {

using scenarios::SyncMode;

constexpr double kGenlockTolerance = 1.02;
constexpr std::size_t kNearestShown = 5;

// The value of Inter Cam Sync Mode and the first firmware that has it.
struct SyncOption {
  int value;
  const char* firmware;
};

SyncOption option_of(SyncMode mode) {
  switch (mode) {
    case SyncMode::kDefault:
      return {0, "5.9.15.1"};
    case SyncMode::kMaster:
      return {1, "5.9.15.1"};
    case SyncMode::kSlave:
      return {2, "5.9.15.1"};
    case SyncMode::kFullSlave:
      return {3, "5.12.4.0"};
    case SyncMode::kGenlock:
      return {4, "5.12.4.0"};
  }
  return {};
}

struct Profile {
  std::size_t sensor = 0;
  rs2::video_stream_profile profile;

  bool has_size_of(const scenarios::Stream& stream) const {
    return profile.width() == stream.width && profile.height() == stream.height;
  }
  bool fits(const scenarios::Stream& stream) const {
    return has_size_of(stream) && std::abs(profile.fps() - stream.mode_rate_hz) < 0.5;
  }
  std::string text() const {
    return fmt::format("{}x{} at {} Hz", profile.width(), profile.height(), profile.fps());
  }
  // The difference from the wanted stream, in size and in rate.
  double distance(const scenarios::Stream& stream) const {
    const double size = static_cast<double>(profile.width()) * profile.height();
    const double wanted = static_cast<double>(stream.width) * static_cast<double>(stream.height);
    return std::abs(std::log(std::max(size, 1.0) / std::max(wanted, 1.0))) +
           std::abs(std::log(std::max(1, profile.fps()) / std::max(stream.mode_rate_hz, 1.0)));
  }
};

std::vector<Profile> profiles_of(const std::vector<rs2::sensor>& sensors, rs2_stream type) {
  std::vector<Profile> result;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    for (const rs2::stream_profile& each : sensors[i].get_stream_profiles()) {
      if (each.stream_type() != type || !each.is<rs2::video_stream_profile>()) continue;
      result.push_back({i, each.as<rs2::video_stream_profile>()});
    }
  }
  return result;
}

[[noreturn]] void refuse_profile(const std::string& serial, const scenarios::Stream& stream,
                                 std::vector<Profile> profiles) {
  std::stable_sort(profiles.begin(), profiles.end(), [&](const Profile& a, const Profile& b) {
    return a.distance(stream) < b.distance(stream);
  });
  std::vector<std::string> nearest;
  for (const Profile& profile : profiles) {
    const std::string text = profile.text();
    if (nearest.size() == kNearestShown) break;
    if (std::find(nearest.begin(), nearest.end(), text) == nearest.end()) nearest.push_back(text);
  }
  const std::string allowed = nearest.empty()
                                  ? fmt::format("it has no {} stream", to_text(stream.kind))
                                  : fmt::format("the nearest it has: {}", fmt::join(nearest, ", "));
  throw CameraError(serial, fmt::format("no {} profile {}x{} at {} Hz, {}", to_text(stream.kind),
                                        stream.width, stream.height, stream.mode_rate_hz, allowed));
}

Profile choose_profile(const std::string& serial, const std::vector<rs2::sensor>& sensors,
                       const scenarios::Stream& stream) {
  const bool colour = stream.kind == StreamKind::kColour;
  const std::vector<Profile> all =
      profiles_of(sensors, colour ? RS2_STREAM_COLOR : RS2_STREAM_DEPTH);
  const rs2_format preferred = colour ? RS2_FORMAT_YUYV : RS2_FORMAT_Z16;
  const Profile* found = nullptr;
  for (const Profile& profile : all) {
    if (!profile.fits(stream)) continue;
    if (found == nullptr || profile.profile.format() == preferred) found = &profile;
    if (found->profile.format() == preferred) break;
  }
  if (found == nullptr) refuse_profile(serial, stream, all);
  return *found;
}

void set_option(const ChosenSensor& sensor, rs2_option option, float value) {
  if (sensor.sensor.get_option(option) != value) sensor.sensor.set_option(option, value);
}

void apply_sync_mode(const rs2::device& device, const CameraInfo& info,
                     const CameraSettings& settings) {
  const std::string_view mode = to_text(settings.sync_mode);
  const SyncOption option = option_of(settings.sync_mode);
  const std::string firmware = info.firmware.empty() ? "its firmware" : "firmware " + info.firmware;
  for (const rs2::sensor& sensor : device.query_sensors()) {
    if (!sensor.supports(RS2_OPTION_INTER_CAM_SYNC_MODE)) continue;
    const rs2::option_range range = sensor.get_option_range(RS2_OPTION_INTER_CAM_SYNC_MODE);
    if (static_cast<float>(option.value) > range.max) {
      throw CameraError(
          info.serial,
          fmt::format("sync mode {} is {} of Inter Cam Sync Mode, {} allows 0 to {}: it needs "
                      "firmware {} or newer (rs-fw-update) and a global shutter",
                      mode, option.value, firmware, range.max, option.firmware));
    }
    if (sensor.is_option_read_only(RS2_OPTION_INTER_CAM_SYNC_MODE)) {
      throw CameraError(info.serial,
                        fmt::format("sync mode {} cannot be set now: is the camera streaming in "
                                    "another program?",
                                    mode));
    }
    sensor.set_option(RS2_OPTION_INTER_CAM_SYNC_MODE, static_cast<float>(option.value));
    return;
  }
  if (option.value == 0) return;
  throw CameraError(info.serial,
                    fmt::format("sync mode {}: {} has no option Inter Cam Sync Mode; it needs "
                                "firmware {} or newer, and a D405 has none",
                                mode, firmware, option.firmware));
}

void apply_exposure(const ChosenSensor& sensor, const std::string& serial,
                    const CameraSettings& settings) {
  const rs2::sensor& device = sensor.sensor;
  if (device.supports(RS2_OPTION_ENABLE_AUTO_EXPOSURE)) {
    set_option(sensor, RS2_OPTION_ENABLE_AUTO_EXPOSURE, settings.auto_exposure ? 1.F : 0.F);
  } else if (settings.auto_exposure) {
    throw CameraError(serial, "auto exposure is wanted, and this camera cannot switch it on");
  }
  if (settings.auto_exposure) return;
  if (!device.supports(RS2_OPTION_EXPOSURE)) {
    throw CameraError(serial,
                      fmt::format("an exposure of {} ms is wanted, and this camera cannot set it",
                                  settings.exposure_ms));
  }
  const rs2::option_range range = device.get_option_range(RS2_OPTION_EXPOSURE);
  const double unit_ms = sensor.exposure_unit_us * 1e-3;
  const double value = std::round(settings.exposure_ms / unit_ms);
  if (value < range.min || value > range.max) {
    throw CameraError(serial,
                      fmt::format("found exposure {} ms, allowed {} to {}", settings.exposure_ms,
                                  range.min * unit_ms, range.max * unit_ms));
  }
  device.set_option(RS2_OPTION_EXPOSURE, static_cast<float>(value));
}

void check_trigger(const std::string& serial, const CameraSettings& settings) {
  if (settings.sync_mode != SyncMode::kGenlock) return;
  for (const scenarios::Stream& stream : settings.streams) {
    const double most_hz = stream.mode_rate_hz / 2;
    if (settings.trigger_rate_hz <= most_hz * kGenlockTolerance) continue;
    throw CameraError(
        serial,
        fmt::format("found triggers at {} Hz, allowed in genlock: at most {} Hz, half of "
                    "the {} mode's {} Hz",
                    settings.trigger_rate_hz, most_hz, to_text(stream.kind), stream.mode_rate_hz));
  }
}

}  // namespace

std::vector<ChosenSensor> choose_sensors(const rs2::device& device, const std::string& serial,
                                         const CameraSettings& settings) {
  if (settings.streams.empty()) throw CameraError(serial, "no stream is wanted");
  check_trigger(serial, settings);
  return guarded(serial, "reading its profiles", [&] {
    const std::vector<rs2::sensor> sensors = device.query_sensors();
    std::vector<std::optional<ChosenSensor>> chosen(sensors.size());
    for (const scenarios::Stream& stream : settings.streams) {
      const Profile profile = choose_profile(serial, sensors, stream);
      auto& sensor = chosen[profile.sensor];
      if (!sensor) {
        const rs2::sensor& handle = sensors[profile.sensor];
        const bool has_depth = !profiles_of({handle}, RS2_STREAM_DEPTH).empty();
        sensor = ChosenSensor{handle, {}, has_depth ? 1 : 100};
      }
      sensor->profiles.push_back(profile.profile);
    }
    std::vector<ChosenSensor> result;
    for (auto& sensor : chosen) {
      if (sensor) result.push_back(std::move(*sensor));
    }
    return result;
  });
}

void apply_settings(const rs2::device& device, const std::vector<ChosenSensor>& sensors,
                    const CameraInfo& info, const CameraSettings& settings) {
  guarded(info.serial, "setting its sync mode", [&] { apply_sync_mode(device, info, settings); });
  for (const ChosenSensor& sensor : sensors) {
    guarded(info.serial, "setting its exposure",
            [&] { apply_exposure(sensor, info.serial, settings); });
    guarded(info.serial, "switching global time off", [&] {
      if (!sensor.sensor.supports(RS2_OPTION_GLOBAL_TIME_ENABLED)) return;
      set_option(sensor, RS2_OPTION_GLOBAL_TIME_ENABLED, 0.F);
    });
  }
}

}  // namespace simbench::hardware

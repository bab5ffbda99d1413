#include "scenarios/camera_groups.h"

#include <algorithm>
#include <optional>

#include "scenarios/camera_profile.h"

namespace simbench::scenarios {
namespace {

template <class Value>
void replace(Value& value, const std::optional<Value>& stated) {
  if (stated) value = *stated;
}

// The group's part of a list with an element for each camera, or with none.
template <class Value>
void keep_part(std::vector<Value>& of_cameras, std::size_t first, std::size_t count) {
  if (of_cameras.empty()) return;
  of_cameras = {of_cameras.begin() + static_cast<std::ptrdiff_t>(first),
                of_cameras.begin() + static_cast<std::ptrdiff_t>(first + count)};
}

std::size_t first_camera(const Cameras& cameras, std::size_t group) {
  std::int64_t first = 0;
  for (std::size_t i = 0; i < group; ++i) first += cameras.groups[i].count;
  return static_cast<std::size_t>(first);
}

}  // namespace

std::size_t group_count(const Cameras& cameras) {
  return std::max<std::size_t>(1, cameras.groups.size());
}

std::vector<std::size_t> group_of_cameras(const Cameras& cameras) {
  std::vector<std::size_t> groups;
  for (std::size_t group = 0; group < cameras.groups.size(); ++group) {
    groups.insert(groups.end(), static_cast<std::size_t>(cameras.groups[group].count), group);
  }
  groups.resize(static_cast<std::size_t>(cameras.count), 0);
  return groups;
}

std::int64_t pulses_per_frame(const Cameras& cameras, std::size_t group) {
  return cameras.groups.empty() ? 1 : cameras.groups[group].pulses_per_frame;
}

Cameras cameras_of_group(const Cameras& cameras, std::size_t group) {
  if (cameras.groups.empty()) return cameras;
  const CameraGroup& own = cameras.groups[group];
  Cameras result = cameras;
  result.groups.clear();
  replace(result.model, own.model);
  replace(result.exposure_ms, own.exposure_ms);
  replace(result.trigger_to_exposure_us, own.trigger_to_exposure_us);
  replace(result.sensor_stamp_jitter_sigma_us, own.sensor_stamp_jitter_sigma_us);
  replace(result.oscillator.skew_sigma_ppm, own.skew_sigma_ppm);
  Stream& stream = result.streams.front();
  replace(stream.width, own.width);
  replace(stream.height, own.height);
  replace(stream.bytes_per_pixel, own.bytes_per_pixel);
  replace(stream.mode_rate_hz, own.mode_rate_hz);
  replace(stream.pipeline_latency_ms, own.pipeline_latency_ms);
  replace(stream.readout_ms, own.readout_ms);
  if (!own.model) return result;
  const CameraProfile* profile = find_camera_profile(*own.model);
  const StreamProfile* offered = profile == nullptr ? nullptr : profile->stream(stream.kind);
  if (offered != nullptr) stream.shutter = offered->shutter;
  if (stream.shutter == ShutterKind::kGlobal && !own.readout_ms) stream.readout_ms = 0;
  return result;
}

Scenario group_alone(const Scenario& scenario, std::size_t group) {
  if (scenario.cameras.groups.empty()) return scenario;
  const std::size_t first = first_camera(scenario.cameras, group);
  const auto count = static_cast<std::size_t>(scenario.cameras.groups[group].count);
  Scenario result = scenario;
  Cameras& cameras = result.cameras = cameras_of_group(scenario.cameras, group);
  cameras.count = scenario.cameras.groups[group].count;
  cameras.host_of_camera.clear();
  for (std::size_t camera = first; camera < first + count; ++camera) {
    cameras.host_of_camera.push_back(scenario.host_of(static_cast<std::int64_t>(camera)));
  }
  // A trigger of its own rate; exposures keep what the rig's period adds to them.
  const auto divider = static_cast<double>(pulses_per_frame(scenario.cameras, group));
  result.trigger.rate_hz /= divider;
  cameras.exposure_camera_periods /= divider;
  cameras.exposure_host_periods /= divider;
  keep_part(cameras.skew_of_camera_ppm, first, count);
  keep_part(cameras.stamp_epoch_of_camera_s, first, count);
  keep_part(result.trigger.delay_of_camera_us, first, count);
  return result;
}

}  // namespace simbench::scenarios

#include "evaluation/replay/replay.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "algorithms/registry.h"
#include "evaluation/replay/replay_rig.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {
namespace {

std::vector<DeviceSample> samples_of(const std::vector<StampedFrame>& frames) {
  std::vector<DeviceSample> samples;
  samples.reserve(frames.size());
  for (const StampedFrame& frame : frames) {
    samples.push_back({.sensor = DeviceTime(std::chrono::round<Microseconds>(frame.sensor)),
                       .arrival = HostTime(frame.arrival),
                       .arrival_steady = SteadyTime(frame.arrival),
                       .exposure_us = 0});
  }
  return samples;
}

void score(const std::vector<StampedFrame>& frames, bool relative, DeviceTimeReplay& row) {
  std::vector<double> sensor(frames.size());
  std::vector<double> offset(frames.size());
  std::vector<double> residual(frames.size());
  std::vector<double> jitter;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::int64_t global = nanoseconds_of(row.stamps[i]);
    sensor[i] = difference_ms(frames[i].sensor.count(), frames[0].sensor.count());
    offset[i] = difference_ms(global, nanoseconds_of(row.stamps[0])) - sensor[i];
    residual[i] = difference_ms(frames[i].arrival.count(), global);
    if (i > 0) jitter.push_back(offset[i] - offset[i - 1]);
  }
  row.jitter_ms = standard_deviation(jitter);
  if (relative) {
    row.residual = {kNan, kNan, kNan, kNan};
    row.drift_ppm = kNan;
    return;
  }
  row.residual = residual_statistics(std::move(residual));
  row.drift_ppm = fit_line(sensor, offset).slope * 1e6;
}

// An estimator may extrapolate damaged stamps to anything; the difference of two must not overflow.
GlobalTime limited(GlobalTime stamp) {
  constexpr GlobalTime kLargest{Nanoseconds((std::int64_t{1} << 62) - 1)};
  constexpr GlobalTime kSmallest{-kLargest.time_since_epoch()};
  return std::clamp(stamp, kSmallest, kLargest);
}

DeviceTimeReplay replay_estimator(const DeviceTimeEntry& entry, const CameraReplay& camera,
                                  const std::vector<DeviceSample>& samples, Nanoseconds anchor) {
  DeviceTimeReplay row;
  row.device_time = entry.info.name;
  const auto estimator = entry.make(check_parameters(entry.info.parameters, {}));
  if (estimator->offline()) estimator->learn(samples);
  const Nanoseconds shift = estimator->relative() ? anchor : Nanoseconds::zero();
  row.stamps.reserve(samples.size());
  for (const DeviceSample& sample : samples) {
    row.stamps.push_back(limited(estimator->stamp(sample) + shift));
  }
  score(camera.frames, estimator->relative(), row);
  return row;
}

// The earliest first arrival of the cameras of each kind of stream.
std::map<std::string, Nanoseconds> anchors_of(const std::vector<CameraReplay>& cameras) {
  std::map<std::string, Nanoseconds> anchors;
  for (const CameraReplay& camera : cameras) {
    const Nanoseconds first = camera.frames.front().arrival;
    const auto [anchor, is_new] = anchors.try_emplace(camera.stream, first);
    if (!is_new) anchor->second = std::min(anchor->second, first);
  }
  return anchors;
}

void warn(const CameraReplay& camera, std::vector<std::string>& warnings) {
  const CameraStatistics& found = camera.statistics;
  const std::string name = camera.camera + " " + camera.stream + ": ";
  if (found.backward_steps > 0) {
    warnings.push_back(name + "sensor stamps go back " + std::to_string(found.backward_steps) +
                       " times: frames were reordered, or the camera was started again");
  }
  if (found.frames < 2) {
    warnings.push_back(name + "has one frame: too few for a drift or a jitter");
  }
}

}  // namespace

Replay run_replay(std::vector<CameraStream> streams) {
  Replay replay;
  for (CameraStream& stream : streams) {
    CameraReplay camera;
    camera.camera = std::move(stream.camera);
    camera.host = std::move(stream.host);
    camera.stream = std::move(stream.stream);
    camera.frames = unwrapped(stream.frames);
    stream.frames = {};
    camera.statistics = camera_statistics(camera.frames);
    warn(camera, replay.warnings);
    replay.cameras.push_back(std::move(camera));
  }
  const std::map<std::string, Nanoseconds> anchors = anchors_of(replay.cameras);
  for (CameraReplay& camera : replay.cameras) {
    const std::vector<DeviceSample> samples = samples_of(camera.frames);
    for (const DeviceTimeEntry& entry : device_time_algorithms()) {
      if (!entry.make) continue;  // needs the truth
      camera.rows.push_back(replay_estimator(entry, camera, samples, anchors.at(camera.stream)));
    }
  }
  for (const auto& [stream, anchor] : anchors) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < replay.cameras.size(); ++i) {
      if (replay.cameras[i].stream == stream) members.push_back(i);
    }
    if (members.size() < 2) continue;
    std::optional<RigReplay> rig = replay_rig(replay.cameras, stream, members);
    if (!rig) {
      replay.warnings.push_back(stream + ": no camera has a frame period: they are not compared");
      continue;
    }
    replay.rigs.push_back(std::move(*rig));
    if (!replay.rigs.back().common_start_plausible) {
      replay.warnings.push_back(
          stream +
          ": the cameras' first frames lie more than half a period apart: without a common "
          "start, AMD and RMDV by GenLock order mean nothing");
    }
  }
  return replay;
}

}  // namespace simbench::evaluation

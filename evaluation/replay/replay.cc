#include "evaluation/replay/replay.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "algorithms/gathering/genlock_order.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

// T_int: "less than half a frame interval is sufficient" (paper).
constexpr std::int64_t kIntervalsPerPeriod = 2;

// A frame: the place of its camera in the rig and its place in the camera's recording.
struct FrameId {
  std::uint32_t source = 0;
  std::size_t frame = 0;
};

using Members = std::vector<const CameraReplay*>;

// Running means of the terms of AMD and RMDV.
class SetScore {
 public:
  void add(std::span<const std::int64_t> stamps) {
    spread_ += spread_ms(stamps);
    deviation_ += deviation_ms(stamps, MedianKind::kUpperMiddle, workspace_);
    ++count_;
  }
  std::int64_t count() const { return count_; }
  double amd_ms() const { return count_ ? spread_ / static_cast<double>(count_) : kNan; }
  double rmdv_ms() const { return count_ ? deviation_ / static_cast<double>(count_) : kNan; }

 private:
  double spread_ = 0;
  double deviation_ = 0;
  std::int64_t count_ = 0;
  std::vector<std::int64_t> workspace_;
};

std::optional<Nanoseconds> rig_period(const Members& members) {
  std::vector<double> periods;
  for (const CameraReplay* camera : members) {
    const Nanoseconds period = median_period(camera->frames);
    if (period >= Microseconds(1)) periods.push_back(to_ms(period));
  }
  return periods.empty() ? std::nullopt : std::optional(from_ms(median(periods)));
}

DeviceTime device_time_of(const StampedFrame& frame) {
  return DeviceTime(std::chrono::round<Microseconds>(frame.sensor));
}

// The frames of each pulse that every camera delivered, by GenLock order; source after source.
std::vector<FrameId> complete_pulses(const Members& members, Nanoseconds period) {
  struct Indexed {
    std::int64_t index;
    FrameId id;
  };
  std::vector<Indexed> all;
  for (std::uint32_t source = 0; source < members.size(); ++source) {
    GenlockOrder order(period, GenlockOrder::Variant::kReanchored);
    const std::vector<StampedFrame>& frames = members[source]->frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      all.push_back({order.next(device_time_of(frames[i])), {source, i}});
    }
  }
  std::sort(all.begin(), all.end(), [](const Indexed& a, const Indexed& b) {
    return std::tie(a.index, a.id.source, a.id.frame) < std::tie(b.index, b.id.source, b.id.frame);
  });
  // Two frames of a camera with one index: the first counts.
  const auto same = [](const Indexed& a, const Indexed& b) {
    return a.index == b.index && a.id.source == b.id.source;
  };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  std::vector<FrameId> complete;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].index == all[begin].index) ++end;
    if (end - begin != members.size()) continue;
    for (std::size_t i = begin; i < end; ++i) complete.push_back(all[i].id);
  }
  return complete;
}

// All frames in order of arrival. A camera's own frames stay in their order of delivery, even where
// the host's clock went back.
std::vector<FrameId> order_of_arrival(const Members& members) {
  struct Arrival {
    Nanoseconds latest;
    FrameId id;
  };
  std::vector<Arrival> all;
  for (std::uint32_t source = 0; source < members.size(); ++source) {
    Nanoseconds latest = Nanoseconds::min();
    const std::vector<StampedFrame>& frames = members[source]->frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      latest = std::max(latest, frames[i].arrival);
      all.push_back({latest, {source, i}});
    }
  }
  std::sort(all.begin(), all.end(), [](const Arrival& a, const Arrival& b) {
    return std::tie(a.latest, a.id.source, a.id.frame) <
           std::tie(b.latest, b.id.source, b.id.frame);
  });
  std::vector<FrameId> order;
  order.reserve(all.size());
  for (const Arrival& arrival : all) order.push_back(arrival.id);
  return order;
}

class ScoringSink : public FrameSetSink {
 public:
  void on_set(std::span<const GatherFrame> set) override {
    stamps_.clear();
    for (const GatherFrame& frame : set) stamps_.push_back(nanoseconds_of(frame.stamp));
    score_.add(stamps_);
  }
  const SetScore& score() const { return score_; }

 private:
  std::vector<std::int64_t> stamps_;
  SetScore score_;
};

GatheringReplay replay_gatherer(const GatheringEntry& entry, const Members& members,
                                std::size_t row, Nanoseconds period,
                                const std::vector<FrameId>& order) {
  const GatheringSetup setup = {.sources = static_cast<std::uint32_t>(members.size()),
                                .period = period,
                                .interval = period / kIntervalsPerPeriod};
  const auto gatherer = entry.make(check_parameters(entry.info.parameters, {}), setup);
  ScoringSink sink;
  for (const FrameId& id : order) {
    const CameraReplay& camera = *members[id.source];
    gatherer->push({.source = id.source,
                    .stamp = camera.rows[row].stamps[id.frame],
                    .sensor = device_time_of(camera.frames[id.frame]),
                    .tag = static_cast<std::int64_t>(id.frame)},
                   sink);
  }
  return {.gathering = entry.info.name,
          .sets = sink.score().count(),
          .discarded_frames = static_cast<std::int64_t>(gatherer->discarded()),
          .amd_ms = sink.score().amd_ms(),
          .rmdv_ms = sink.score().rmdv_ms()};
}

SetScore genlock_score(const Members& members, std::size_t row,
                       const std::vector<FrameId>& complete) {
  SetScore score;
  std::vector<std::int64_t> stamps;
  for (const FrameId& id : complete) {
    stamps.push_back(nanoseconds_of(members[id.source]->rows[row].stamps[id.frame]));
    if (stamps.size() < members.size()) continue;
    score.add(stamps);
    stamps.clear();
  }
  return score;
}

Nanoseconds first_arrival_range(const Members& members) {
  const auto [first, last] = std::minmax_element(
      members.begin(), members.end(), [](const CameraReplay* a, const CameraReplay* b) {
        return a->frames.front().arrival < b->frames.front().arrival;
      });
  return (*last)->frames.front().arrival - (*first)->frames.front().arrival;
}

// `members`: the cameras (two or more) that have `stream`; their rows are complete. Returns nothing
// if no camera has a frame period (of at least a microsecond) to match frames by.
std::optional<RigReplay> replay_rig(const std::vector<CameraReplay>& cameras,
                                    const std::string& stream,
                                    const std::vector<std::size_t>& members) {
  Members sources;
  for (const std::size_t index : members) sources.push_back(&cameras[index]);
  const std::optional<Nanoseconds> known_period = rig_period(sources);
  if (!known_period) return std::nullopt;
  const Nanoseconds period = *known_period;
  const Nanoseconds range = first_arrival_range(sources);
  const std::vector<FrameId> complete = complete_pulses(sources, period);
  const std::vector<FrameId> order = order_of_arrival(sources);

  RigReplay rig;
  rig.stream = stream;
  rig.cameras = members;
  rig.period_ms = to_ms(period);
  rig.complete_pulses = static_cast<std::int64_t>(complete.size() / sources.size());
  rig.first_arrival_range_ms = to_ms(range);
  rig.common_start_plausible = range < period / 2;
  for (std::size_t row = 0; row < sources.front()->rows.size(); ++row) {
    const SetScore score = genlock_score(sources, row, complete);
    RigRow result;
    result.device_time = sources.front()->rows[row].device_time;
    result.amd_ms = score.amd_ms();
    result.rmdv_ms = score.rmdv_ms();
    for (const GatheringEntry& entry : gathering_algorithms()) {
      if (std::ranges::count(entry.info.needs, Need::kTruth) > 0) continue;
      result.gatherings.push_back(replay_gatherer(entry, sources, row, period, order));
    }
    rig.rows.push_back(std::move(result));
  }
  return rig;
}

std::vector<DeviceSample> samples_of(const std::vector<StampedFrame>& frames) {
  std::vector<DeviceSample> samples;
  samples.reserve(frames.size());
  for (const StampedFrame& frame : frames) {
    samples.push_back({.sensor = device_time_of(frame),
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

// An estimator may extrapolate damaged stamps without limit; differences must not overflow.
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
    warnings.push_back(name + "sensor stamps go back " + times(found.backward_steps) +
                       ": frames were reordered, or the camera was restarted");
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
      replay.warnings.push_back(stream +
                                ": no camera has a frame period, so the cameras are not compared");
      continue;
    }
    replay.rigs.push_back(std::move(*rig));
    if (!replay.rigs.back().common_start_plausible) {
      replay.warnings.push_back(
          stream +
          ": the cameras' first frames lie more than half a period apart: without a common "
          "start, AMD and RMDV by GenLock order are meaningless");
    }
  }
  return replay;
}

}  // namespace simbench::evaluation

#include "evaluation/replay/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "algorithms/registry.h"
#include "evaluation/replay/rig_frames.h"
#include "evaluation/run/jobs.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"
#include "recording/counted.h"

namespace simbench::evaluation {
namespace {

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

// One estimator's stamps of every frame, by camera; none of a camera that is in no rig.
using AllStamps = std::vector<std::vector<GlobalTime>>;

GatheringReplay replay_gatherer(const GatheringEntry& entry, const RigFrames& rig,
                                const AllStamps& stamps) {
  const auto gatherer =
      entry.make(check_parameters(entry.info.parameters, {}), gathering_setup(rig));
  ScoringSink sink;
  for (const RigFrame& id : rig.order) {
    gatherer->push({.source = id.source,
                    .stamp = stamps[rig.cameras[id.source]][id.frame],
                    .sensor = device_time_of(rig.members[id.source]->frames[id.frame]),
                    .tag = static_cast<std::int64_t>(id.frame)},
                   sink);
  }
  return {.gathering = entry.info.name,
          .sets = sink.score().count(),
          .discarded_frames = static_cast<std::int64_t>(gatherer->discarded()),
          .amd_ms = sink.score().amd_ms(),
          .rmdv_ms = sink.score().rmdv_ms()};
}

SetScore genlock_score(const RigFrames& rig, const AllStamps& all) {
  SetScore score;
  std::vector<std::int64_t> stamps;
  for (const RigFrame& id : rig.complete) {
    stamps.push_back(nanoseconds_of(all[rig.cameras[id.source]][id.frame]));
    if (stamps.size() < rig.members.size()) continue;
    score.add(stamps);
    stamps.clear();
  }
  return score;
}

RigRow rig_row(const std::string& device_time, const RigFrames& rig, const AllStamps& stamps) {
  const SetScore score = genlock_score(rig, stamps);
  RigRow row;
  row.device_time = device_time;
  row.amd_ms = score.amd_ms();
  row.rmdv_ms = score.rmdv_ms();
  for (const GatheringEntry& entry : algorithms<GatheringEntry>()) {
    if (std::ranges::count(entry.info.needs, Need::kTruth) > 0) continue;
    row.gatherings.push_back(replay_gatherer(entry, rig, stamps));
  }
  return row;
}

Nanoseconds first_arrival_range(const RigMembers& members) {
  const auto [first, last] = std::minmax_element(
      members.begin(), members.end(), [](const CameraReplay* a, const CameraReplay* b) {
        return a->frames.front().arrival < b->frames.front().arrival;
      });
  return (*last)->frames.front().arrival - (*first)->frames.front().arrival;
}

RigReplay rig_replay(const std::string& stream, const RigFrames& rig) {
  const Nanoseconds range = first_arrival_range(rig.members);
  RigReplay replay;
  replay.stream = stream;
  replay.cameras = rig.cameras;
  replay.period_ms = to_ms(rig.period);
  replay.complete_pulses = static_cast<std::int64_t>(rig.complete.size() / rig.members.size());
  replay.first_arrival_range_ms = to_ms(range);
  replay.common_start_plausible = range < rig.period / 2;
  return replay;
}

DeviceSample sample_of(const StampedFrame& frame) {
  return {.sensor = device_time_of(frame),
          .arrival = HostTime(frame.arrival),
          .arrival_steady = SteadyTime(frame.arrival),
          .exposure_us = 0};
}

DeviceTimeReplay without_values(const std::string& device_time) {
  DeviceTimeReplay row;
  row.device_time = device_time;
  row.jitter_ms = row.drift_ppm = kNan;
  row.residual = {kNan, kNan, kNan, kNan};
  return row;
}

DeviceTimeReplay scored(const std::string& device_time, const std::vector<StampedFrame>& frames,
                        const std::vector<GlobalTime>& stamps, bool relative) {
  DeviceTimeReplay row = without_values(device_time);
  std::vector<double> offset(frames.size());
  {
    std::vector<double> sensor(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      sensor[i] = difference_ms(frames[i].sensor.count(), frames[0].sensor.count());
      offset[i] = difference_ms(nanoseconds_of(stamps[i]), nanoseconds_of(stamps[0])) - sensor[i];
    }
    if (!relative) row.drift_ppm = fit_line(sensor, offset).slope * 1e6;
  }
  for (std::size_t i = frames.size(); i-- > 1;) offset[i] -= offset[i - 1];
  row.jitter_ms = standard_deviation(std::span(offset).subspan(1));
  if (relative) return row;
  std::vector<double> residual = std::move(offset);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    residual[i] = difference_ms(frames[i].arrival.count(), nanoseconds_of(stamps[i]));
  }
  row.residual = residual_statistics(std::move(residual));
  return row;
}

// An estimator may extrapolate damaged stamps without limit; differences must not overflow.
GlobalTime limited(GlobalTime stamp) {
  constexpr GlobalTime kLargest{Nanoseconds((std::int64_t{1} << 62) - 1)};
  constexpr GlobalTime kSmallest{-kLargest.time_since_epoch()};
  return std::clamp(stamp, kSmallest, kLargest);
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
  const auto add = [&](const std::string& text) {
    warnings.push_back(fmt::format("{} {}: {}", camera.camera, camera.stream, text));
  };
  if (found.backward_steps > 0) {
    add(fmt::format("sensor stamps go back {}: frames were reordered, or the camera was restarted",
                    times(found.backward_steps)));
  }
  if (found.backward_arrivals > 0) {
    add(
        fmt::format("arrivals go back {}: the host's clock was set back, or the file was put "
                    "together from several; drift, periods and delays may be wrong",
                    times(found.backward_arrivals)));
  }
  if (found.counter_jumps > 0) {
    add(
        fmt::format("the frame counter jumps {} by more frames than the time between two allows "
                    "(by {} at most); these are not counted as missing",
                    times(found.counter_jumps), found.largest_jump));
  }
  if (found.counter_restarts > 0 && found.backward_steps == 0) {
    add(
        fmt::format("the frame counter stands still or goes back {}: the camera was restarted, or "
                    "frames arrived twice; missing frames may be more",
                    times(found.counter_restarts)));
  }
  if (counts_from_1970(camera.frames)) {
    add("sensor stamps count from 1970, as a computer's clock does and no camera's: with "
        "librealsense's global time they are the host's own estimate, and drift, jitter and "
        "residual are those of the estimate. Record with global time off");
  } else if (is_doubtful_drift(found.drift_ppm)) {
    add(
        fmt::format("a drift of {:.0f} ppm is no camera's, whose clock is right to some tens of "
                    "ppm: are both stamps milliseconds of one camera, and are {} enough?",
                    found.drift_ppm, counted(static_cast<std::uint64_t>(found.frames), "frame")));
  }
  if (found.frames < 2) add("has one frame: too few for a drift or a jitter");
}

bool needs_polls(const DeviceTimeEntry& entry) {
  return std::ranges::count(entry.info.needs, Need::kPolls) > 0;
}

// Those of the rows, in their order: what needs the truth, stamps of a clock that a recording does
// not name, or a clock of LEDs that no file of stamps shows, has none.
std::vector<const DeviceTimeEntry*> replayed_estimators() {
  std::vector<const DeviceTimeEntry*> entries;
  for (const DeviceTimeEntry& entry : algorithms<DeviceTimeEntry>()) {
    const bool lacks = std::ranges::any_of(entry.info.needs, [](Need need) {
      return need == Need::kHostStamps || need == Need::kLedClock;
    });
    if (!entry.make || lacks) continue;
    entries.push_back(&entry);
  }
  return entries;
}

// Counts the stamps of all estimators.
class StampProgress {
 public:
  StampProgress(const Progress& progress, std::uint64_t total)
      : progress_(total >= kFewStamps ? progress : Progress()), total_(total) {}

  void add(std::uint64_t stamps) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    progress_(done_ += stamps, total_);
  }

  static constexpr std::uint64_t kStep = std::uint64_t{1} << 14;  // tens of milliseconds

 private:
  static constexpr std::uint64_t kFewStamps = 4'000'000;  // a second's work
  const Progress progress_;
  const std::uint64_t total_;
  std::mutex mutex_;  // guards what follows
  std::uint64_t done_ = 0;
};

// Runs the estimators, each on all cameras, a job each.
class EstimatorJobs {
 public:
  EstimatorJobs(Replay& replay, const std::vector<RigFrames>& rigs, const Progress& progress)
      : replay_(replay), rigs_(rigs), entries_(replayed_estimators()), in_rig_(cameras_in_rigs()) {
    std::uint64_t frames = 0;
    for (CameraReplay& camera : replay.cameras) {
      frames += camera.frames.size();
      camera.rows.resize(entries_.size());
    }
    for (RigReplay& rig : replay.rigs) rig.rows.resize(entries_.size());
    const auto running = std::ranges::count_if(
        entries_, [](const DeviceTimeEntry* entry) { return !needs_polls(*entry); });
    progress_.emplace(progress, frames * static_cast<std::uint64_t>(running));
    const std::uint64_t fit = kMostFramesAtOnce / std::max<std::uint64_t>(frames, 1);
    const std::uint64_t cores = std::max(1U, std::thread::hardware_concurrency());
    threads_ = static_cast<unsigned>(std::clamp<std::uint64_t>(fit, 1, cores));
  }

  void run() {
    learn();
    run_jobs(entries_.size(), {.threads = threads_}, [this](std::size_t job) {
      if (needs_polls(*entries_[job])) {
        leave_out(job);
      } else {
        replay_entry(job);
      }
    });
  }

 private:
  static constexpr std::uint64_t kMostFramesAtOnce = 20'000'000;  // half a gigabyte

  std::vector<bool> cameras_in_rigs() const {
    std::vector<bool> in_rig(replay_.cameras.size(), false);
    for (const RigFrames& rig : rigs_) {
      for (const std::size_t camera : rig.cameras) in_rig[camera] = true;
    }
    return in_rig;
  }

  // Before all others run: learning takes the most memory.
  void learn() {
    learned_.resize(entries_.size());
    for (std::size_t row = 0; row < entries_.size(); ++row) {
      const DeviceTimeEntry& entry = *entries_[row];
      if (!entry.make(check_parameters(entry.info.parameters, {}))->offline()) continue;
      for (const CameraReplay& camera : replay_.cameras) learned_[row].emplace_back(entry, camera);
    }
  }

  void leave_out(std::size_t row) {
    const std::string& name = entries_[row]->info.name;
    for (CameraReplay& camera : replay_.cameras) {
      camera.rows[row] = without_values(name);
      camera.rows[row].needs_polls = true;
    }
    for (RigReplay& rig : replay_.rigs) {
      rig.rows[row] = {name, true, kNan, kNan, {}};
    }
  }

  void replay_entry(std::size_t row) {
    const std::string& name = entries_[row]->info.name;
    AllStamps all(replay_.cameras.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      CameraReplay& camera = replay_.cameras[i];
      CameraEstimator estimator = learned_[row].empty() ? CameraEstimator(*entries_[row], camera)
                                                        : std::move(learned_[row][i]);
      std::vector<GlobalTime> stamps = stamps_of(camera, estimator);
      camera.rows[row] = scored(name, camera.frames, stamps, estimator.relative());
      if (in_rig_[i]) all[i] = std::move(stamps);
    }
    for (std::size_t i = 0; i < rigs_.size(); ++i) {
      replay_.rigs[i].rows[row] = rig_row(name, rigs_[i], all);
    }
  }

  std::vector<GlobalTime> stamps_of(const CameraReplay& camera, CameraEstimator& estimator) {
    std::vector<GlobalTime> stamps;
    stamps.reserve(camera.frames.size());
    for (const StampedFrame& frame : camera.frames) {
      stamps.push_back(estimator.stamp(frame));
      if (stamps.size() % StampProgress::kStep == 0) progress_->add(StampProgress::kStep);
    }
    progress_->add(stamps.size() % StampProgress::kStep);
    return stamps;
  }

  Replay& replay_;
  const std::vector<RigFrames>& rigs_;
  const std::vector<const DeviceTimeEntry*> entries_;
  const std::vector<bool> in_rig_;
  std::optional<StampProgress> progress_;
  std::vector<std::vector<CameraEstimator>> learned_;  // by row and camera, of offline ones
  unsigned threads_ = 1;
};

// Fills in Replay::rigs but for their rows, and what they are scored by.
std::vector<RigFrames> find_rigs(const std::map<std::string, Nanoseconds>& anchors,
                                 Replay& replay) {
  std::vector<RigFrames> rigs;
  for (const auto& [stream, anchor] : anchors) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < replay.cameras.size(); ++i) {
      if (replay.cameras[i].stream == stream) members.push_back(i);
    }
    if (members.size() < 2) continue;
    std::optional<RigFrames> rig = rig_of(replay.cameras, members);
    if (!rig) {
      replay.warnings.push_back(stream +
                                ": no camera has a frame period, so the cameras are not compared");
      continue;
    }
    replay.rigs.push_back(rig_replay(stream, *rig));
    rigs.push_back(std::move(*rig));
    if (!replay.rigs.back().common_start_plausible) {
      replay.warnings.push_back(
          stream +
          ": the cameras' first frames lie more than half a period apart: without a common "
          "start, AMD and RMDV by GenLock order are meaningless");
    }
  }
  return rigs;
}

}  // namespace

CameraEstimator::CameraEstimator(const DeviceTimeEntry& entry, const CameraReplay& camera)
    : estimator_(entry.make(check_parameters(entry.info.parameters, {}))) {
  if (estimator_->relative()) shift_ = camera.anchor;
  if (!estimator_->offline()) return;
  std::vector<DeviceSample> samples;
  samples.reserve(camera.frames.size());
  for (const StampedFrame& frame : camera.frames) samples.push_back(sample_of(frame));
  estimator_->learn(samples);
}

GlobalTime CameraEstimator::stamp(const StampedFrame& frame) {
  return limited(estimator_->stamp(sample_of(frame)) + shift_);
}

GlobalStamps::GlobalStamps(const CameraReplay& camera) : camera_(camera) {
  for (const DeviceTimeEntry* entry : replayed_estimators()) {
    estimators_.emplace_back();
    if (!needs_polls(*entry)) estimators_.back().emplace(*entry, camera);
  }
  stamps_.resize(estimators_.size());
}

const std::vector<std::optional<GlobalTime>>& GlobalStamps::next() {
  const StampedFrame& frame = camera_.frames[frame_++];
  for (std::size_t i = 0; i < estimators_.size(); ++i) {
    if (estimators_[i]) stamps_[i] = estimators_[i]->stamp(frame);
  }
  return stamps_;
}

Replay run_replay(std::vector<CameraStream> streams, const Progress& progress) {
  Replay replay;
  for (CameraStream& stream : streams) {
    CameraReplay camera;
    camera.camera = std::move(stream.camera);
    camera.host = std::move(stream.host);
    camera.stream = std::move(stream.stream);
    camera.frames = std::move(stream.frames);
    unwrap(camera.frames);
    camera.statistics = camera_statistics(camera.frames);
    warn(camera, replay.warnings);
    replay.cameras.push_back(std::move(camera));
  }
  const std::map<std::string, Nanoseconds> anchors = anchors_of(replay.cameras);
  for (CameraReplay& camera : replay.cameras) camera.anchor = anchors.at(camera.stream);
  const std::vector<RigFrames> rigs = find_rigs(anchors, replay);
  EstimatorJobs(replay, rigs, progress).run();
  return replay;
}

}  // namespace simbench::evaluation

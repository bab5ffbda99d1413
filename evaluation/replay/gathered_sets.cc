#include "evaluation/replay/gathered_sets.h"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "evaluation/replay/replay.h"
#include "evaluation/replay/rig_frames.h"

namespace simbench::evaluation {
namespace {

class SetKeeper final : public FrameSetSink {
 public:
  // `streams`: of each source.
  explicit SetKeeper(const std::vector<std::size_t>& streams) : streams_(streams) {}
  void on_set(std::span<const GatherFrame> set) override { keep(set, true); }
  void on_partial_set(std::span<const GatherFrame> set) override { keep(set, false); }
  std::vector<GatheredSet> take() { return std::move(sets_); }

 private:
  void keep(std::span<const GatherFrame> set, bool complete) {
    GatheredSet kept{.frames = {}, .complete = complete};
    kept.frames.reserve(set.size());
    for (const GatherFrame& frame : set) {
      kept.frames.push_back({.stream = streams_[frame.source],
                             .frame = static_cast<std::size_t>(frame.tag),
                             .stamp = frame.stamp});
    }
    sets_.push_back(std::move(kept));
  }

  const std::vector<std::size_t>& streams_;
  std::vector<GatheredSet> sets_;
};

// The streams of one kind as a replay has them, and which streams they are.
struct ChosenStreams {
  std::vector<CameraReplay> cameras;
  std::vector<std::size_t> streams;
};

ChosenStreams chosen_streams(const std::vector<CameraStream>& streams, const std::string& kind) {
  ChosenStreams chosen;
  std::optional<Nanoseconds> anchor;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const CameraStream& stream = streams[i];
    if (stream.stream != kind || stream.frames.empty()) continue;
    const Nanoseconds first = stream.frames.front().arrival;
    anchor = std::min(anchor.value_or(first), first);
    CameraReplay& camera = chosen.cameras.emplace_back();
    camera.camera = stream.camera;
    camera.host = stream.host;
    camera.stream = stream.stream;
    camera.frames = unwrapped(stream.frames);
    chosen.streams.push_back(i);
  }
  for (CameraReplay& camera : chosen.cameras) camera.anchor = *anchor;
  return chosen;
}

}  // namespace

bool runs_on_recordings(const AlgorithmInfo& info) {
  return std::ranges::none_of(info.needs, [](Need need) {
    return need == Need::kPolls || need == Need::kHostStamps || need == Need::kLedClock ||
           need == Need::kTruth;
  });
}

GatheredSets gathered_sets(const std::vector<CameraStream>& streams, const std::string& kind,
                           const DeviceTimeEntry& device_time, const GatheringEntry& gathering) {
  if (!device_time.make || !runs_on_recordings(device_time.info) ||
      !runs_on_recordings(gathering.info)) {
    throw std::invalid_argument("an algorithm that a recording cannot feed");
  }
  const ChosenStreams chosen = chosen_streams(streams, kind);
  if (chosen.cameras.size() < 2) return {};
  std::vector<std::size_t> all(chosen.cameras.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::optional<RigFrames> rig = rig_of(chosen.cameras, all);
  if (!rig) return {};
  std::vector<CameraEstimator> estimators;
  estimators.reserve(all.size());
  for (const CameraReplay& camera : chosen.cameras) estimators.emplace_back(device_time, camera);
  const auto gatherer =
      gathering.make(check_parameters(gathering.info.parameters, {}), gathering_setup(*rig));
  SetKeeper sink(chosen.streams);
  // A camera's frames are in their order of delivery here, as its estimator wants them.
  for (const RigFrame& id : rig->order) {
    const StampedFrame& frame = rig->members[id.source]->frames[id.frame];
    gatherer->push({.source = id.source,
                    .stamp = estimators[id.source].stamp(frame),
                    .sensor = device_time_of(frame),
                    .tag = static_cast<std::int64_t>(id.frame)},
                   sink);
  }
  return {.sets = sink.take(), .discarded = gatherer->discarded()};
}

}  // namespace simbench::evaluation

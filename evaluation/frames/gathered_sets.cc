#include "evaluation/frames/gathered_sets.h"

#include <span>

#include "algorithms/ports/assert.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "evaluation/scoring/score_observer.h"

namespace simbench::evaluation {
namespace {

// Finds a camera's frames again, which the scorer tells in order and without their numbers.
class FrameFinder {
 public:
  explicit FrameFinder(const std::vector<const RecordedStream*>& streams)
      : streams_(streams), next_(streams.size()) {}

  // The camera's next frame with these stamps.
  std::size_t find(const GatherFrame& frame) {
    const std::vector<StampedFrame>& frames = streams_[frame.source]->frames;
    const Nanoseconds arrival = frame.arrival.time_since_epoch();
    const std::uint32_t in_register = register_of(frame.sensor.time_since_epoch()).us;
    std::size_t& next = next_[frame.source];
    const auto is_it = [&](const StampedFrame& recorded) {
      return recorded.arrival == arrival && register_of(recorded.sensor).us == in_register;
    };
    while (next < frames.size() && !is_it(frames[next])) ++next;
    SIMBENCH_ASSERT(next < frames.size(), "a scorer tells of frames that it was given");
    return next++;
  }

 private:
  const std::vector<const RecordedStream*>& streams_;
  std::vector<std::size_t> next_;  // by camera
};

class SetKeeper final : public ScoreObserver {
 public:
  SetKeeper(const std::vector<const RecordedStream*>& streams, GatheredSets& found)
      : found_(found), stamped_(streams), gathered_(streams) {
    for (const RecordedStream* stream : streams) found_.stamps.emplace_back(stream->frames.size());
  }

  void on_stamp(const GatherFrame& frame) override {
    found_.stamps[frame.source][stamped_.find(frame)] = frame.stamp;
  }

  void on_set(std::span<const GatherFrame> set, bool complete, GlobalTime /*now*/) override {
    GatheredSet& kept = found_.sets.emplace_back();
    kept.complete = complete;
    for (const GatherFrame& frame : set) {
      kept.frames.push_back(
          {.camera = frame.source, .frame = gathered_.find(frame), .stamp = frame.stamp});
    }
  }

  void on_shift(Nanoseconds shift) override {
    for (auto& stamps : found_.stamps) {
      for (std::optional<GlobalTime>& stamp : stamps) {
        if (stamp) *stamp += shift;
      }
    }
    for (GatheredSet& set : found_.sets) {
      for (GatheredFrame& frame : set.frames) frame.stamp += shift;
    }
  }

 private:
  GatheredSets& found_;
  FrameFinder stamped_;
  FrameFinder gathered_;
};

}  // namespace

GatheredSets gathered_sets(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                           StreamSource& source) {
  GatheredSets found;
  PipelineScorer scorer(scorer_setup(scenario, choice));
  SetKeeper keeper(source.streams(), found);
  scorer.watch(keeper);
  found.discarded = score_run(source, choice, /*seed=*/1, scorer, scorer).sets.discarded_frames;
  return found;
}

StampStatistics stamp_statistics(const StampedStream& stamped) {
  const std::vector<StampedFrame> all = unwrapped(stamped.stream->frames);
  std::vector<StampedFrame> frames;
  std::vector<GlobalTime> stamps;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!stamped.stamps[i]) continue;
    frames.push_back(all[i]);
    stamps.push_back(*stamped.stamps[i]);
  }
  return stamp_statistics(frames, stamps, stamped.relative);
}

}  // namespace simbench::evaluation

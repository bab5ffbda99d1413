#include "evaluation/run/exposure_sets.h"

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <variant>

#include "algorithms/device_time/unwrap.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/scoring/score_observer.h"
#include "recording/forwarding_sink.h"

namespace simbench::evaluation {
namespace {

// The largest distance of a frame from the anchor's stamp, in frame periods.
constexpr double kFarthestPeriods = 0.75;

// More than the difference of any two stamps (PulseTable::clamped_ns).
constexpr std::int64_t kFarthest = std::numeric_limits<std::int64_t>::max();

struct StampedExposure {
  std::int64_t stamp_ns = 0;
  std::int64_t pulse = 0;
  TrueTime mid_exposure{};
  std::uint32_t counter = 0;
};

struct CapturedCamera {
  struct Exposed {
    TrueTime mid_exposure{};
    std::uint32_t counter = 0;
  };
  DeviceStampUnwrapper unwrapper;
  std::map<DeviceTime, Exposed> exposed;  // by sensor stamp, which identifies a frame in the scorer
  std::vector<StampedExposure> frames;    // stamped by device_time
};

// Whether trigger pulses expose the scored frames.
bool is_triggered(const scenarios::Scenario& scenario) {
  const scenarios::Stream* scored = scenario.scored_stream();
  return scored == nullptr || scenario.cameras.follows_trigger(*scored);
}

// Keeps the true exposures of frames on their way to the scorer, and their stamps.
class ExposureKeeper final : public ForwardingSink, public ScoreObserver {
 public:
  ExposureKeeper(PipelineScorer& scorer, StreamKind stream, bool triggered)
      : ForwardingSink(scorer), stream_(stream), triggered_(triggered) {
    scorer.watch(*this);
  }

  void on_start(const RigLayout& layout) override {
    layout_ = layout;
    cameras_.resize(layout.cameras.size());
    ForwardingSink::on_start(layout);
  }

  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    passed_.assign(truths.begin(), truths.end());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (frames[i].stream == stream_) keep(frames[i], truths.empty() ? nullptr : &passed_[i]);
    }
    sink().on_frames(frames, passed_);
  }

  // Polls unwrap the register of the camera's clock too, as in the scorer.
  void on_event(const RecordingEvent& event) override {
    if (const auto* pulse = std::get_if<PulseTruth>(&event)) {
      pulses_.emplace_back(pulse->at, pulse->pulse);
    } else if (const auto* poll = std::get_if<DevicePoll>(&event)) {
      cameras_.at(poll->camera).unwrapper.unwrap(poll->device);
    }
    sink().on_event(event);
  }

  void on_stamp(const GatherFrame& frame) override {
    CapturedCamera& camera = cameras_[frame.source];
    const CapturedCamera::Exposed& exposed = camera.exposed.at(frame.sensor);
    camera.frames.push_back(
        {nanoseconds_of(frame.stamp), frame.tag, exposed.mid_exposure, exposed.counter});
  }

  void on_set(std::span<const GatherFrame>, bool, GlobalTime) override {}
  // A shift of all stamps changes no distance.
  void on_shift(Nanoseconds) override {}

  // Call after the scorer has finished.
  std::vector<ExposureSet> sets(std::size_t count) {
    std::vector<ExposureSet> sets;
    for (CapturedCamera& camera : cameras_) {
      std::stable_sort(camera.frames.begin(), camera.frames.end(),
                       [](const StampedExposure& a, const StampedExposure& b) {
                         return a.stamp_ns < b.stamp_ns;
                       });
    }
    const std::vector<std::int64_t> stamps = anchors();
    const std::size_t taken = std::min(count, stamps.size());
    for (std::size_t i = 0; i < taken; ++i) {
      sets.push_back(set_around(stamps[(2 * i + 1) * stamps.size() / (2 * taken)]));
    }
    return sets;
  }

 private:
  // Changes the truth to what the scorer is to get.
  void keep(const FrameRecord& frame, FrameTruth* truth) {
    if (truth == nullptr) {
      throw RecordingFailed(
          "the true exposure times of the frames are unknown: only a simulation has them");
    }
    CapturedCamera& camera = cameras_.at(frame.camera);
    camera.exposed[camera.unwrapper.unwrap(frame.sensor)] = {truth->mid_exposure(), frame.counter};
    if (!triggered_) truth->pulse = last_pulse_before(truth->mid_exposure());
  }

  std::int64_t last_pulse_before(TrueTime time) const {
    const auto after =
        std::upper_bound(pulses_.begin(), pulses_.end(), time,
                         [](TrueTime wanted, const auto& pulse) { return wanted < pulse.first; });
    return after == pulses_.begin() ? -1 : std::prev(after)->second;
  }

  bool is_evaluated(std::int64_t pulse) const {
    return pulse >= layout_.first_pulse && pulse < layout_.first_pulse + layout_.pulses;
  }

  // The master's first camera with frames, else the first with frames; null without any.
  const CapturedCamera* anchor_camera() const {
    const CapturedCamera* any = nullptr;
    for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
      const bool has_frames = !cameras_[camera].frames.empty();
      if (has_frames && layout_.cameras[camera].host == 0) return &cameras_[camera];
      if (has_frames && any == nullptr) any = &cameras_[camera];
    }
    return any;
  }

  // Stamps of the anchor's evaluated frames, where all cameras' stamps overlap if they do.
  std::vector<std::int64_t> anchors() const {
    std::int64_t begin = -kFarthest;
    std::int64_t end = kFarthest;
    for (const CapturedCamera& camera : cameras_) {
      if (camera.frames.empty()) continue;
      begin = std::max(begin, camera.frames.front().stamp_ns);
      end = std::min(end, camera.frames.back().stamp_ns);
    }
    std::vector<std::int64_t> all;
    std::vector<std::int64_t> overlapping;
    const CapturedCamera* anchor = anchor_camera();
    if (anchor == nullptr) return all;
    for (const StampedExposure& frame : anchor->frames) {
      if (!is_evaluated(frame.pulse)) continue;
      all.push_back(frame.stamp_ns);
      if (begin <= frame.stamp_ns && frame.stamp_ns <= end) overlapping.push_back(frame.stamp_ns);
    }
    return overlapping.empty() ? all : overlapping;
  }

  ExposureSet set_around(std::int64_t stamp_ns) const {
    ExposureSet set;
    for (const CapturedCamera& camera : cameras_) {
      set.cameras.push_back(nearest(camera.frames, stamp_ns));
    }
    return set;
  }

  std::optional<SetExposure> nearest(const std::vector<StampedExposure>& frames,
                                     std::int64_t stamp_ns) const {
    const auto later = std::lower_bound(
        frames.begin(), frames.end(), stamp_ns,
        [](const StampedExposure& frame, std::int64_t wanted) { return frame.stamp_ns < wanted; });
    const StampedExposure* best = nullptr;
    std::int64_t distance_ns = kFarthest;
    if (later != frames.begin()) {
      best = &*std::prev(later);
      distance_ns = stamp_ns - best->stamp_ns;
    }
    if (later != frames.end() && later->stamp_ns - stamp_ns < distance_ns) {
      best = &*later;
      distance_ns = best->stamp_ns - stamp_ns;
    }
    if (best == nullptr ||
        static_cast<double>(distance_ns) > kFarthestPeriods * 1e9 / layout_.frame_rate_hz) {
      return std::nullopt;
    }
    return SetExposure{.mid_exposure_s = to_ms(best->mid_exposure - first_evaluated_pulse()) * 1e-3,
                       .counter = best->counter};
  }

  TrueTime first_evaluated_pulse() const {
    const auto found = std::find_if(pulses_.begin(), pulses_.end(), [this](const auto& pulse) {
      return is_evaluated(pulse.second);
    });
    return found == pulses_.end() ? TrueTime() : found->first;
  }

  const StreamKind stream_;
  const bool triggered_;
  RigLayout layout_;
  std::vector<CapturedCamera> cameras_;
  std::vector<FrameTruth> passed_;                         // scratch
  std::vector<std::pair<TrueTime, std::int64_t>> pulses_;  // in order of time
};

}  // namespace

double ExposureSet::spread_ms() const {
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -first_s;
  for (const std::optional<SetExposure>& exposure : cameras) {
    if (!exposure) continue;
    first_s = std::min(first_s, exposure->mid_exposure_s);
    last_s = std::max(last_s, exposure->mid_exposure_s);
  }
  return last_s > first_s ? (last_s - first_s) * 1e3 : 0;
}

ExposureSets exposure_sets(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                           std::uint64_t seed, RecordingSource& source, std::size_t count) {
  const ScorerSetup setup = scorer_setup(scenario, choice);
  PipelineScorer scorer(setup);
  ExposureKeeper keeper(scorer, setup.stream, is_triggered(scenario));
  ExposureSets result;
  result.score = score_run(source, choice, seed, scorer, keeper);
  result.gathered_sets = result.score.sets.emitted;
  result.sets = keeper.sets(count);
  return result;
}

}  // namespace simbench::evaluation

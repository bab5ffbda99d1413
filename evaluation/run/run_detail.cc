#include "evaluation/run/run_detail.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "algorithms/device_time/unwrap.h"
#include "algorithms/ports/host_sync.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "evaluation/scoring/unverified_scores.h"
#include "recording/forwarding_sink.h"

namespace simbench::evaluation {
namespace {

constexpr Nanoseconds kClockInterval = std::chrono::milliseconds(20);
constexpr std::int64_t kMostClockSamplesOfAService = 2000;  // before the capture

double true_ms(TrueTime time) { return to_ms(time.time_since_epoch()); }

// Clock errors of the hosts kept in detail.
ClockErrors clock_errors(TrueTime at, std::span<const Nanoseconds> errors) {
  ClockErrors clocks{.at_ms = true_ms(at), .errors_ms = {}};
  for (const Nanoseconds error : errors.first(std::min(errors.size(), kDetailCameras))) {
    clocks.errors_ms.push_back(to_ms(error));
  }
  return clocks;
}

// The missing frames between each two delivered ones.
std::vector<LostFrame> gaps(const RunDetail& run) {
  std::vector<LostFrame> lost;
  for (std::uint32_t camera = 0; camera < run.cameras.size(); ++camera) {
    const std::vector<FrameDetail>& frames = run.cameras[camera].frames;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const std::uint64_t next = frames[i - 1].counter + std::uint64_t{1};
      if (frames[i].counter > next + kLongestGap) continue;
      for (std::uint64_t counter = next; counter < frames[i].counter; ++counter) {
        lost.push_back({.camera = camera, .counter = static_cast<std::uint32_t>(counter)});
      }
    }
  }
  return lost;
}

// The part of a RunDetail that only a simulated world shows: host clocks, lost frames, and when the
// parts of the run began.
class RunWorld final : public WorldObserver {
 public:
  // Observes frames of `stream`. `service`: how long a host_sync that does not end runs before the
  // capture. Clocks are sampled every 20 ms, less often with many hosts or a long service.
  RunWorld(StreamKind stream, std::int64_t hosts, std::optional<Nanoseconds> service)
      : stream_(stream),
        service_(service.has_value()),
        clock_interval_(
            std::max(kClockInterval * (1 + hosts / static_cast<std::int64_t>(kDetailCameras)),
                     service.value_or(Nanoseconds::zero()) / kMostClockSamplesOfAService)) {}

  Nanoseconds clock_interval() const override { return clock_interval_; }
  void on_world(TrueTime start) override { start_ = start; }
  void on_capture_start(TrueTime at) override { capture_start_ = at; }
  void on_pulse(const ObservedPulse&) override {}
  void on_message(const ObservedMessage&) override {}

  void on_frame(const ObservedFrame& frame) override {
    const bool is_lost = frame.fate != FrameFate::kDelivered && frame.fate != FrameFate::kNotPassed;
    if (!is_lost || frame.stream != stream_) return;
    if (frame.camera >= kDetailCameras) return;
    lost_.push_back(
        {.camera = frame.camera,
         .counter = frame.counter,
         .pulse = frame.pulse,
         .fate = frame.fate,
         .mid_exposure_ms = (true_ms(frame.exposure_start) + true_ms(frame.exposure_end)) / 2});
  }

  void on_clocks(TrueTime at, std::span<const Nanoseconds> errors) override {
    clocks_.push_back(clock_errors(at, errors));
  }

  // When the run is over and `run` has its frames.
  void add_to(RunDetail& run, double wait_before_capture_ms) {
    run.service = service_;
    run.lost = start_ ? std::move(lost_) : gaps(run);
    run.clocks.insert(run.clocks.end(), clocks_.begin(), clocks_.end());
    std::stable_sort(run.clocks.begin(), run.clocks.end(),
                     [](const ClockErrors& a, const ClockErrors& b) { return a.at_ms < b.at_ms; });
    if (start_) run.world_start_ms = true_ms(*start_);
    if (!capture_start_) return;
    run.capture_start_ms = true_ms(*capture_start_);
    if (!service_) run.sync_end_ms = run.capture_start_ms - wait_before_capture_ms;
  }

 private:
  StreamKind stream_;
  bool service_;
  Nanoseconds clock_interval_;
  std::optional<TrueTime> start_;
  std::optional<TrueTime> capture_start_;
  std::vector<LostFrame> lost_;
  std::vector<ClockErrors> clocks_;
};

// A camera's register and what it counts, unwrapped.
struct ReadRegister {
  DeviceStamp stamp;
  DeviceTime time;
};

// The estimators of one camera besides the pipeline's own, and their input.
struct Companion {
  std::unique_ptr<DeviceTimeEstimator> from_start;  // null: the oracle
  DeviceStampUnwrapper unwrapper;
  std::optional<ReadRegister> newest;             // the sensor stamp of the newest frame
  std::vector<DeviceSample> samples;              // by frame
  std::vector<std::optional<GlobalTime>> global;  // by frame, as the pipeline's estimator gave it
  std::map<DeviceTime, std::size_t> frame_by_sensor;  // scorer and gatherer identify frames so
};

// The unwrapped time of a stamp of the same register, from which it is never far.
DeviceTime time_near(DeviceStamp stamp, const ReadRegister& known) {
  return known.time + Microseconds(static_cast<std::int32_t>(stamp.us - known.stamp.us));
}

double device_ms(DeviceTime time) { return to_ms(time.time_since_epoch()); }

// Keeps the recording on its way to the scorer, and the scorer's stamps and sets.
class DetailKeeper final : public ForwardingSink, public ScoreObserver {
 public:
  DetailKeeper(PipelineScorer& scorer, const ScorerSetup& setup, RunDetail& run)
      : ForwardingSink(scorer), setup_(setup), run_(run) {
    scorer.watch(*this);
  }

  void on_start(const RigLayout& layout) override {
    run_.frame_rate_hz = layout.frame_rate_hz;
    run_.camera_count = layout.cameras.size();
    run_.host_count = layout.hosts;
    run_.first_pulse = layout.first_pulse;
    run_.pulses = layout.pulses;
    run_.cameras.resize(std::min(layout.cameras.size(), kDetailCameras));
    companions_.resize(run_.cameras.size());
    for (std::size_t camera = 0; camera < run_.cameras.size(); ++camera) {
      run_.cameras[camera].host = layout.cameras[camera].host;
      if (setup_.make_estimator) companions_[camera].from_start = setup_.make_estimator(camera);
    }
    ForwardingSink::on_start(layout);
  }

  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    for_each_frame(frames, truths, [this](const FrameRecord& frame, const FrameTruth* truth) {
      if (frame.camera >= companions_.size()) return;
      frame.stream == setup_.stream ? keep(frame, truth) : keep_other(frame, truth);
    });
    sink().on_frames(frames, truths);
  }

  void on_event(const RecordingEvent& event) override {
    std::visit(
        Overloaded{[this](const PulseTruth& pulse) { add(pulse); },
                   [this](const ClockAdjustment& adjustment) { add(adjustment); },
                   [this](const DevicePoll& poll) { add(poll); },
                   [this](const LedSighting& sighting) { add(sighting); }, [](const auto&) {}},
        event);
    sink().on_event(event);
  }

  void on_stamp(const GatherFrame& frame) override {
    const std::optional<std::size_t> index = frame_index(frame.source, frame.sensor);
    if (!index) return;
    FrameDetail& detail = run_.cameras[frame.source].frames[*index];
    detail.in_warm_up = false;
    detail.pulse = std::max<std::int64_t>(frame.tag, -1);
    detail.evaluated = frame.tag >= run_.first_pulse && frame.tag < run_.first_pulse + run_.pulses;
    companions_[frame.source].global[*index] = frame.stamp;
  }

  void on_set(std::span<const GatherFrame> set, bool complete, GlobalTime) override {
    SetDetail detail;
    detail.complete = complete;
    std::map<std::int64_t, std::size_t> members_of_pulse;
    GlobalTime first = GlobalTime::max();
    GlobalTime last = GlobalTime::min();
    for (const GatherFrame& frame : set) {
      if (frame.tag >= 0) ++members_of_pulse[frame.tag];
      first = std::min(first, frame.stamp);
      last = std::max(last, frame.stamp);
      const std::optional<std::size_t> index = frame_index(frame.source, frame.sensor);
      if (index) detail.members.push_back({frame.source, *index});
    }
    detail.range_ms = to_ms(last - first);
    std::size_t most = 0;
    for (const auto& [pulse, members] : members_of_pulse) {
      if (members > most) detail.pulse = pulse;
      most = std::max(most, members);
    }
    detail.pure = most == set.size();
    run_.sets.push_back(std::move(detail));
  }

  void on_shift(Nanoseconds shift) override { shift_ = shift; }

  // After the scorer: sets the stamps that need the whole capture.
  void finish(const EstimatorFactory& make_online, const EstimatorFactory& make_offline) {
    for (std::size_t camera = 0; camera < companions_.size(); ++camera) {
      Companion& companion = companions_[camera];
      std::vector<FrameDetail>& frames = run_.cameras[camera].frames;
      if (companion.from_start && companion.from_start->offline()) {
        companion.from_start->learn(companion.samples);
        for (std::size_t i = 0; i < frames.size(); ++i) {
          frames[i].from_start_ms = stamp_ms(*companion.from_start, companion.samples[i]);
        }
      }
      for (std::size_t i = 0; i < frames.size(); ++i) {
        if (companion.global[i]) frames[i].global_ms = from_zero_ms(*companion.global[i] + shift_);
      }
      stamp_by(*make_online(camera), companion.samples, frames, &FrameDetail::online_ms);
      stamp_by(*make_offline(camera), companion.samples, frames, &FrameDetail::offline_ms);
    }
  }

 private:
  // RunWorld's own samples may be far apart.
  void add(const PulseTruth& truth) {
    run_.clocks.push_back(clock_errors(truth.at, truth.host_errors));
  }

  void add(const ClockAdjustment& adjustment) {
    for (std::size_t camera = 0; camera < companions_.size(); ++camera) {
      if (run_.cameras[camera].host != adjustment.host) continue;
      if (companions_[camera].from_start) companions_[camera].from_start->on_adjustment(adjustment);
    }
  }

  void add(const DevicePoll& poll) {
    if (poll.camera >= companions_.size()) return;
    Companion& companion = companions_[poll.camera];
    const DeviceTime device = companion.unwrapper.unwrap(poll.device);
    if (companion.from_start) {
      companion.from_start->on_poll({device, poll.t0, poll.t1, poll.t0_steady, poll.t1_steady});
    }
  }

  void add(const LedSighting& sighting) {
    if (sighting.camera >= companions_.size()) return;
    Companion& companion = companions_[sighting.camera];
    const DeviceTime sensor = companion.unwrapper.unwrap(sighting.sensor);
    if (companion.from_start) companion.from_start->on_led_sighting({sensor, sighting.middle()});
  }

  double from_zero_ms(HostTime time) const { return to_ms(time - *zero_); }
  double from_zero_ms(GlobalTime time) const {
    return from_zero_ms(HostTime(time.time_since_epoch()));
  }
  double stamp_ms(DeviceTimeEstimator& estimator, const DeviceSample& sample) const {
    return from_zero_ms(estimator.stamp(sample));
  }

  void keep(const FrameRecord& frame, const FrameTruth* truth) {
    if (!zero_) {
      zero_ = truth != nullptr ? truth->reference : frame.arrival;
      run_.zero = *zero_;
    }
    Companion& companion = companions_[frame.camera];
    const DeviceTime sensor = companion.unwrapper.unwrap(frame.sensor);
    companion.newest = {frame.sensor, sensor};
    FrameDetail detail;
    detail.counter = frame.counter;
    detail.in_warm_up = true;  // until it gets a stamp
    detail.sensor_ms = device_ms(sensor);
    detail.frame_ms = device_ms(time_near(frame.frame, *companion.newest));
    detail.backend_ms = from_zero_ms(frame.backend);
    detail.arrival_ms = from_zero_ms(frame.arrival);
    if (truth != nullptr) {
      run_.has_truth = true;
      detail.pulse = truth->pulse;
      detail.reference_ms = from_zero_ms(truth->reference);
      detail.own_host_ms = from_zero_ms(truth->own_host);
      detail.exposure_start_ms = true_ms(truth->exposure_start);
      detail.exposure_end_ms = true_ms(truth->exposure_end);
    }
    const DeviceSample sample = {sensor, frame.arrival, frame.arrival_steady, frame.exposure_us};
    if (!companion.from_start && truth != nullptr) {
      detail.from_start_ms = from_zero_ms(truth->own_host);
    } else if (companion.from_start && !companion.from_start->offline()) {
      detail.from_start_ms = stamp_ms(*companion.from_start, sample);
    }
    std::vector<FrameDetail>& frames = run_.cameras[frame.camera].frames;
    companion.frame_by_sensor[sensor] = frames.size();
    companion.samples.push_back(sample);
    companion.global.emplace_back();
    frames.push_back(detail);
  }

  // Frames before the camera's first of the scored stream are left out.
  void keep_other(const FrameRecord& frame, const FrameTruth* truth) {
    const std::optional<ReadRegister>& newest = companions_[frame.camera].newest;
    if (!newest) return;
    OtherFrame other;
    other.sensor_ms = device_ms(time_near(frame.sensor, *newest));
    if (truth != nullptr) {
      other.exposure_start_ms = true_ms(truth->exposure_start);
      other.exposure_end_ms = true_ms(truth->exposure_end);
    }
    run_.cameras[frame.camera].others.push_back(other);
  }

  std::optional<std::size_t> frame_index(std::uint32_t camera, DeviceTime sensor) const {
    if (camera >= companions_.size()) return std::nullopt;
    const auto found = companions_[camera].frame_by_sensor.find(sensor);
    if (found == companions_[camera].frame_by_sensor.end()) return std::nullopt;
    return found->second;
  }

  // Sets another estimator's stamps of the frames after the warm-up.
  void stamp_by(DeviceTimeEstimator& estimator, const std::vector<DeviceSample>& samples,
                std::vector<FrameDetail>& frames, double FrameDetail::*stamp) const {
    std::vector<DeviceSample> recording;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (!frames[i].in_warm_up) recording.push_back(samples[i]);
    }
    if (recording.empty()) return;
    if (estimator.offline()) estimator.learn(recording);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (!frames[i].in_warm_up) frames[i].*stamp = stamp_ms(estimator, samples[i]);
    }
  }

  const ScorerSetup& setup_;
  RunDetail& run_;
  std::optional<HostTime> zero_;
  Nanoseconds shift_{};
  std::vector<Companion> companions_;  // by camera
};

// Makes the estimator of this name with the scenario's parameters.
EstimatorFactory estimator_named(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                                 const std::string& device_time) {
  scenarios::Scenario changed = scenario;
  changed.pipelines = {choice.pipeline};
  changed.pipelines.front().device_time = device_time;
  return scorer_setup(changed, choose_pipelines(changed, {}).front()).make_estimator;
}

void note_times(RunDetail& run) {
  for (const CameraDetail& camera : run.cameras) {
    for (const FrameDetail& frame : camera.frames) {
      run.has_pulses = run.has_pulses || frame.pulse >= 0;
      if (!run.has_truth) continue;
      run.capture_end_ms = std::fmax(run.capture_end_ms, frame.exposure_end_ms);
      if (frame.in_warm_up) continue;
      run.evaluated_start_ms = std::fmin(run.evaluated_start_ms, frame.exposure_start_ms);
    }
  }
}

}  // namespace

RunDetail run_detail(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                     std::uint64_t seed, RecordingSource& source) {
  RunDetail run;
  run.scenario = scenario.name;
  run.pipeline = choice.pipeline.name;
  run.seed = seed;
  run.stream = scenario.evaluation.stream;
  run.sync_mode = scenario.cameras.sync_mode;
  run.pulses_code = coded_pulses(scenario);
  const ScorerSetup setup = scorer_setup(scenario, choice);
  PipelineScorer scorer(setup);
  DetailKeeper keeper(scorer, setup, run);
  const auto service = choice.host_sync.make()->warm_up();
  RunWorld world(setup.stream, scenario.hosts.count, service);
  run.score = score_run(source, choice, seed, scorer, keeper, &world);
  run.gathering_interval_ms = 1000 / run.frame_rate_hz * setup.gathering_interval_periods;
  keeper.finish(estimator_named(scenario, choice, "regression_30"),
                estimator_named(scenario, choice, "regression_offline"));
  note_times(run);
  world.add_to(run, scenario.timeline.wait_before_capture_ms);
  return run;
}

}  // namespace simbench::evaluation

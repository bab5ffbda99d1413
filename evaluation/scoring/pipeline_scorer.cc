#include "evaluation/scoring/pipeline_scorer.h"

#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kNoPulse = -1;

std::optional<std::uint32_t> first_camera_of_master(const RigLayout& layout) {
  for (std::size_t camera = 0; camera < layout.cameras.size(); ++camera) {
    if (layout.cameras[camera].host == 0) return static_cast<std::uint32_t>(camera);
  }
  return std::nullopt;
}

GlobalTime on_global_scale(HostTime time) { return GlobalTime(time.time_since_epoch()); }

}  // namespace

void DeferredStamps::stamp(
    const EstimatorFactory& make,
    const std::function<void(const DeferredFrame&, GlobalTime)>& stamped) const {
  std::vector<std::vector<DeviceSample>> recordings(sources_);
  for (const DeferredFrame& frame : frames_) recordings[frame.source].push_back(frame.sample);

  std::vector<std::unique_ptr<DeviceTimeEstimator>> estimators;
  estimators.reserve(sources_);
  for (std::size_t source = 0; source < sources_; ++source) estimators.push_back(make());
  for (const auto& [source, adjustment] : adjustments_) {
    estimators[source]->on_adjustment(adjustment);
  }
  for (const auto& [source, poll] : polls_) estimators[source]->on_poll(poll);
  for (std::size_t source = 0; source < sources_; ++source) {
    if (!recordings[source].empty()) estimators[source]->learn(recordings[source]);
  }
  for (const DeferredFrame& frame : frames_) {
    stamped(frame, estimators[frame.source]->stamp(frame.sample));
  }
}

PipelineScorer::PipelineScorer(ScorerSetup setup) : setup_(std::move(setup)) {}

Nanoseconds PipelineScorer::period() const {
  return Nanoseconds(std::llround(1e9 / layout_.frame_rate_hz));
}

void PipelineScorer::on_start(const RigLayout& layout) {
  SIMBENCH_ASSERT(layout.frame_rate_hz > 0, "a capture has a frame rate");
  layout_ = layout;
  const std::size_t cameras = layout.cameras.size();
  const GatheringSetup gathering = {
      .sources = static_cast<std::uint32_t>(cameras),
      .period = period(),
      .interval = Nanoseconds(
          std::llround(static_cast<double>(period().count()) * setup_.gathering_interval_periods))};
  gatherer_ = setup_.make_gatherer(gathering);
  gather_warm_up_ = gatherer_->from_first_frame();
  anchor_camera_ = first_camera_of_master(layout);
  table_.emplace(layout.first_pulse, layout.pulses, cameras);
  sets_.emplace(*table_, observer_);
  host_errors_.emplace(layout.hosts);
  if (setup_.make_second_estimator) second_deferred_.emplace(cameras);
  sources_.reserve(cameras);
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    sources_.push_back({{},
                        GenlockOrder(period(), GenlockOrder::Variant::kReanchored),
                        setup_.make_estimator ? setup_.make_estimator() : nullptr});
  }
  if (setup_.make_estimator && !sources_.empty()) {
    relative_ = sources_.front().estimator->relative();
    stamp_warm_up_ = relative_ || sources_.front().estimator->from_first_frame();
    if (sources_.front().estimator->offline()) deferred_.emplace(cameras);
  }
}

void PipelineScorer::on_frame(const FrameRecord& frame, const FrameTruth* truth) {
  if (frame.stream != setup_.stream) return;
  SIMBENCH_ASSERT(frame.camera < sources_.size(), "a frame of a camera that the rig does not have");
  if (!ground_truth_) learn_ground_truth(truth);
  Source& source = sources_[frame.camera];
  const DeviceTime sensor = source.unwrapper.unwrap(frame.sensor);
  const Place place = place_of(source, frame, truth, sensor);
  const DeferredFrame delivered = {
      frame.camera,
      place.pulse,
      {sensor, frame.arrival, frame.arrival_steady, frame.exposure_us},
      on_global_scale(truth != nullptr ? truth->delivered : frame.arrival)};
  note_anchor(frame);
  if (place.warm_up) {
    GlobalTime global = on_global_scale(frame.arrival);
    if (stamp_warm_up_ && !deferred_) global = estimate(source, delivered.sample, truth);
    if (gather_warm_up_) gather(delivered, global);
    return;
  }
  if (truth != nullptr && table_->holds(delivered.pulse)) {
    table_->store_truth(delivered.pulse, frame.camera, *truth);
  }
  if (second_deferred_) second_deferred_->add(delivered);
  if (deferred_) {
    deferred_->add(delivered);
  } else {
    settle(delivered, estimate(source, delivered.sample, truth));
  }
}

void PipelineScorer::learn_ground_truth(const FrameTruth* truth) {
  if (truth != nullptr) {
    ground_truth_ = GroundTruth::kSimulation;
  } else if (setup_.genlock) {
    ground_truth_ = GroundTruth::kGenlockOrder;
  } else {
    ground_truth_ = GroundTruth::kNone;
    unverified_.emplace(layout_, setup_.median, observer_);
    if (setup_.gatherer_needs_pulses) {
      throw RecordingFailed(
          "gathering \"oracle\" needs the pulse of every frame, which only a simulation or a "
          "genlock capture has");
    }
  }
}

GroundTruth PipelineScorer::ground_truth() const {
  if (ground_truth_) return *ground_truth_;
  if (pulses_with_truth_) return GroundTruth::kSimulation;
  return setup_.genlock ? GroundTruth::kGenlockOrder : GroundTruth::kNone;
}

PipelineScorer::Place PipelineScorer::place_of(Source& source, const FrameRecord& frame,
                                               const FrameTruth* truth, DeviceTime sensor) {
  if (unverified_) {
    using Part = UnverifiedScores::Part;
    const Part part = unverified_->part_of(frame);
    return {.pulse = part == Part::kEvaluated ? kUnknownPulse : kNoPulse,
            .warm_up = part == Part::kWarmUp};
  }
  const std::int64_t pulse = pulse_of(source, truth, sensor);
  return {.pulse = pulse, .warm_up = in_warm_up(pulse)};
}

std::int64_t PipelineScorer::pulse_of(Source& source, const FrameTruth* truth, DeviceTime sensor) {
  if (!setup_.genlock) return truth != nullptr ? truth->pulse : kNoPulse;
  const std::int64_t index = source.order.next(sensor);
  if (truth == nullptr) return index;
  if (!first_true_pulse_) first_true_pulse_ = truth->pulse;
  if (index != truth->pulse - *first_true_pulse_) ++genlock_index_errors_;
  return truth->pulse;
}

// Whether a frame precedes the evaluated part.
bool PipelineScorer::in_warm_up(std::int64_t pulse) {
  if (pulse >= layout_.first_pulse) warm_up_over_ = true;
  return pulse == kNoPulse ? !warm_up_over_ : pulse < layout_.first_pulse;
}

void PipelineScorer::note_anchor(const FrameRecord& frame) {
  if (!first_arrival_) first_arrival_ = frame.arrival;
  if (!anchor_ && anchor_camera_ == frame.camera) anchor_ = frame.arrival;
}

GlobalTime PipelineScorer::estimate(Source& source, const DeviceSample& sample,
                                    const FrameTruth* truth) {
  if (source.estimator) return source.estimator->stamp(sample);
  if (truth == nullptr) {
    throw RecordingFailed(
        "device_time \"oracle\" needs the true exposure times, which only a simulation has");
  }
  return on_global_scale(truth->own_host);
}

// Known before the first complete set, which has a frame of the anchor's camera.
Nanoseconds PipelineScorer::anchor_shift() const {
  if (!relative_ || !first_arrival_) return Nanoseconds::zero();
  return anchor_.value_or(*first_arrival_).time_since_epoch();
}

void PipelineScorer::gather(const DeferredFrame& frame, GlobalTime global) {
  const GatherFrame gathered = {.source = frame.source,
                                .stamp = GlobalTime(Nanoseconds(PulseTable::clamped_ns(global))),
                                .arrival = frame.delivered,
                                .sensor = frame.sample.sensor,
                                .tag = frame.pulse};
  if (unverified_) {
    unverified_->before_push(frame.delivered);
    gatherer_->push(gathered, *unverified_);
  } else {
    sets_->before_push(frame.delivered, anchor_shift());
    gatherer_->push(gathered, *sets_);
  }
}

void PipelineScorer::settle(const DeferredFrame& frame, GlobalTime global) {
  if (table_->holds(frame.pulse)) table_->store(frame.pulse, frame.source, global);
  if (observer_ != nullptr) observer_->on_stamp(frame, global);
  gather(frame, global);
}

void PipelineScorer::on_pulse(const PulseTruth& truth) {
  pulses_with_truth_ = true;
  if (table_->holds(truth.pulse)) host_errors_->add(truth.host_errors);
}

void PipelineScorer::on_adjustment(const ClockAdjustment& adjustment) {
  for (std::uint32_t source = 0; source < sources_.size(); ++source) {
    if (layout_.cameras[source].host != adjustment.host) continue;
    if (sources_[source].estimator) sources_[source].estimator->on_adjustment(adjustment);
    if (deferred_) deferred_->add_adjustment(source, adjustment);
    if (second_deferred_) second_deferred_->add_adjustment(source, adjustment);
  }
}

void PipelineScorer::on_poll(const DevicePoll& poll) {
  Source& source = sources_[poll.camera];
  const PollSample sample = {source.unwrapper.unwrap(poll.device), poll.t0, poll.t1, poll.t0_steady,
                             poll.t1_steady};
  if (source.estimator) source.estimator->on_poll(sample);
  if (deferred_) deferred_->add_poll(poll.camera, sample);
  if (second_deferred_) second_deferred_->add_poll(poll.camera, sample);
}

void PipelineScorer::on_exchange(std::uint32_t, const Exchange&) {}

void PipelineScorer::on_outcome(const SyncOutcome& outcome) {
  if (!outcome.synchronised) failures_.push_back(outcome);
}

SeedScore PipelineScorer::finish() {
  SIMBENCH_ASSERT(table_.has_value(), "a capture starts before it ends");
  if (deferred_) {
    deferred_->stamp(setup_.make_estimator, [this](const DeferredFrame& frame, GlobalTime global) {
      settle(frame, global);
    });
  }
  if (relative_) table_->shift(anchor_shift());
  if (observer_ != nullptr) observer_->on_shift(anchor_shift());
  SeedScore score;
  PulseScoring scoring;
  scoring.median = setup_.median;
  scoring.period = period();
  scoring.hosts = layout_.hosts;
  for (const CameraLayout& camera : layout_.cameras) scoring.host_of_source.push_back(camera.host);
  score_pulses(*table_, scoring, score);
  sets_->score(score);
  if (unverified_) unverified_->score(score);
  score.ground_truth = ground_truth();
  score.sets.discarded_frames = static_cast<std::int64_t>(gatherer_->discarded());
  score.host_error_ms = host_errors_->mean_absolute_ms();
  host_errors_->time_errors().add_to(score);
  score.host_errors_ms = host_errors_->signed_means_ms();
  score.offline_amd_ms = second_deferred_ ? second_amd_ms() : kNan;
  score.genlock_index_errors = genlock_index_errors_;
  score.failures = std::move(failures_);
  return score;
}

double PipelineScorer::second_amd_ms() const {
  PulseTable table(layout_.first_pulse, layout_.pulses, sources_.size());
  second_deferred_->stamp(setup_.make_second_estimator,
                          [&table](const DeferredFrame& frame, GlobalTime global) {
                            if (table.holds(frame.pulse)) {
                              table.store(frame.pulse, frame.source, global);
                            }
                          });
  return amd_ms(table);
}

}  // namespace simbench::evaluation

#include "evaluation/scoring/pipeline_scorer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

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
  if (setup_.is_steered) alignment_.emplace(layout, setup_.unsteady_start);
  sources_.assign(cameras, {{}, GenlockOrder(period(), GenlockOrder::Variant::kReanchored)});
  for (std::uint32_t camera = 0; camera < cameras; ++camera) {
    const std::uint32_t host = layout.cameras[camera].host;
    if (host >= cameras_of_host_.size()) cameras_of_host_.resize(host + 1);
    cameras_of_host_[host].push_back(camera);
  }
  if (cameras > 0) make_banks();
}

// Of a camera, after the warm-up; the capture goes on for a while after the last evaluated pulse.
std::size_t PipelineScorer::expected_frames() const {
  return static_cast<std::size_t>(layout_.pulses + layout_.pulses / 8);
}

void PipelineScorer::make_banks() {
  if (setup_.make_estimator) {
    bank_ = make_bank(setup_.make_estimator, sources_.size());
    const DeviceTimeEstimator& any = bank_->at(0);
    relative_ = any.relative();
    offline_ = any.offline();
    stamp_warm_up_ = !offline_ && (relative_ || any.from_first_frame());
  }
  if (setup_.make_second_estimator) {
    second_bank_ = make_bank(setup_.make_second_estimator, sources_.size());
  }
  if (offline_ || second_bank_) kept_.emplace(sources_.size(), expected_frames());
}

// Whether a frame precedes the evaluated part.
inline bool PipelineScorer::in_warm_up(std::int64_t pulse) {
  if (pulse >= layout_.first_pulse) warm_up_over_ = true;
  return pulse == kNoPulse ? !warm_up_over_ : pulse < layout_.first_pulse;
}

inline std::int64_t PipelineScorer::pulse_of(Source& source, const FrameTruth* truth,
                                             DeviceTime sensor) {
  if (!setup_.genlock) return truth != nullptr ? truth->pulse : kNoPulse;
  const std::int64_t index = source.order.next(sensor);
  if (truth == nullptr) return index;
  if (index != truth->pulse - first_true_pulse_) ++genlock_index_errors_;
  return truth->pulse;
}

inline PipelineScorer::Place PipelineScorer::place_of(Source& source, const FrameRecord& frame,
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

void PipelineScorer::on_frames(std::span<const FrameRecord> frames,
                               std::span<const FrameTruth> truths) {
  if (alignment_ && !truths.empty()) note_exposures(frames, truths);
  block_.start(frames.size());
  const FrameTruth* next_truth = truths.data();
  for (const FrameRecord& frame : frames) {
    const FrameTruth* truth = truths.empty() ? nullptr : next_truth++;
    if (frame.stream != setup_.stream) continue;
    SIMBENCH_ASSERT(frame.camera < layout_.cameras.size(),
                    "a frame of a camera that the rig does not have");
    if (!ground_truth_) learn_ground_truth(truth);
    Source& source = sources_[frame.camera];
    const DeviceTime sensor = source.unwrapper.unwrap(frame.sensor);
    const Place place = place_of(source, frame, truth, sensor);
    if (!anchor_) note_anchor(frame);
    if (place.warm_up && !stamp_warm_up_ && !gather_warm_up_) continue;
    if (place.warm_up != is_warm_up_) finish_block();
    is_warm_up_ = place.warm_up;
    if (!place.warm_up && truth != nullptr) {
      table_->store_truth(place.pulse, frame.camera, *truth);
    }
    block_.add(frame.camera, {sensor, frame.arrival, frame.arrival_steady, frame.exposure_us},
               place.pulse, on_global_scale(truth != nullptr ? truth->delivered : frame.arrival));
    if (!place.warm_up && !bank_) block_.stamps().back() = oracle_stamp(truth);
  }
  finish_block();
}

void PipelineScorer::finish_block() {
  if (block_.size() == 0) return;
  if (kept_ && !is_warm_up_) kept_->add(block_);
  if (is_warm_up_ || !offline_) {
    stamp(block_);
    settle(block_);
  }
  block_.clear();
}

void PipelineScorer::stamp(FrameBlock& block) const {
  if (is_warm_up_ && !stamp_warm_up_) {
    std::ranges::transform(block.samples(), block.stamps().begin(), [](const DeviceSample& sample) {
      return on_global_scale(sample.arrival);
    });
  } else if (bank_) {
    bank_->stamp(block.cameras(), block.samples(), block.stamps());
  }
}

void PipelineScorer::settle(FrameBlock& block) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    block.frames()[i].stamp = GlobalTime(Nanoseconds(PulseTable::clamped_ns(block.stamps()[i])));
  }
  if (!is_warm_up_) {
    for (const GatherFrame& frame : block.frames()) {
      table_->store(frame.tag, frame.source, frame.stamp);
    }
    for (std::size_t i = 0; observer_ != nullptr && i < block.size(); ++i) {
      const GatherFrame& frame = block.frames()[i];
      observer_->on_stamp({frame.source, frame.tag, block.samples()[i], frame.arrival},
                          block.stamps()[i]);
    }
  } else if (!gather_warm_up_) {
    return;
  }
  if (unverified_) {
    gatherer_->push_all(block.frames(), *unverified_);
  } else {
    sets_->set_shift(anchor_shift());
    gatherer_->push_all(block.frames(), *sets_);
  }
}

void PipelineScorer::learn_ground_truth(const FrameTruth* truth) {
  if (truth != nullptr) {
    ground_truth_ = GroundTruth::kSimulation;
    first_true_pulse_ = truth->pulse;
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

void PipelineScorer::note_anchor(const FrameRecord& frame) {
  if (!first_arrival_) first_arrival_ = frame.arrival;
  if (anchor_camera_ == frame.camera) anchor_ = frame.arrival;
}

void PipelineScorer::note_exposures(std::span<const FrameRecord> frames,
                                    std::span<const FrameTruth> truths) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].stream == setup_.stream) alignment_->add(frames[i], truths[i]);
  }
}

GlobalTime PipelineScorer::oracle_stamp(const FrameTruth* truth) {
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

void PipelineScorer::on_event(const RecordingEvent& event) {
  if (const auto* pulse = std::get_if<PulseTruth>(&event)) {
    add(*pulse);
  } else if (const auto* adjustment = std::get_if<ClockAdjustment>(&event)) {
    add(*adjustment);
  } else if (const auto* poll = std::get_if<DevicePoll>(&event)) {
    add(*poll);
  } else if (const auto* outcome = std::get_if<SyncOutcome>(&event)) {
    add(*outcome);
  } else if (const auto* report = std::get_if<AlignmentReport>(&event)) {
    add(*report);
  } else if (const auto* sighting = std::get_if<LedSighting>(&event)) {
    add(*sighting);
  }
}

void PipelineScorer::add(const PulseTruth& truth) {
  pulses_with_truth_ = true;
  if (table_->holds(truth.pulse)) host_errors_->add(truth.host_errors);
}

void PipelineScorer::add(const ClockAdjustment& adjustment) {
  if (adjustment.host >= cameras_of_host_.size()) return;  // a host without cameras
  for (const std::uint32_t camera : cameras_of_host_[adjustment.host]) {
    if (bank_) bank_->at(camera).on_adjustment(adjustment);
    if (second_bank_) second_bank_->at(camera).on_adjustment(adjustment);
  }
}

void PipelineScorer::add(const DevicePoll& poll) {
  const DeviceTime device = sources_[poll.camera].unwrapper.unwrap(poll.device);
  const PollSample sample = {device, poll.t0, poll.t1, poll.t0_steady, poll.t1_steady};
  if (bank_) bank_->at(poll.camera).on_poll(sample);
  if (second_bank_) second_bank_->at(poll.camera).on_poll(sample);
}

void PipelineScorer::add(const SyncOutcome& outcome) {
  if (!outcome.synchronised) failures_.push_back(outcome);
}

void PipelineScorer::add(const AlignmentReport& report) {
  if (alignment_) alignment_->add(report);
}

void PipelineScorer::add(const LedSighting& sighting) {
  const LedSample sample = {sources_[sighting.camera].unwrapper.unwrap(sighting.sensor),
                            sighting.middle()};
  if (bank_) bank_->at(sighting.camera).on_led_sighting(sample);
  if (second_bank_) second_bank_->at(sighting.camera).on_led_sighting(sample);
}

SeedScore PipelineScorer::finish() {
  SIMBENCH_ASSERT(table_.has_value(), "a capture starts before it ends");
  if (offline_) stamp_offline();
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
  if (alignment_) {
    alignment_->add_to(score);
    const std::string problem = alignment_->problem();
    if (!problem.empty()) {
      score.cost.notes.push_back("capture_alignment left a camera unaligned: " + problem);
    }
  }
  score.offline_amd_ms = second_bank_ ? second_amd_ms() : kNan;
  score.genlock_index_errors = genlock_index_errors_;
  score.failures = std::move(failures_);
  return score;
}

void PipelineScorer::stamp_offline() {
  is_warm_up_ = false;
  for (std::size_t camera = 0; camera < kept_->cameras(); ++camera) {
    if (!kept_->samples(camera).empty()) bank_->at(camera).learn(kept_->samples(camera));
  }
  kept_->replay([this](FrameBlock& block) {
    stamp(block);
    settle(block);
  });
}

double PipelineScorer::second_amd_ms() {
  PulseRanges ranges(layout_.first_pulse, layout_.pulses);
  std::vector<GlobalTime> stamps;
  for (std::uint32_t camera = 0; camera < kept_->cameras(); ++camera) {
    const std::span<const DeviceSample> samples = kept_->samples(camera);
    if (samples.empty()) continue;
    second_bank_->at(camera).learn(samples);
    stamps.resize(samples.size());
    second_bank_->stamp(std::vector(samples.size(), camera), samples, stamps);
    const std::span<const KeptFrames::Delivery> deliveries = kept_->deliveries(camera);
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      ranges.add(camera, deliveries[i].pulse, stamps[i]);
    }
  }
  return ranges.amd_ms(kept_->cameras());
}

}  // namespace simbench::evaluation

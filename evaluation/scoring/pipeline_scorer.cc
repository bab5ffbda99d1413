#include "evaluation/scoring/pipeline_scorer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "algorithms/ports/assert.h"
#include "evaluation/scoring/frame_order.h"
#include "evaluation/scoring/kept_frames.h"
#include "evaluation/scoring/pulse_account.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/scoring/score_parts.h"
#include "evaluation/scoring/session_scores.h"
#include "evaluation/scoring/stamping.h"
#include "evaluation/scoring/sync_failures.h"
#include "recording/collected.h"

namespace simbench::evaluation {
namespace {

// The first frame decides which order it is; none until then.
using FrameOrder = std::variant<std::monostate, TrueOrder, StampOrder, UnknownOrder>;

GlobalTime on_global_scale(HostTime time) { return GlobalTime(time.time_since_epoch()); }

GlobalTime oracle_stamp(const FrameTruth* truth) {
  if (truth == nullptr) {
    throw RecordingFailed(
        "device_time \"oracle\" needs the true exposure times, which only a simulation has");
  }
  return on_global_scale(truth->own_host);
}

Nanoseconds period_of(const RigLayout& layout) {
  SIMBENCH_ASSERT(layout.frame_rate_hz > 0, "a capture has a frame rate");
  return Nanoseconds(std::llround(1e9 / layout.frame_rate_hz));
}

GatheringSetup gathering_of(const ScorerSetup& setup, const RigLayout& layout) {
  const Nanoseconds period = period_of(layout);
  return {.sources = static_cast<std::uint32_t>(layout.cameras.size()),
          .period = period,
          .interval = Nanoseconds(
              std::llround(static_cast<double>(period.count()) * setup.gathering_interval_periods)),
          .queue_limit = setup.gathering_queue_frames,
          .hosts = layout.hosts,
          .host_of_source = collected(layout.cameras, &CameraLayout::host)};
}

// Returns how many frames a camera may deliver after the warm-up: a capture goes on a while after
// the last evaluated pulse.
std::size_t expected_frames(const RigLayout& layout) {
  return static_cast<std::size_t>(layout.pulses + layout.pulses / 8);
}

}  // namespace

// A capture on its way through the stages under test.
class PipelineScorer::Capture {
 public:
  Capture(const ScorerSetup& setup, const RigLayout& layout, ScoreObserver* observer);

  void add(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths);
  void add(const RecordingEvent& event);
  SeedScore finish();

 private:
  void decide_order(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths);
  template <class Order>
  void place(Order& order, std::span<const FrameRecord> frames, std::span<const FrameTruth> truths);
  void place(std::monostate, std::span<const FrameRecord>, std::span<const FrameTruth>) {}
  // The block's way: device_time, then the table and gathering.
  void finish_block();
  void stamp(FrameBlock& block);
  void settle(FrameBlock& block);
  void stamp_offline();
  void tell_gatherer(const RecordingEvent& event);
  GroundTruth ground_truth() const;

  const ScorerSetup& setup_;
  const RigLayout layout_;
  ScoreObserver* observer_;
  std::unique_ptr<Gatherer> gatherer_;
  Stamping stamping_;
  PulseTable table_;
  PulseAccount account_;
  bool uses_warm_up_;  // device_time or gathering does
  FrameOrder order_;
  FrameBlock block_;                // the frames of one call that are treated alike
  bool is_warm_up_ = true;          // the block
  std::optional<KeptFrames> kept_;  // for offline estimators
  HostErrors host_errors_;
  bool pulses_have_truth_ = false;
  SyncFailures failures_;
  std::vector<ProgramFailure> program_failures_;
  SessionScores sessions_;
  std::vector<std::unique_ptr<ScorePart>> parts_;
};

PipelineScorer::Capture::Capture(const ScorerSetup& setup, const RigLayout& layout,
                                 ScoreObserver* observer)
    : setup_(setup),
      layout_(layout),
      observer_(observer),
      gatherer_(setup.make_gatherer(gathering_of(setup, layout))),
      stamping_(layout, setup.make_estimator),
      table_(layout.first_pulse, layout.pulses, layout.cameras.size()),
      account_(layout.first_pulse, layout.pulses, layout.cameras.size(), setup.due_every),
      uses_warm_up_(stamping_.stamps_warm_up() || gatherer_->from_first_frame()),
      host_errors_(layout.hosts),
      sessions_(layout.hosts) {
  const bool has_second = setup.make_second_estimator && !layout.cameras.empty();
  if (stamping_.is_offline() || has_second) {
    kept_.emplace(layout.cameras.size(), expected_frames(layout));
  }
  if (has_second) {
    parts_.push_back(
        std::make_unique<SecondAmd>(setup.make_second_estimator, layout_, stamping_, *kept_));
  }
  if (setup.is_steered) {
    parts_.push_back(std::make_unique<AlignmentPart>(layout_, setup.unsteady_start, setup.stream));
  }
  if (setup.has_depth_and_colour) parts_.push_back(std::make_unique<ColourPart>(layout_));
}

void PipelineScorer::Capture::add(std::span<const FrameRecord> frames,
                                  std::span<const FrameTruth> truths) {
  for (const auto& part : parts_) part->on_frames(frames, truths);
  if (order_.index() == 0) decide_order(frames, truths);
  block_.start(frames.size());
  std::visit([&](auto& order) { place(order, frames, truths); }, order_);
  finish_block();
}

void PipelineScorer::Capture::decide_order(std::span<const FrameRecord> frames,
                                           std::span<const FrameTruth> truths) {
  const auto first = std::ranges::find(frames, setup_.stream, &FrameRecord::stream);
  if (first == frames.end()) return;
  const FrameTruth* truth = truths.empty() ? nullptr : &truths[first - frames.begin()];
  const OrderParts parts = {
      .layout = layout_, .table = table_, .median = setup_.median, .observer = observer_};
  if (setup_.genlock) {
    order_.emplace<StampOrder>(parts, period_of(layout_), truth);
  } else if (truth != nullptr) {
    order_.emplace<TrueOrder>(parts);
  } else if (setup_.gatherer_needs_pulses) {
    throw RecordingFailed(
        "gathering \"oracle\" needs the pulse of every frame, which only a simulation or a "
        "genlock capture has");
  } else {
    order_.emplace<UnknownOrder>(parts);
  }
}

template <class Order>
void PipelineScorer::Capture::place(Order& order, std::span<const FrameRecord> frames,
                                    std::span<const FrameTruth> truths) {
  const FrameTruth* next_truth = truths.data();
  for (const FrameRecord& frame : frames) {
    const FrameTruth* truth = truths.empty() ? nullptr : next_truth++;
    if (frame.stream != setup_.stream) continue;
    SIMBENCH_ASSERT(frame.camera < layout_.cameras.size(),
                    "a frame of a camera that the rig does not have");
    const DeviceTime sensor = stamping_.unwrap(frame.camera, frame.sensor);
    const FramePlace place = order.place(frame, truth, sensor);
    account_.add(frame.camera, place.pulse, frame.counter);
    stamping_.note(frame);
    if (place.warm_up && !uses_warm_up_) continue;
    if (place.warm_up != is_warm_up_) finish_block();
    is_warm_up_ = place.warm_up;
    if (!place.warm_up && truth != nullptr) table_.store_truth(place.pulse, frame.camera, *truth);
    block_.add(frame.camera, {sensor, frame.arrival, frame.arrival_steady, frame.exposure_us},
               place.pulse, on_global_scale(truth != nullptr ? truth->delivered : frame.arrival));
    if (!place.warm_up && stamping_.is_oracle()) block_.stamps().back() = oracle_stamp(truth);
  }
}

void PipelineScorer::Capture::finish_block() {
  if (block_.size() == 0) return;
  if (kept_ && !is_warm_up_) kept_->add(block_);
  if (is_warm_up_ || !stamping_.is_offline()) {
    stamp(block_);
    settle(block_);
  }
  block_.clear();
}

void PipelineScorer::Capture::stamp(FrameBlock& block) {
  if (is_warm_up_ && !stamping_.stamps_warm_up()) {
    std::ranges::transform(block.samples(), block.stamps().begin(), [](const DeviceSample& sample) {
      return on_global_scale(sample.arrival);
    });
  } else if (!stamping_.is_oracle()) {
    stamping_.stamp(block);
  }
}

void PipelineScorer::Capture::settle(FrameBlock& block) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    block.frames()[i].stamp = GlobalTime(Nanoseconds(PulseTable::clamped_ns(block.stamps()[i])));
  }
  if (!is_warm_up_) {
    for (const GatherFrame& frame : block.frames()) {
      table_.store(frame.tag, frame.source, frame.stamp);
    }
    if (observer_ != nullptr) {
      for (const GatherFrame& frame : block.frames()) observer_->on_stamp(frame);
    }
  } else if (!gatherer_->from_first_frame()) {
    return;
  }
  std::visit(Overloaded{[](std::monostate) {},
                        [&](auto& order) {
                          gatherer_->push_all(block.frames(), order.sets(stamping_.shift()));
                        }},
             order_);
}

void PipelineScorer::Capture::add(const RecordingEvent& event) {
  if (const auto* pulse = std::get_if<PulseTruth>(&event)) {
    pulses_have_truth_ = true;
    if (table_.holds(pulse->pulse)) host_errors_.add(pulse->host_errors);
  } else if (const auto* outcome = std::get_if<SyncOutcome>(&event)) {
    failures_.add(*outcome);
  } else if (const auto* failure = std::get_if<ProgramFailure>(&event)) {
    program_failures_.push_back(*failure);
  } else {
    sessions_.add(event);
    stamping_.on_event(event);
    if (gatherer_->wants_evidence()) tell_gatherer(event);
  }
  for (const auto& part : parts_) part->on_event(event);
}

void PipelineScorer::Capture::tell_gatherer(const RecordingEvent& event) {
  std::visit(
      Overloaded{[&](const ClockAdjustment& adjustment) { gatherer_->on_adjustment(adjustment); },
                 [&](const ExchangeEvent& reported) {
                   gatherer_->on_exchange(reported.host, reported.exchange);
                 },
                 [&](const DevicePoll& poll) {
                   gatherer_->on_poll(poll.camera, stamping_.sample_of(poll));
                 },
                 [](const auto&) {}},
      event);
}

GroundTruth PipelineScorer::Capture::ground_truth() const {
  const GroundTruth without_frames = pulses_have_truth_ ? GroundTruth::kSimulation
                                     : setup_.genlock   ? GroundTruth::kGenlockOrder
                                                        : GroundTruth::kNone;
  return std::visit(Overloaded{[&](std::monostate) { return without_frames; },
                               [](const auto& order) { return order.ground_truth(); }},
                    order_);
}

void PipelineScorer::Capture::stamp_offline() {
  is_warm_up_ = false;
  stamping_.learn(*kept_);
  kept_->replay([this](FrameBlock& block) {
    stamp(block);
    settle(block);
  });
}

SeedScore PipelineScorer::Capture::finish() {
  if (stamping_.is_offline()) stamp_offline();
  const Nanoseconds shift = stamping_.shift();
  if (shift != Nanoseconds(0)) table_.shift(shift);
  if (observer_ != nullptr) observer_->on_shift(shift);
  SeedScore score;
  PulseScoring scoring;
  scoring.median = setup_.median;
  scoring.period = period_of(layout_);
  scoring.pulses_per_frame = setup_.pulses_per_frame;
  scoring.pulses_per_frame_of_source = setup_.pulses_per_frame_of_camera;
  scoring.hosts = layout_.hosts;
  for (const CameraLayout& camera : layout_.cameras) scoring.host_of_source.push_back(camera.host);
  score_pulses(table_, scoring, score);
  std::visit(Overloaded{[](std::monostate) {}, [&](const auto& order) { order.add_to(score); }},
             order_);
  score.ground_truth = ground_truth();
  if (score.ground_truth != GroundTruth::kNone) account_.add_to(score.sets);
  score.sets.discarded_frames = static_cast<std::int64_t>(gatherer_->discarded());
  score.search = gatherer_->place_search();
  if (score.search && score.search->found < score.search->sources) {
    score.cost.notes.push_back(fmt::format("{} of {} cameras did not find their place in the code",
                                           score.search->sources - score.search->found,
                                           score.search->sources));
  }
  score.host_error_ms = host_errors_.mean_absolute_ms();
  host_errors_.time_errors().add_to(score);
  score.host_errors_ms = host_errors_.signed_means_ms();
  for (const auto& part : parts_) part->add_to(score);
  score.failures = failures_.take();
  sessions_.add_to(score);
  score.program_failures = std::move(program_failures_);
  return score;
}

PipelineScorer::PipelineScorer(ScorerSetup setup) : setup_(std::move(setup)) {}

PipelineScorer::~PipelineScorer() = default;

void PipelineScorer::on_start(const RigLayout& layout) {
  capture_ = std::make_unique<Capture>(setup_, layout, observer_);
}

void PipelineScorer::on_frames(std::span<const FrameRecord> frames,
                               std::span<const FrameTruth> truths) {
  capture_->add(frames, truths);
}

void PipelineScorer::on_event(const RecordingEvent& event) { capture_->add(event); }

SeedScore PipelineScorer::finish() {
  SIMBENCH_ASSERT(capture_ != nullptr, "a capture starts before it ends");
  return capture_->finish();
}

}  // namespace simbench::evaluation

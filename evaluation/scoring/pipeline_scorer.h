// Scores one pipeline over one capture, while it is being recorded.
//
// Receives the capture as a RecordingSink, runs device_time and gathering on it block by block, and
// keeps only what the scores need: the global stamps of the evaluated pulses. After the warm-up a
// frame allocates nothing. A source is the scored stream of one camera, numbered like the camera.
// Scores do not depend on how frames come in blocks (RecordingSink::on_frames), or alone.
//
// The rules (docs/design.md section 8):
//  - The truth (the pulse that exposed a frame), or GenLock order on a real genlock rig, tells
//    which frames belong together. Other captures are scored over the sets that gathering emitted,
//    unverified (unverified_scores.h), and every score that needs pulses is NaN. The first frame
//    decides; SeedScore::ground_truth has the result.
//  - device_time and gathering begin where the warm-up ends, with the first evaluated pulse. Only
//    those that request it (relative(), from_first_frame()) get the warm-up too. Frames that no
//    pulse exposed (free-running) are used once another source's evaluated pulse ends the warm-up;
//    they are part of the stream, but never scored.
//  - Stamps of a relative estimator get one anchor for all cameras: the arrival of the first frame
//    of the master's first camera, or of the first frame of all if that camera has none.
//  - An offline estimator stamps when the capture has ended; gathering follows then. Frames wait
//    for it (kept_frames.h).
//
//   PipelineScorer scorer(setup);
//   const RecordingCost cost = source.record({.seed = 1, .pipeline = "mine"}, scorer);
//   SeedScore score = scorer.finish();
#ifndef SIMBENCH_EVALUATION_SCORING_PIPELINE_SCORER_H_
#define SIMBENCH_EVALUATION_SCORING_PIPELINE_SCORER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/device_time/estimator_bank.h"
#include "algorithms/device_time/unwrap.h"
#include "algorithms/gathering/gathering.h"
#include "algorithms/gathering/genlock_order.h"
#include "evaluation/scoring/alignment_scores.h"
#include "evaluation/scoring/kept_frames.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/score_observer.h"
#include "evaluation/scoring/set_counter.h"
#include "evaluation/scoring/unverified_scores.h"
#include "recording/recording.h"

namespace simbench::evaluation {

using GathererFactory = std::function<std::unique_ptr<Gatherer>(const GatheringSetup&)>;

struct ScorerSetup {
  StreamKind stream = StreamKind::kDepth;  // the scored one
  MedianKind median = MedianKind::kUpperMiddle;
  bool genlock = false;                     // sensor stamps give the order of frames
  double gathering_interval_periods = 0.5;  // T_int
  EstimatorFactory make_estimator;          // empty: the oracle, the true time on the own host
  EstimatorFactory make_second_estimator;   // for SeedScore::offline_amd_ms; empty: none
  GathererFactory make_gatherer;
  bool gatherer_needs_pulses = false;  // the oracle of gathering
  bool is_steered = false;             // there may be controls of frames: alignment is scored
  Nanoseconds unsteady_start{};        // of it: so long, cameras' exposures jitter by themselves
};

class PipelineScorer final : public RecordingSink {
 public:
  explicit PipelineScorer(ScorerSetup setup);

  // Notifies `observer` of stamps and sets. Call before the capture starts; it must outlive this.
  void watch(ScoreObserver& observer) { observer_ = &observer; }

  void on_start(const RigLayout& layout) override;
  // Throws RecordingFailed if an oracle of device_time or gathering gets a frame without the truth.
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  // Returns the scores of the capture with pulses, without seed and cost. Call once.
  SeedScore finish();

 private:
  struct alignas(64) Source {
    DeviceStampUnwrapper unwrapper;
    GenlockOrder order;
  };

  struct Place {
    std::int64_t pulse = 0;
    bool warm_up = false;
  };

  void add(const PulseTruth& truth);
  void add(const ClockAdjustment& adjustment);
  void add(const DevicePoll& poll);
  void add(const SyncOutcome& outcome);
  void add(const AlignmentReport& report);
  void add(const LedSighting& sighting);
  void make_banks();
  void learn_ground_truth(const FrameTruth* truth);
  Place place_of(Source& source, const FrameRecord& frame, const FrameTruth* truth,
                 DeviceTime sensor);
  std::int64_t pulse_of(Source& source, const FrameTruth* truth, DeviceTime sensor);
  bool in_warm_up(std::int64_t pulse);
  void note_anchor(const FrameRecord& frame);
  void note_exposures(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths);
  // The block's way: device_time, then the table and gathering.
  void finish_block();
  void stamp(FrameBlock& block) const;
  void settle(FrameBlock& block);
  static GlobalTime oracle_stamp(const FrameTruth* truth);
  // The shift that a relative estimator's stamps lack.
  Nanoseconds anchor_shift() const;
  void stamp_offline();
  double second_amd_ms();
  Nanoseconds period() const;
  std::size_t expected_frames() const;
  GroundTruth ground_truth() const;

  ScorerSetup setup_;
  ScoreObserver* observer_ = nullptr;
  RigLayout layout_;
  std::vector<Source> sources_;
  std::vector<std::vector<std::uint32_t>> cameras_of_host_;
  std::unique_ptr<EstimatorBank> bank_;         // null: the oracle
  std::unique_ptr<EstimatorBank> second_bank_;  // with make_second_estimator
  std::unique_ptr<Gatherer> gatherer_;
  FrameBlock block_;        // the frames of one call that are treated alike
  bool is_warm_up_ = true;  // the block
  bool relative_ = false;
  bool offline_ = false;
  bool stamp_warm_up_ = false;
  bool gather_warm_up_ = false;
  bool warm_up_over_ = false;
  std::optional<std::uint32_t> anchor_camera_;  // the master's first
  std::optional<HostTime> anchor_;
  std::optional<HostTime> first_arrival_;
  std::int64_t first_true_pulse_ = 0;        // of the capture's first frame, with truth
  std::optional<GroundTruth> ground_truth_;  // of the frames, from the first on
  bool pulses_with_truth_ = false;
  // Made when the capture starts.
  std::optional<PulseTable> table_;
  std::optional<SetCounter> sets_;
  std::optional<UnverifiedScores> unverified_;  // in place of sets_, where pulses are not known
  std::optional<HostErrors> host_errors_;
  std::optional<AlignmentScores> alignment_;  // with is_steered
  std::optional<KeptFrames> kept_;            // for offline estimators
  std::int64_t genlock_index_errors_ = 0;
  std::vector<SyncOutcome> failures_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_PIPELINE_SCORER_H_

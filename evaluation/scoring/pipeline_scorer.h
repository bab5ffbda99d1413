// Scores one pipeline over one capture, while it is being recorded.
//
// Receives the capture as a RecordingSink, runs device_time and gathering on it block by block, and
// keeps only what the scores need: the global stamps of the evaluated pulses. After the warm-up a
// frame allocates nothing. A source is the scored stream of one camera, numbered like the camera.
// Scores do not depend on how frames come in blocks (RecordingSink::on_frames), or alone.
//
// Its parts: frame_order.h tells which frames belong together, stamping.h is device_time over all
// cameras, pulse_scores.h and set_counter.h score stamps and sets, score_parts.h what only some
// captures have.
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
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "algorithms/device_time/estimator_bank.h"
#include "algorithms/gathering/gathering.h"
#include "evaluation/scoring/pulse_spread.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/score_observer.h"
#include "recording/recording.h"

namespace simbench::evaluation {

using GathererFactory = std::function<std::unique_ptr<Gatherer>(const GatheringSetup&)>;

struct ScorerSetup {
  StreamKind stream = StreamKind::kDepth;  // the scored one
  MedianKind median = MedianKind::kUpperMiddle;
  bool genlock = false;                                   // sensor stamps give the order of frames
  double gathering_interval_periods = 0.5;                // T_int
  std::optional<std::uint32_t> gathering_queue_frames{};  // empty: the policy's own
  std::int64_t pulses_per_frame = 1;  // a camera exposes at one of so many pulses
  std::vector<std::int64_t> pulses_per_frame_of_camera{};  // where they differ; else empty
  std::int64_t due_every = 1;       // all cameras are to expose at each pulse of such a number
  EstimatorFactory make_estimator;  // empty: the oracle, the true time on the own host
  EstimatorFactory make_second_estimator;  // for SeedScore::offline_amd_ms; empty: none
  GathererFactory make_gatherer;
  bool gatherer_needs_pulses = false;  // the oracle of gathering
  bool is_steered = false;             // there may be controls of frames: alignment is scored
  Nanoseconds unsteady_start{};        // of it: so long, cameras' exposures jitter by themselves
  bool has_depth_and_colour = false;   // a camera has both: their offset is scored
};

class PipelineScorer final : public RecordingSink {
 public:
  explicit PipelineScorer(ScorerSetup setup);
  ~PipelineScorer() override;

  // Notifies `observer` of stamps and sets. Call before the capture starts; it must outlive this.
  void watch(ScoreObserver& observer) { observer_ = &observer; }

  void on_start(const RigLayout& layout) override;
  // Throws RecordingFailed if an oracle of device_time or gathering gets a frame without the truth.
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  // Returns the scores of the capture with pulses, without seed and cost. Call once.
  SeedScore finish();

 private:
  class Capture;

  ScorerSetup setup_;
  ScoreObserver* observer_ = nullptr;
  std::unique_ptr<Capture> capture_;  // from the start on
};

}  // namespace simbench::evaluation

// Parts of a score that only some captures or pipelines have, as observers beside the scorer.
//
//   AlignmentPart  how steered exposures coincide (alignment_scores.h), by their truth
//   ColourPart     how far colour exposes from depth (colour_offset.h), by their truth
//   SecondAmd      the AMD that another, offline estimator would have had of the same frames
//
// A scorer has a list of them: each is told the frames and events of the capture, and asked once in
// the end.
//
//   std::vector<std::unique_ptr<ScorePart>> parts;
//   parts.push_back(std::make_unique<AlignmentPart>(layout, from_ms(5000), StreamKind::kDepth));
//   for (const auto& part : parts) part->on_event(event);
//   for (const auto& part : parts) part->add_to(seed_score);
#pragma once

#include <memory>
#include <span>

#include "algorithms/device_time/estimator_bank.h"
#include "evaluation/scoring/alignment_scores.h"
#include "evaluation/scoring/colour_offset.h"
#include "evaluation/scoring/kept_frames.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/stamping.h"
#include "recording/recording.h"

namespace simbench::evaluation {

class ScorePart {
 public:
  virtual ~ScorePart() = default;
  virtual void on_frames(std::span<const FrameRecord> /*frames*/,
                         std::span<const FrameTruth> /*truths*/) {}
  virtual void on_event(const RecordingEvent& /*event*/) {}
  virtual void add_to(SeedScore& score) = 0;
};

class AlignmentPart final : public ScorePart {
 public:
  AlignmentPart(const RigLayout& layout, Nanoseconds unsteady_start, StreamKind stream)
      : scores_(layout, unsteady_start), stream_(stream) {}

  // Frames without truth do not count.
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;
  // Also notes a camera that was left unaligned.
  void add_to(SeedScore& score) override;

 private:
  AlignmentScores scores_;
  StreamKind stream_;
};

class ColourPart final : public ScorePart {
 public:
  explicit ColourPart(const RigLayout& layout) : offsets_(layout) {}

  // Frames without truth do not count.
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void add_to(SeedScore& score) override { offsets_.add_to(score); }

 private:
  ColourOffset offsets_;
};

class SecondAmd final : public ScorePart {
 public:
  // `stamping` informs the second estimators beside its own; `kept` has the evaluated frames in the
  // end. Both outlive it.
  SecondAmd(const EstimatorFactory& make, const RigLayout& layout, Stamping& stamping,
            const KeptFrames& kept);

  // Sets offline_amd_ms.
  void add_to(SeedScore& score) override;

 private:
  std::unique_ptr<EstimatorBank> bank_;
  std::int64_t first_pulse_;
  std::int64_t pulses_;
  const KeptFrames& kept_;
};

}  // namespace simbench::evaluation

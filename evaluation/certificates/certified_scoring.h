// A capture that is scored and certified at once: the sets that a scorer's gatherer emits, with the
// evidence of when their frames were exposed.
//
//   PipelineScorer scorer(setup);
//   CertifiedScoring both(scorer, assumptions_of(scenario), setup.stream);
//   record_run(source, choice, seed, both);
//   const std::vector<EvidenceSet> sets = both.sets();
//
// What the scorer throws, it throws. Memory: that of CaptureEvidence, and 16 bytes a frame of a
// set.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "evaluation/certificates/capture_evidence.h"
#include "evaluation/certificates/certify.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "evaluation/scoring/score_observer.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// Throws scenarios::InputError for a rig that is too large.
void check_certifiable(const scenarios::Scenario& scenario);

class CertifiedScoring final : public RecordingSink {
 public:
  // `scorer` must outlive this.
  CertifiedScoring(PipelineScorer& scorer, const Assumptions& assumptions, StreamKind stream);

  void on_start(const RigLayout& layout) override;
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override;
  void on_event(const RecordingEvent& event) override;

  const CaptureEvidence& evidence() const { return evidence_; }
  // As CaptureEvidence::add().
  void add(std::uint32_t host, const ExchangeLog& log,
           const std::map<std::string, std::uint32_t>& host_of_address) {
    evidence_.add(host, log, host_of_address);
  }
  // The complete and partial sets. A frame belongs to one; of frames of one camera with one stamp,
  // as after a reset of its clock, the first that belongs to none is meant. O(n log n).
  std::vector<EvidenceSet> sets() const;
  // By set, in the order of their emission (certified_bounds_ms()); empty if facts contradict each
  // other, or none can be made (NotCertifiable).
  std::vector<double> bounds_ms() const;
  // Who takes the scorer's place for one observer passes its sets on to this.
  ScoreObserver& observer() { return collected_; }
  // Sets SeedScore::certified_ms; NaN where that is unknown or facts contradict each other.
  void add_to(SeedScore& score) const;

 private:
  class SetCollector final : public ScoreObserver {
   public:
    using Member = std::pair<std::uint32_t, DeviceTime>;

    void on_stamp(const GatherFrame& /*frame*/) override {}
    void on_set(std::span<const GatherFrame> set, bool complete, GlobalTime now) override;
    void on_shift(Nanoseconds /*shift*/) override {}

    std::vector<std::vector<Member>> sets{};
  };

  PipelineScorer& scorer_;
  CaptureEvidence evidence_;
  SetCollector collected_;
};

// Infinite where nothing bounds it.
double bound_ms(Picoseconds apart);
// By set: no two of its frames are further apart; infinite where nothing bounds it; NaN for a set
// of one frame, which says nothing.
std::vector<double> certified_bounds_ms(const CertifiedCapture& found,
                                        std::span<const EvidenceSet> sets);
// A quantile of bounds in ascending order; infinite where the one above it is; NaN without bounds.
double quantile_of_bounds(const std::vector<double>& apart_ms, double p);

}  // namespace simbench::evaluation

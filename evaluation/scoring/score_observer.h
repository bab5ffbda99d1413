// Observes the stamps and sets of a PipelineScorer while it scores, for figures and timelines.
//
// A score is the same with and without an observer. The cost without one is a test of a pointer per
// block and set. All stamps of a block of frames are told before its sets.
//
//   scorer.watch(observer);
//   source.record(request, scorer);
//   const SeedScore score = scorer.finish();
#pragma once

#include <span>

#include "algorithms/gathering/gathering.h"
#include "algorithms/ports/time.h"

namespace simbench::evaluation {

class ScoreObserver {
 public:
  virtual ~ScoreObserver() = default;
  // A frame after the warm-up, stamped by device_time; its tag is its pulse. An offline estimator
  // stamps when the capture has ended.
  virtual void on_stamp(const GatherFrame& frame) = 0;
  // A set that counts (set_counter.h); `complete` if no source is missing. `now` is the arrival of
  // the frame whose push emitted it.
  virtual void on_set(std::span<const GatherFrame> set, bool complete, GlobalTime now) = 0;
  // Once, at the end: the shift to add to all stamps (a relative estimator's anchor).
  virtual void on_shift(Nanoseconds shift) = 0;
};

}  // namespace simbench::evaluation

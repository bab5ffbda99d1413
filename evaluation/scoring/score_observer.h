// What a PipelineScorer can be asked to show while it scores: stamps and sets as they come.
//
// For figures and timelines. A score is the same with and without an observer, which costs a test
// of a pointer per frame and set where there is none.
//
//   scorer.watch(observer);
//   source.record(request, scorer);
//   const SeedScore score = scorer.finish();
#ifndef SIMBENCH_EVALUATION_SCORING_SCORE_OBSERVER_H_
#define SIMBENCH_EVALUATION_SCORING_SCORE_OBSERVER_H_

#include <span>

#include "algorithms/gathering/gathering.h"
#include "algorithms/ports/time.h"
#include "evaluation/scoring/deferred_stamps.h"

namespace simbench::evaluation {

class ScoreObserver {
 public:
  virtual ~ScoreObserver() = default;
  // The stamp that device_time gave a frame after the warm-up; an offline estimator stamps when
  // the capture has ended.
  virtual void on_stamp(const DeferredFrame& frame, GlobalTime global) = 0;
  // A set that counts (set_counter.h): `complete` if no source lacks; emitted when a frame was
  // pushed that arrived at `now`.
  virtual void on_set(std::span<const GatherFrame> set, bool complete, GlobalTime now) = 0;
  // Once, at the end: what has to be added to all stamps (a relative estimator's anchor).
  virtual void on_shift(Nanoseconds shift) = 0;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_SCORE_OBSERVER_H_

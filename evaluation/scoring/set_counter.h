// Counts the sets a gatherer emits, how many of them are right, and how late they are.
//
// Frames carry their pulse as their tag (-1: of no pulse). A set counts when one of its members
// belongs to an evaluated pulse; it is pure when all members belong to that one. Scores over sets
// are over complete ones:
//  - range of the stamps, so that AMD shows what gathering did (a strict policy makes it small by
//    giving sets up: look at recall too);
//  - |stamp - reference| of members of evaluated pulses, if there is truth;
//  - emission latency: arrival of the frame whose push emitted the set, minus the latest arrival of
//    a member. Arrivals are true in a simulation; on a rig they are as good as the hosts' clocks.
//
//   SetCounter sets(table);
//   sets.before_push(frame.arrival, shift);
//   gatherer.push(frame, sets);
//   sets.score(seed_score);
#ifndef SIMBENCH_EVALUATION_SCORING_SET_COUNTER_H_
#define SIMBENCH_EVALUATION_SCORING_SET_COUNTER_H_

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/score_observer.h"

namespace simbench::evaluation {

class SetCounter final : public FrameSetSink {
 public:
  // The table says which pulses are evaluated, and knows the references; it must outlive this, and
  // so must the observer, who is shown the sets that count (null: nobody is).
  explicit SetCounter(const PulseTable& table, ScoreObserver* observer = nullptr)
      : table_(table), observer_(observer) {}

  // The arrival of the frame that is to be pushed next, and what is to be added to the stamps of
  // sets before they are compared with the reference (an estimator may not know the epoch).
  void before_push(GlobalTime arrival, Nanoseconds shift) {
    now_ = arrival;
    shift_ = shift;
  }

  void on_set(std::span<const GatherFrame> set) override;
  void on_partial_set(std::span<const GatherFrame> set) override;

  // Fills in what of score.sets and the scores over sets is counted here.
  void score(SeedScore& score) const;

 private:
  bool counts(std::span<const GatherFrame> set) const;
  std::int64_t index_errors(std::span<const GatherFrame> set);
  void add_errors(std::span<const GatherFrame> set);

  const PulseTable& table_;
  ScoreObserver* observer_;
  GlobalTime now_{};
  Nanoseconds shift_{};
  std::int64_t emitted_ = 0;
  std::int64_t pure_ = 0;
  std::int64_t partial_ = 0;
  std::int64_t index_errors_ = 0;
  double range_sum_ms_ = 0;
  double error_sum_ms_ = 0;
  std::int64_t errors_ = 0;
  double latency_sum_ms_ = 0;
  double latency_max_ms_ = 0;
  std::vector<std::int64_t> tags_;  // workspace
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_SET_COUNTER_H_

// Counts the sets that a gatherer emits, the correct ones among them, and their latency.
//
// Frames have their pulse as their tag (-1: none). A set counts when one of its members belongs to
// an evaluated pulse; it is pure when all members belong to that one. Scores are over complete
// sets:
//  - range of the stamps, so that AMD shows the effect of gathering (a strict policy makes it small
//    by giving sets up: see recall too);
//  - |stamp - reference| of members of evaluated pulses, with truth;
//  - emission latency: arrival of the frame whose push emitted the set, minus the latest arrival of
//    a member. Arrivals are true in a simulation; on a rig they are as good as the hosts' clocks.
//
//   SetCounter sets(table);
//   gatherer.push_all(block.frames(), sets);
//   sets.score(seed_score);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "evaluation/scoring/pulse_scores.h"
#include "evaluation/scoring/results.h"
#include "evaluation/scoring/score_observer.h"

namespace simbench::evaluation {

class SetCounter final : public TimedSetSink {
 public:
  // The table has the evaluated pulses and the references. The observer (or null) is notified of
  // the sets that count. Both must outlive this.
  explicit SetCounter(const PulseTable& table, ScoreObserver* observer = nullptr)
      : table_(table), observer_(observer) {}

  // What to add to the stamps of sets from now on before the comparison with the reference (an
  // estimator may not know the epoch).
  void set_shift(Nanoseconds shift) { shift_ = shift; }

  void on_set(std::span<const GatherFrame> set) override;
  void on_partial_set(std::span<const GatherFrame> set) override;

  // Sets the counted part of score.sets and the scores over sets.
  void score(SeedScore& score) const;

 private:
  bool counts(std::span<const GatherFrame> set) const;
  std::int64_t index_errors(std::span<const GatherFrame> set);
  void add_errors(std::span<const GatherFrame> set);

  const PulseTable& table_;
  ScoreObserver* observer_;
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

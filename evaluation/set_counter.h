// Counts the sets a gatherer emits, and how many of them are right.
//
// Frames carry their pulse as their tag (-1: of no pulse). A set counts when one of its members
// belongs to an evaluated pulse; it is pure when all members belong to that one.
#ifndef SIMBENCH_EVALUATION_SET_COUNTER_H_
#define SIMBENCH_EVALUATION_SET_COUNTER_H_

#include <cstdint>
#include <span>

#include "algorithms/gathering/gathering.h"

namespace simbench::evaluation {

class SetCounter final : public FrameSetSink {
 public:
  // Evaluated are the pulses [first_pulse, first_pulse + pulses).
  SetCounter(std::int64_t first_pulse, std::int64_t pulses)
      : first_pulse_(first_pulse), end_(first_pulse + pulses) {}

  void on_set(std::span<const GatherFrame> set) override;

  std::int64_t emitted() const { return emitted_; }
  std::int64_t pure() const { return pure_; }

 private:
  std::int64_t first_pulse_;
  std::int64_t end_;
  std::int64_t emitted_ = 0;
  std::int64_t pure_ = 0;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SET_COUNTER_H_

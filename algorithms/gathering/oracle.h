// Gathering by the truth: the frames of one trigger pulse, known by the pulse that exposed them.
//
// GatherFrame::tag must be the true pulse, which only a simulation can tell (Need::kTruth); a frame
// of no pulse (tag below 0) is given up. A set is emitted as soon as every source has delivered its
// frame of one pulse, and older, incomplete pulses are given up then. Nothing can gather better:
// its recall is 1 unless a queue overflows.
//
// Complexity and memory: gathering/front_matcher.h.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_ORACLE_H_
#define SIMBENCH_ALGORITHMS_GATHERING_ORACLE_H_

#include <memory>

#include "algorithms/gathering/gathering.h"

namespace simbench {

std::unique_ptr<Gatherer> make_oracle_gatherer(const GatheringSetup& setup);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_ORACLE_H_

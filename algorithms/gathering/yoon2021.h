// Gathering by Algorithm 3 of the paper, as a streaming class with bounded queues.
//
// A queue of global stamps per source. While no queue is empty: if the fronts' range is less than
// T_int (GatheringSetup::interval, which must be positive), they are a set and all are popped; else
// the earliest front is given up. Of equal fronts the one of the lowest source is given up.
//
// What to expect: no set has a range of T_int or more; a missing frame never blocks, but its whole
// instant is given up, as there are no partial sets; a set waits for the slowest source. A constant
// offset of T_int or more between two sources gives no set at all, and one of about a period gives
// wrong sets silently: T_int of half a period or less, and stamps better than that.
//
// Complexity and memory: gathering/front_matcher.h. Source: docs/reference/paper.md section 5.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_YOON2021_H_
#define SIMBENCH_ALGORITHMS_GATHERING_YOON2021_H_

#include <memory>

#include "algorithms/gathering/gathering.h"

namespace simbench {

std::unique_ptr<Gatherer> make_yoon2021_gatherer(const GatheringSetup& setup);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_YOON2021_H_

// Gathering by the ApproximateEpsilonTime policy of ROS 2: sets no wider than epsilon.
//
// While every source has a front: if all fronts are within epsilon (GatheringSetup::interval,
// itself allowed) of the earliest, they are a set; else every front within epsilon of the earliest
// is given up.
//
// What to expect: as Algorithm 3 (gathering/yoon2021.h), but where that gives up one frame, this
// gives up all that lie with it, which costs a good set now and then when stamps are noisy. Sets do
// not cross, each frame is used at most once, there are no partial sets. A full queue drops its
// oldest frame.
//
// Complexity: O(log n) per frame given up, O(n) per set. Memory: n * queue_limit frames.
// Source: ros2/message_filters sync_policies/approximate_epsilon_time; docs/reference/gathering.md.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_EPSILON_H_
#define SIMBENCH_ALGORITHMS_GATHERING_EPSILON_H_

#include <memory>

#include "algorithms/gathering/gathering.h"

namespace simbench {

std::unique_ptr<Gatherer> make_epsilon_gatherer(const GatheringSetup& setup);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_EPSILON_H_

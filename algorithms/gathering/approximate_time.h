// Gathering by the ApproximateTime policy of ROS: the narrowest sets, whatever their width.
//
// A candidate is the fronts of all queues, from its earliest to its latest stamp. The source with
// the latest front of the first candidate is the pivot: every set found in this search holds that
// frame. The earliest front steps aside again and again; the fronts replace the candidate if they
// are narrower by more than the penalty for being later,
//   (end - candidate end) * (1 + age_penalty) < start - candidate start,
// and the candidate is emitted once no later one can do that: when the pivot itself would step
// aside, or (end - candidate end) * (1 + age_penalty) >= pivot - candidate start. Where a queue has
// run empty the search goes on with the earliest stamp its next frame can have, which is that of
// its last frame plus `lower_bound`, or the pivot's if that is later; if this decides nothing, it
// is undone until a frame comes. A full queue drops its oldest frame and with it the candidate;
// until a candidate without that source as pivot has passed, the source is no pivot.
//
// What to expect: each frame is used at most once, sets do not cross, and only stamps matter, not
// the order of arrival. Without a lower bound a set waits about one period for the proof that it is
// the best; without a largest interval, a lost frame gives a set with a frame of another exposure.
// Stamps of a source should increase; if they do not, its frames still leave in order of arrival,
// and no search is endless.
//
// Complexity: O(log n) per frame that steps aside, O(n) per set; steps that decided nothing are not
// taken again until a frame comes that may change that. Memory: n * (queue + 1) frames.
// Source: ros_comm message_filters sync_policies/approximate_time.h; docs/reference/gathering.md.
//
//   auto gatherer = make_approximate_time_gatherer(setup, {.lower_bound = setup.period / 2});
#ifndef SIMBENCH_ALGORITHMS_GATHERING_APPROXIMATE_TIME_H_
#define SIMBENCH_ALGORITHMS_GATHERING_APPROXIMATE_TIME_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/gathering/gathering.h"

namespace simbench {

struct ApproximateTimeOptions {
  double age_penalty = 0.1;    // not negative
  Nanoseconds lower_bound{};   // between two frames of a source; 0: none is known
  Nanoseconds max_interval{};  // of a set, itself allowed; 0: any
  std::uint32_t queue = 10;    // frames per source, if setup.queue_limit is not smaller
  // By source, in place of lower_bound; empty: that holds for all.
  std::vector<Nanoseconds> lower_bounds{};
};

std::unique_ptr<Gatherer> make_approximate_time_gatherer(const GatheringSetup& setup,
                                                         const ApproximateTimeOptions& options);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_APPROXIMATE_TIME_H_

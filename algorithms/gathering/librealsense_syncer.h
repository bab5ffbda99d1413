// Gathering like the default matcher of librealsense's syncer, here for any number of sources.
//
// Two stamps are equivalent if they are less than half a gap apart; the gap is the frame period.
// When a frame arrives, the earliest front and all fronts equivalent to it are a group. If a later
// front waits beside the group, the group is emitted at once. Else it waits for every source that
// has no front but may still belong to it: one whose next frame - expected a gap after its last -
// is equivalent to the group's earliest, or overdue against the newest arrival by less than seven
// gaps. A source overdue by more, or one that has delivered nothing yet, is inactive: nobody waits
// for it until it delivers again. Groups of all sources are sets, smaller ones are partial sets
// (FrameSetSink::on_partial_set), singles included.
//
// What to expect: frames are never held long and hardly any is given up (only by a full queue);
// partial sets are the rule where frames are lost. The first frames come out alone, as no source is
// known before its first. Between hosts it pairs neighbouring exposures as soon as the stamps are
// half a period apart. Sets do not cross and are less than half a gap wide.
//
// Not taken over: the original makes one such matcher per device and never pairs two devices; it
// knows each stream's own rate, where this one has one period for all; it compares fronts in the
// order of addresses in memory, which only matters from three sources on and here is by time.
//
// Complexity: O(1) per frame that waits, O(n) per set, partial or not. Memory: n * queue_limit.
// Source: librealsense src/sync.cpp (timestamp_composite_matcher); docs/reference/d455.md
// section 6.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_LIBREALSENSE_SYNCER_H_
#define SIMBENCH_ALGORITHMS_GATHERING_LIBREALSENSE_SYNCER_H_

#include <memory>

#include "algorithms/gathering/gathering.h"

namespace simbench {

// Uses GatheringSetup::period, not interval.
std::unique_ptr<Gatherer> make_librealsense_gatherer(const GatheringSetup& setup);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_LIBREALSENSE_SYNCER_H_

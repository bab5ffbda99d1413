// Gathering like the Azure Kinect's pairing of colour and depth, here for any number of sources.
//
// Source 0 is the reference. Its front at t opens a window for every other source,
//   [t - P/4 + delay, t + 3P/4 + delay],
// ends included. A front later than the window's end: the reference's front is given up. Earlier
// than its begin: that front is given up. All in their windows: they are a set. `delay` is how much
// later than the reference the others are exposed on purpose. A full queue drops its oldest frame.
//
// What to expect: a pair forms as soon as both are there. The window is a whole period long but
// leans to the late side: frames that should be equal pair with their neighbours as soon as one is
// P/4 early, so the stamps' noise must stay below that. Sets do not cross; no partial sets.
//
// Not taken over: the original's stamps start near 0 and are unsigned, so that its first windows
// are cut at 0; stamps here have no such end.
//
// Complexity: O(1) amortised per frame, O(n) per frame of the reference. Memory: n * queue_limit.
// Source: Azure-Kinect-Sensor-SDK src/capturesync/capturesync.c; docs/reference/gathering.md.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_K4A_CAPTURE_SYNC_H_
#define SIMBENCH_ALGORITHMS_GATHERING_K4A_CAPTURE_SYNC_H_

#include <memory>

#include "algorithms/gathering/gathering.h"

namespace simbench {

// Uses GatheringSetup::period, not interval.
std::unique_ptr<Gatherer> make_k4a_gatherer(const GatheringSetup& setup,
                                            Nanoseconds delay = Nanoseconds::zero());

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_K4A_CAPTURE_SYNC_H_

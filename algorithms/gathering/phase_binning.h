// Gathering by the phase of a common frame period: each frame belongs to the nearest grid point.
//
// The stamps of all sources together define a grid, phase + k * period: a frame belongs to slot
// k = round((t - phase) / period), and a slot that has a frame of every source is a set. The phase
// is the running circular mean of the stamps modulo the period, in which a frame weighs `decay`
// times its successor. The grid is
// carried on from frame to frame, so a period that is a little wrong never adds up.
//
// What to expect: the best policy for noisy stamps, as up to half a period from the *mean* is
// allowed and no frame is compared with another; but it needs a rig whose sources really share one
// stable phase, and sources whose constant offsets differ by half a period give mixed sets. A
// frame whose source already has one in the slot is given up, as are slots older than the last set
// (sets do not cross while a source's stamps increase) and frames that come for them. No partial
// sets. At most queue_limit slots are open; the frame that needs another one's place gets it.
// Stamps that fall back by queue_limit periods or more begin anew: nothing is too old then.
//
// Complexity: O(1) per frame, O(n) per slot. Memory: n * queue_limit frames.
// Source: practice of genlock rigs; docs/reference/gathering.md.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_PHASE_BINNING_H_
#define SIMBENCH_ALGORITHMS_GATHERING_PHASE_BINNING_H_

#include <memory>

#include "algorithms/gathering/gathering.h"

namespace simbench {

// Uses GatheringSetup::period (at least a microsecond), not interval. `decay` is in [0, 1).
std::unique_ptr<Gatherer> make_phase_binning_gatherer(const GatheringSetup& setup,
                                                      double decay = 0.98);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_PHASE_BINNING_H_

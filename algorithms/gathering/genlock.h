// Gathering by GenLock order: a set is the frames of one trigger pulse, known by counting.
//
// The ground truth of the paper. Each source's frames get the index of their pulse from their
// sensor stamps (gathering/genlock_order.h); a set is emitted as soon as every source has delivered
// its frame of one index, and older, incomplete indices are given up. Global stamps are not looked
// at. Needs a capture whose cameras all start with one pulse.
//
// GatheringSetup::period is the nominal frame period. Complexity and memory:
// gathering/front_matcher.h. Source: docs/reference/paper.md sections 5 and 8.
#ifndef SIMBENCH_ALGORITHMS_GATHERING_GENLOCK_H_
#define SIMBENCH_ALGORITHMS_GATHERING_GENLOCK_H_

#include <memory>

#include "algorithms/gathering/gathering.h"
#include "algorithms/gathering/genlock_order.h"

namespace simbench {

std::unique_ptr<Gatherer> make_genlock_gatherer(const GatheringSetup& setup,
                                                GenlockOrder::Variant variant);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_GATHERING_GENLOCK_H_

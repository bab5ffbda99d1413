// How a backend tells how far a run is: which share of its simulated time is over, from 0 to 1, now
// and then, on the thread that runs it. It must not throw, and never changes the run.
//
//   const ShareDone share_done = [](double share) { print(share); };
//   if (share_done) share_done(0.25);
#pragma once

#include <functional>

namespace simbench {

using ShareDone = std::function<void(double share)>;

}  // namespace simbench

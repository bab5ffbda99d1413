// Runs several coroutines at the same time and waits for all of them.
//
// They run interleaved on the executor of the caller, never in parallel threads. If one throws, the
// others are cancelled (their pending waits must honour cancellation); once they have ended, the
// exception of the first that failed is thrown. Cancelling the caller cancels them all.
//
//   std::vector<Task<void>> tasks;
//   for (PeerId peer : peers) tasks.push_back(serve(host, peer));
//   co_await join_all(std::move(tasks));
#pragma once

#include <vector>

#include "algorithms/ports/host.h"

namespace simbench {

Task<void> join_all(std::vector<Task<void>> tasks);

}  // namespace simbench

#include "algorithms/host_sync/limits.h"

namespace simbench {

Task<void> NoHostSync::run_master(Host& /*host*/, std::vector<PeerId> /*slaves*/) { co_return; }

Task<void> NoHostSync::run_slave(Host& /*host*/, PeerId /*master*/) { co_return; }

}  // namespace simbench

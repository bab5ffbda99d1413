#include "algorithms/host_sync/two_way/two_way.h"

#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/two_way/two_way_probe.h"
#include "algorithms/host_sync/two_way/two_way_slave.h"

namespace simbench {

Task<void> TwoWay::run_master(Host& host, std::vector<PeerId> slaves) {
  auto clock = std::make_shared<SteeredClock>(host, settings_.steering);
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size());
  for (const PeerId slave : slaves) {
    servers.push_back(serve_two_way(host, slave, clock, settings_.is_naive));
  }
  co_await join_all(std::move(servers));
}

Task<void> TwoWay::run_slave(Host& host, PeerId master) {
  TwoWaySlave slave(host, master, settings_, make_estimator_());
  co_await slave.run();
}

}  // namespace simbench

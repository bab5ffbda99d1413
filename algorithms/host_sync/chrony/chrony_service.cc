#include "algorithms/host_sync/chrony/chrony_service.h"

#include <utility>

#include "algorithms/host_sync/chrony/chrony_client.h"
#include "algorithms/host_sync/join.h"

namespace simbench {

Task<void> ChronyService::run_master(Host& host, std::vector<PeerId> slaves) {
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size());
  for (const PeerId slave : slaves) servers.push_back(serve_ntp(host, slave));
  co_await join_all(std::move(servers));
}

Task<void> ChronyService::run_slave(Host& host, PeerId master) {
  ChronyClient client(host, master, settings_);
  co_await client.run();
}

}  // namespace simbench

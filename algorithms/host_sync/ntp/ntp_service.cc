#include "algorithms/host_sync/ntp/ntp_service.h"

#include <cmath>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/ntp/ntp_client.h"

namespace simbench {

NtpService::NtpService(const NtpSettings& settings) : settings_(settings) {
  if (settings_.mode == NtpMode::kUnicast) return;
  const int poll =
      static_cast<int>(std::lround(std::log2(to_seconds(settings.broadcast_interval))));
  settings_.discipline.poll_min = poll;
  settings_.discipline.poll_max = poll;
}

Task<void> NtpService::run_master(Host& host, std::vector<PeerId> slaves) {
  std::vector<Task<void>> servers;
  servers.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) servers.push_back(serve_ntp(host, slave));
  if (settings_.mode != NtpMode::kUnicast) {
    servers.push_back(broadcast_ntp(host, std::move(slaves), settings_.broadcast_interval));
  }
  co_await join_all(std::move(servers));
}

Task<void> NtpService::run_slave(Host& host, PeerId master) {
  NtpClient client(host, master, settings_);
  co_await client.run();
}

}  // namespace simbench

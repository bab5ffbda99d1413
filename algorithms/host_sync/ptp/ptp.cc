#include "algorithms/host_sync/ptp/ptp.h"

#include <memory>
#include <utility>

#include "algorithms/host_sync/join.h"
#include "algorithms/host_sync/ptp/ptp_master.h"
#include "algorithms/host_sync/ptp/ptp_slave.h"

namespace simbench {
namespace {

Task<void> serve(Host& host, PeerId slave, PtpSettings settings,
                 std::shared_ptr<const bool> is_ready) {
  PtpMaster master(host, slave, settings, std::move(is_ready));
  co_await master.run();
}

// The master's card follows its system clock.
Task<void> couple_card(Host& host, PtpSettings settings, std::shared_ptr<bool> is_ready) {
  ClockCoupling coupling(host, ClockKind::kHardware, settings);
  while (true) {
    co_await coupling.update();
    *is_ready = coupling.is_locked();
    co_await host.sleep_for(ClockCoupling::kInterval);
  }
}

}  // namespace

Task<void> Ptp::run_master(Host& host, std::vector<PeerId> slaves) {
  const bool needs_card = settings_.has_hardware_stamps;
  // The slaves will report that nobody sends.
  if (needs_card && host.hardware_clock() == nullptr) co_return;
  auto is_ready = std::make_shared<bool>(!needs_card);
  std::vector<Task<void>> tasks;
  tasks.reserve(slaves.size() + 1);
  for (const PeerId slave : slaves) tasks.push_back(serve(host, slave, settings_, is_ready));
  if (needs_card) tasks.push_back(couple_card(host, settings_, is_ready));
  co_await join_all(std::move(tasks));
}

Task<void> Ptp::run_slave(Host& host, PeerId master) {
  PtpSlave slave(host, master, settings_);
  co_await slave.run();
}

}  // namespace simbench

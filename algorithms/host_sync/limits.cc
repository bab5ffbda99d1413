// The limits that host_sync is compared with: rows in which no protocol runs.
//
//   free_running  every system clock keeps its arbitrary initial offset
//   ntp_last_set  the clocks were right hours ago and have run free since: the paper's row "None",
//                 whose hosts had Windows time but differed by half a second
//                 (docs/reference/paper.md section 8, docs/reference/calibration.md section 2)
//   oracle        every host reads the master's clock: the limit that no protocol can pass
//
// They differ only in the initial clocks; both sides return at once.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

class NoHostSync : public HostSync {
 public:
  explicit NoHostSync(InitialClocks initial_clocks) : initial_clocks_(initial_clocks) {}
  InitialClocks initial_clocks() const override { return initial_clocks_; }
  bool is_idle() const override { return true; }
  bool can_relay() const override { return true; }
  Task<void> run_master(Host& /*host*/, std::vector<PeerId> /*slaves*/) override { co_return; }
  Task<void> run_slave(Host& /*host*/, PeerId /*master*/) override { co_return; }

 private:
  InitialClocks initial_clocks_;
};

HostSyncEntry limit(const std::string& name, std::string summary, std::string source,
                    InitialClocks initial_clocks) {
  return {.info = {.name = name,
                   .family = name,
                   .summary = std::move(summary),
                   .source = std::move(source)},
          .make = [initial_clocks](const Parameters&) {
            return std::make_unique<NoHostSync>(initial_clocks);
          }};
}

}  // namespace

std::vector<HostSyncEntry> host_sync_limits() {
  return {
      limit("free_running", "no synchronisation: clocks start at arbitrary offsets",
            "a limit, for comparison", InitialClocks::kUnsynchronised),
      limit("ntp_last_set", "the paper's row None: clocks set hours ago, free-running since",
            "Yoon et al. 2021, Tables 2 and 3; docs/reference/calibration.md section 2",
            InitialClocks::kLastSet),
      limit("oracle", "every host reads the master's clock", "a limit, for comparison",
            InitialClocks::kMaster),
  };
}

}  // namespace simbench

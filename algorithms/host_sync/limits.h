// What host_sync is compared with: the rows in which no protocol runs.
//
//   free_running  every system clock keeps its arbitrary initial offset
//   ntp_last_set  the clocks were right hours ago and have run free since: the paper's row "None",
//                 whose hosts had Windows time but differed by half a second
//                 (docs/reference/paper.md section 8, docs/reference/calibration.md section 2)
//   oracle        every host reads the master's clock: the limit that no protocol can pass
//
// They differ in the clocks they start from alone; both sides return at once.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_LIMITS_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_LIMITS_H_

#include "algorithms/ports/host_sync.h"

namespace simbench {

class NoHostSync : public HostSync {
 public:
  explicit NoHostSync(InitialClocks initial_clocks) : initial_clocks_(initial_clocks) {}
  InitialClocks initial_clocks() const override { return initial_clocks_; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  InitialClocks initial_clocks_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_LIMITS_H_

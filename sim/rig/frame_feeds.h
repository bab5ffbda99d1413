// Passes delivered frames on to the programs of their hosts that asked for them.
//
// Only frames of the scored stream (scenario /evaluation/stream), and only to hosts that have
// opened their feed (sim/host/sim_frame_feed.h). Cost of a frame that nobody wants: two
// comparisons.
//
//   FrameFeeds feeds(scenario, hosts);
//   capture.observe_frames(feeds);
#ifndef SIMBENCH_SIM_RIG_FRAME_FEEDS_H_
#define SIMBENCH_SIM_RIG_FRAME_FEEDS_H_

#include "scenarios/scenario.h"
#include "sim/host/host_group.h"
#include "sim/rig/frame_observer.h"

namespace simbench::sim {

class FrameFeeds final : public FrameObserver {
 public:
  // `hosts` must outlive this.
  FrameFeeds(const scenarios::Scenario& scenario, HostGroup& hosts);

  void on_delivery(std::uint32_t host, const FrameRecord& frame, double bytes) override;

 private:
  HostGroup& hosts_;
  StreamKind scored_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_FRAME_FEEDS_H_

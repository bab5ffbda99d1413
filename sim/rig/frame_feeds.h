// What hosts do with the frames that were delivered to them, besides recording them.
//
//  - Programs that asked for them get the frames of the scored stream (scenario /evaluation/stream)
//    through their host's feed (sim/host/sim_frame_feed.h).
//  - capture_traffic_share of every frame's bytes, of all streams, leaves through the host's switch
//    port (sim/network/network.h), in phase with the trigger as the frames are.
//
// Cost of a frame that nobody wants: a few comparisons; neither use of frames costs an event.
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
  double traffic_share_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_FRAME_FEEDS_H_

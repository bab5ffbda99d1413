// What a simulated host's own programs see of its cameras' frames: a queue that the rig fills.
//
// A frame is there at the instant of its delivery and next() returns at that instant: the stamps of
// a frame already hold everything that made it late. Of frames that nobody has asked for, the last
// 1024 are kept. A feed exists only from the host's first frame_feed() on; until then frames pass
// without a trace, and afterwards a frame that nobody waits for costs no event.
//
//   SimFrameFeed feed(host);
//   feed.push(frame);                         // by the rig, at the frame's delivery
//   auto next = co_await feed.next(steady_deadline);  // by an algorithm
#ifndef SIMBENCH_SIM_HOST_SIM_FRAME_FEED_H_
#define SIMBENCH_SIM_HOST_SIM_FRAME_FEED_H_

#include <deque>
#include <optional>

#include "algorithms/ports/host.h"
#include "sim/engine/virtual_executor.h"

namespace simbench::sim {

class SimHost;

class SimFrameFeed final : public FrameFeed {
 public:
  // `host` must outlive the feed.
  explicit SimFrameFeed(SimHost& host);

  Task<std::optional<FrameArrival>> next(SteadyTime deadline) override;

  void push(const FrameArrival& frame);

 private:
  SimHost& host_;
  WaitPoint delivered_;
  std::deque<FrameArrival> frames_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_SIM_FRAME_FEED_H_

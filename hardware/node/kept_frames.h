// The feed of a real host's own frames: what its cameras delivered, the last 1024 of it.
//
// One coroutine waits at a time (algorithms/ports/host.h).
//
//   KeptFrames frames(context, clock);
//   frames.deliver(frame);                        // by the node
//   auto next = co_await frames.next(deadline);   // by an algorithm
#ifndef SIMBENCH_HARDWARE_NODE_KEPT_FRAMES_H_
#define SIMBENCH_HARDWARE_NODE_KEPT_FRAMES_H_

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/circular_buffer.hpp>
#include <cstddef>
#include <optional>

#include "algorithms/ports/host.h"
#include "hardware/clock/node_clock.h"

namespace simbench::hardware {

class KeptFrames final : public FrameFeed {
 public:
  static constexpr std::size_t kKept = 1024;

  KeptFrames(boost::asio::io_context& context, const NodeClock& clock);

  Task<std::optional<FrameArrival>> next(SteadyTime deadline) override;
  void deliver(const FrameArrival& frame);

 private:
  const NodeClock& clock_;
  boost::asio::steady_timer waiting_;
  boost::circular_buffer<FrameArrival> frames_{kKept};
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_KEPT_FRAMES_H_

// The newest frames of a host's cameras, until an algorithm asks for them.
//
// The last kKept that came while no coroutine waited are kept. One coroutine waits at a time
// (algorithms/ports/host.h). One thread, the one that runs `context`.
//
//   NodeFrameFeed frames(context, clock);
//   frames.deliver({.camera = 3, .counter = 1});
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/circular_buffer.hpp>
#include <cstddef>
#include <optional>

#include "algorithms/ports/host.h"
#include "hardware/clock/node_clock.h"

namespace simbench::hardware {

class NodeFrameFeed final : public FrameFeed {
 public:
  static constexpr std::size_t kKept = 1024;

  NodeFrameFeed(boost::asio::io_context& context, const NodeClock& clock);

  Task<std::optional<FrameArrival>> next(SteadyTime deadline) override;
  void deliver(const FrameArrival& frame);

 private:
  const NodeClock& clock_;
  boost::asio::steady_timer waiting_;
  boost::circular_buffer<FrameArrival> frames_{kKept};
};

}  // namespace simbench::hardware

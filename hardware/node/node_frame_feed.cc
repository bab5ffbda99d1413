#include "hardware/node/node_frame_feed.h"

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace simbench::hardware {

NodeFrameFeed::NodeFrameFeed(boost::asio::io_context& context, const NodeClock& clock)
    : clock_(clock), waiting_(context) {}

Task<std::optional<FrameArrival>> NodeFrameFeed::next(SteadyTime deadline) {
  while (frames_.empty()) {
    if (clock_.steady_at(monotonic_now()) >= deadline) co_return std::nullopt;
    waiting_.expires_at(for_timer(clock_.oscillator().when(deadline)));
    boost::system::error_code delivered;
    co_await waiting_.async_wait(
        boost::asio::redirect_error(boost::asio::use_awaitable, delivered));
  }
  const FrameArrival frame = frames_.front();
  frames_.pop_front();
  co_return frame;
}

void NodeFrameFeed::deliver(const FrameArrival& frame) {
  frames_.push_back(frame);
  waiting_.cancel();
}

}  // namespace simbench::hardware

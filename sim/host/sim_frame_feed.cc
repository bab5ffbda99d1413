#include "sim/host/sim_frame_feed.h"

#include "algorithms/ports/assert.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {
namespace {

constexpr std::size_t kFramesKept = 1024;

}  // namespace

SimFrameFeed::SimFrameFeed(SimHost& host)
    : host_(host), delivered_(host.world().context, host.name("next frame")) {}

Task<std::optional<FrameArrival>> SimFrameFeed::next(SteadyTime deadline) {
  SIMBENCH_ASSERT(!delivered_.waiting(), "one wait at a time on a frame feed");
  while (frames_.empty()) {
    if (host_.is_past(deadline)) co_return std::nullopt;
    co_await delivered_.wait(host_.next_look(deadline));
  }
  const FrameArrival frame = frames_.front();
  frames_.pop_front();
  co_return frame;
}

void SimFrameFeed::push(const FrameArrival& frame) {
  if (frames_.size() == kFramesKept) frames_.pop_front();
  frames_.push_back(frame);
  delivered_.notify();
}

}  // namespace simbench::sim

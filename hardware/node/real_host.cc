#include "hardware/node/real_host.h"

#include <algorithm>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/random/uniform_01.hpp>
#include <random>
#include <utility>

namespace simbench::hardware {

RealHost::RealHost(boost::asio::io_context& context, PeerId id, NodeClock& clock,
                   PeerNetwork& network, EventSink sink)
    : context_(context),
      id_(id),
      clock_(clock),
      network_(network),
      sink_(std::move(sink)),
      steady_clock_(clock),
      frames_(context, clock),
      engine_(std::random_device{}()) {
  ask_for_exact_timers();
  clock.observe([this](const ClockAdjustment& adjustment) { on_adjustment(adjustment); });
}

RealHost::~RealHost() { release_clock(); }

void RealHost::release_clock() {
  if (std::exchange(observes_, false)) clock_.observe(nullptr);
}

void RealHost::on_adjustment(ClockAdjustment adjustment) {
  adjustment.host = id_;
  sink_(adjustment);
  for (Sleeper& sleeper : sleepers_) sleeper.timer.cancel();
}

MessageChannel& RealHost::open_channel(PeerId peer, Transport transport) {
  return network_.channel(peer, transport);
}

Task<void> RealHost::sleep_for(Nanoseconds interval) {
  const SteadyTime deadline = steady_clock_.now() + interval;
  boost::asio::steady_timer timer(context_);
  timer.expires_at(for_timer(clock_.oscillator().when(deadline)));
  co_await timer.async_wait(boost::asio::use_awaitable);
}

Task<void> RealHost::sleep_until(HostTime at) {
  Sleeper sleeper(context_);
  sleepers_.push_back(sleeper);
  for (;;) {
    const MonotonicTime now = monotonic_now();
    const MonotonicTime wake = clock_.when(at, now);
    if (wake <= now) break;
    sleeper.timer.expires_at(for_timer(wake));
    // An adjustment ends the wait; cancelling the coroutine ends it at its next wait.
    boost::system::error_code adjusted;
    co_await sleeper.timer.async_wait(
        boost::asio::redirect_error(boost::asio::use_awaitable, adjusted));
  }
}

double RealHost::random_uniform() { return boost::random::uniform_01<double>{}(engine_); }

void RealHost::steer(const CameraSteerings& cameras) {
  controls_.clear();
  for (const auto& [camera, steering] : cameras) {
    const RealFrameControl::Place place{context_, clock_, *this};
    all_controls_.push_back(std::make_unique<RealFrameControl>(place, camera, steering));
    controls_.push_back(all_controls_.back().get());
  }
}

void RealHost::deliver(const FrameArrival& frame) {
  frames_.deliver(frame);
  const auto newest = all_controls_.end() - static_cast<std::ptrdiff_t>(controls_.size());
  const auto of_camera = std::find_if(newest, all_controls_.end(), [&](const auto& control) {
    return control->camera() == frame.camera;
  });
  if (of_camera != all_controls_.end()) (*of_camera)->deliver(frame);
}

}  // namespace simbench::hardware

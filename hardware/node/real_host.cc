#include "hardware/node/real_host.h"

#include <algorithm>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/intrusive/list.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <random>
#include <utility>
#include <vector>

#include "hardware/node/node_frame_feed.h"
#include "hardware/node/real_frame_control.h"

namespace simbench::hardware {
namespace {

class NodeSteadyClock final : public SteadyClock {
 public:
  explicit NodeSteadyClock(const NodeClock& clock) : clock_(clock) {}
  SteadyTime now() const override { return clock_.steady_at(monotonic_now()); }

 private:
  const NodeClock& clock_;
};

// A pending sleep_until(); leaves the list when its coroutine ends or is destroyed.
using AutoUnlink =
    boost::intrusive::list_base_hook<boost::intrusive::link_mode<boost::intrusive::auto_unlink>>;
struct Sleeper : AutoUnlink {
  explicit Sleeper(boost::asio::io_context& context) : timer(context) {}
  boost::asio::steady_timer timer;
};

}  // namespace

class RealHost::State {
 public:
  struct Parts {
    boost::asio::io_context& context;
    PeerId id;
    NodeClock& clock;
    PeerNetwork& network;
    EventSink sink;
  };

  explicit State(Parts given)
      : parts(std::move(given)), steady_clock(parts.clock), frames(parts.context, parts.clock) {}

  void on_adjustment(ClockAdjustment adjustment) {
    adjustment.host = parts.id;
    parts.sink(adjustment);
    for (Sleeper& sleeper : sleepers) sleeper.timer.cancel();
  }

  Parts parts;
  NodeSteadyClock steady_clock;
  NodeFrameFeed frames;
  // All that there were, as coroutines may hold them, and those of the cameras in use.
  std::vector<std::unique_ptr<RealFrameControl>> all_controls;
  std::vector<FrameControl*> controls;
  bool observes = true;  // the clock
  boost::random::mt19937_64 engine{std::random_device{}()};
  boost::intrusive::list<Sleeper, boost::intrusive::constant_time_size<false>> sleepers;
};

RealHost::RealHost(boost::asio::io_context& context, PeerId id, NodeClock& clock,
                   PeerNetwork& network, EventSink sink)
    : state_(std::make_unique<State>(State::Parts{context, id, clock, network, std::move(sink)})) {
  ask_for_exact_timers();
  clock.observe([state = state_.get()](const ClockAdjustment& adjustment) {
    state->on_adjustment(adjustment);
  });
}

RealHost::~RealHost() { release_clock(); }

void RealHost::release_clock() {
  if (std::exchange(state_->observes, false)) state_->parts.clock.observe(nullptr);
}

PeerId RealHost::id() const { return state_->parts.id; }

HostClock& RealHost::clock() { return state_->parts.clock; }

const SteadyClock& RealHost::steady_clock() const { return state_->steady_clock; }

FrameFeed* RealHost::frame_feed() { return &state_->frames; }

MessageChannel& RealHost::open_channel(PeerId peer, Transport transport) {
  return state_->parts.network.channel(peer, transport);
}

Task<void> RealHost::sleep_for(Nanoseconds interval) {
  const SteadyTime deadline = state_->steady_clock.now() + interval;
  boost::asio::steady_timer timer(state_->parts.context);
  timer.expires_at(for_timer(state_->parts.clock.oscillator().when(deadline)));
  co_await timer.async_wait(boost::asio::use_awaitable);
}

Task<void> RealHost::sleep_until(HostTime at) {
  Sleeper sleeper(state_->parts.context);
  state_->sleepers.push_back(sleeper);
  for (;;) {
    const MonotonicTime now = monotonic_now();
    const MonotonicTime wake = state_->parts.clock.when(at, now);
    if (wake <= now) break;
    sleeper.timer.expires_at(for_timer(wake));
    // An adjustment ends the wait; cancelling the coroutine ends it at its next wait.
    boost::system::error_code adjusted;
    co_await sleeper.timer.async_wait(
        boost::asio::redirect_error(boost::asio::use_awaitable, adjusted));
  }
}

double RealHost::random_uniform() { return boost::random::uniform_01<double>{}(state_->engine); }

void RealHost::report_exchange(const Exchange& exchange) {
  state_->parts.sink(ExchangeEvent{state_->parts.id, exchange});
}

void RealHost::report_outcome(const SyncOutcome& outcome) { state_->parts.sink(outcome); }

void RealHost::report_alignment(const AlignmentReport& report) { state_->parts.sink(report); }

std::span<FrameControl* const> RealHost::frame_controls() { return state_->controls; }

void RealHost::steer(const CameraSteerings& cameras) {
  state_->controls.clear();
  for (const auto& [camera, steering] : cameras) {
    const RealFrameControl::Place place{state_->parts.context, state_->parts.clock, *this};
    state_->all_controls.push_back(std::make_unique<RealFrameControl>(place, camera, steering));
    state_->controls.push_back(state_->all_controls.back().get());
  }
}

void RealHost::deliver(const FrameArrival& frame) {
  state_->frames.deliver(frame);
  const auto newest =
      state_->all_controls.end() - static_cast<std::ptrdiff_t>(state_->controls.size());
  const auto of_camera = std::find_if(newest, state_->all_controls.end(), [&](const auto& control) {
    return control->camera() == frame.camera;
  });
  if (of_camera != state_->all_controls.end()) (*of_camera)->deliver(frame);
}

}  // namespace simbench::hardware

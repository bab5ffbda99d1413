// A real host: implements algorithms/ports/host.h over sockets, the node's clock and timers.
//
// The real side of the seam of docs/design.md section 4: it runs the same coroutines as the
// simulator. Steady time follows the node's oscillator; sleep_until(HostTime) follows its system
// clock and is re-armed when that is adjusted. There is no card clock and no pulse input (an
// algorithm that needs them is refused before it starts); the feed has the frames of the host's own
// cameras. Those that can be steered have frame controls.
//
// Exchanges, outcomes, alignment reports and clock adjustments go to `sink` as they happen.
// One thread. Coroutines that use it end before it does.
//
//   RealHost host(context, 3, clock, network,
//                 [&](const RecordingEvent& event) { journal.write(event); });
//   boost::asio::co_spawn(context, host_sync.run_slave(host, 0), boost::asio::detached);
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/intrusive/list.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/camera/camera.h"
#include "hardware/clock/node_clock.h"
#include "hardware/net/peer_network.h"
#include "hardware/node/node_frame_feed.h"
#include "hardware/node/real_frame_control.h"
#include "recording/event.h"

namespace simbench::hardware {

class RealHost final : public Host {
 public:
  using EventSink = std::function<void(const RecordingEvent&)>;

  RealHost(boost::asio::io_context& context, PeerId id, NodeClock& clock, PeerNetwork& network,
           EventSink sink);
  ~RealHost() override;

  PeerId id() const override { return id_; }
  HostClock& clock() override { return clock_; }
  const SteadyClock& steady_clock() const override { return steady_clock_; }
  FrameFeed* frame_feed() override { return &frames_; }
  MessageChannel& open_channel(PeerId peer, Transport transport) override;
  Task<void> sleep_for(Nanoseconds interval) override;
  Task<void> sleep_until(HostTime at) override;
  double random_uniform() override;
  void report_exchange(const Exchange& exchange) override { sink_(ExchangeEvent{id_, exchange}); }
  void report_outcome(const SyncOutcome& outcome) override { sink_(outcome); }
  void report_program_failure(const ProgramFailure& failure) override { sink_(failure); }
  void report_delays(const SessionDelays& delays) override { sink_(delays); }
  void report_alignment(const AlignmentReport& report) override { sink_(report); }
  std::span<FrameControl* const> frame_controls() override { return controls_; }

  // Observes the clock no longer, so that another host may. The destructor does the same.
  void release_clock();
  // From now on these are the cameras that frame_controls() is about.
  void steer(const CameraSteerings& cameras);
  // A frame of one of this host's cameras, for the feed and its control.
  void deliver(const FrameArrival& frame);

 private:
  class NodeSteadyClock final : public SteadyClock {
   public:
    explicit NodeSteadyClock(const NodeClock& clock) : clock_(clock) {}
    SteadyTime now() const override { return clock_.steady_at(monotonic_now()); }

   private:
    const NodeClock& clock_;
  };

  // A pending sleep_until(); leaves the list when its coroutine ends or is destroyed.
  struct Sleeper : boost::intrusive::list_base_hook<
                       boost::intrusive::link_mode<boost::intrusive::auto_unlink>> {
    explicit Sleeper(boost::asio::io_context& context) : timer(context) {}
    boost::asio::steady_timer timer;
  };

  void on_adjustment(ClockAdjustment adjustment);

  boost::asio::io_context& context_;
  PeerId id_;
  NodeClock& clock_;
  PeerNetwork& network_;
  EventSink sink_;
  NodeSteadyClock steady_clock_;
  NodeFrameFeed frames_;
  // All that there were, as coroutines may hold them, and those of the cameras in use.
  std::vector<std::unique_ptr<RealFrameControl>> all_controls_;
  std::vector<FrameControl*> controls_;
  bool observes_ = true;  // the clock
  boost::random::mt19937_64 engine_;
  boost::intrusive::list<Sleeper, boost::intrusive::constant_time_size<false>> sleepers_;
};

}  // namespace simbench::hardware

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
#ifndef SIMBENCH_HARDWARE_NODE_REAL_HOST_H_
#define SIMBENCH_HARDWARE_NODE_REAL_HOST_H_

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <span>

#include "algorithms/ports/host.h"
#include "hardware/camera/camera.h"
#include "hardware/clock/node_clock.h"
#include "hardware/net/peer_network.h"
#include "recording/event.h"

namespace simbench::hardware {

class RealHost final : public Host {
 public:
  using EventSink = std::function<void(const RecordingEvent&)>;

  RealHost(boost::asio::io_context& context, PeerId id, NodeClock& clock, PeerNetwork& network,
           EventSink sink);
  ~RealHost() override;

  PeerId id() const override;
  HostClock& clock() override;
  const SteadyClock& steady_clock() const override;
  FrameFeed* frame_feed() override;
  MessageChannel& open_channel(PeerId peer, Transport transport) override;
  Task<void> sleep_for(Nanoseconds interval) override;
  Task<void> sleep_until(HostTime at) override;
  double random_uniform() override;
  void report_exchange(const Exchange& exchange) override;
  void report_outcome(const SyncOutcome& outcome) override;
  void report_alignment(const AlignmentReport& report) override;
  std::span<FrameControl* const> frame_controls() override;

  // Observes the clock no longer, so that another host may. The destructor does the same.
  void release_clock();
  // From now on these are the cameras that frame_controls() is about.
  void steer(const CameraSteerings& cameras);
  // A frame of one of this host's cameras, for the feed and its control.
  void deliver(const FrameArrival& frame);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_REAL_HOST_H_

// A simulated host: what algorithms/ports/host.h promises, in virtual time.
//
// Calls of the clock cost CPU time (sim/host/host_clocks.h), sends the sender's occupancy
// (sim/host/sim_channel.h). All waits are on the engine: intervals and deadlines follow the host's
// oscillator, sleep_until follows its system clock and is re-armed at each adjustment. Adjustments,
// exchanges and outcomes go to the recording sink as they happen.
//
// The card's clock (sim/host/host_clocks.h), pulse lines (sim/host/pulse_lines.h), the radio's
// clock (sim/host/radio_clock.h) and the feed of its cameras' frames exist only if the scenario or
// a program uses them. None costs an event while no coroutine waits.
//
// The host's random streams are named after its number ("host3: ..."), never after the scenario.
//
// Source: docs/design.md section 4; docs/reference/calibration.md section 2.
//
//   SystemClock clock(3, OscillatorModel(20e-6), from_ms(150));
//   const HostWorld world{.context = context,
//                         .hosts = scenario.hosts,
//                         .network_parameters = scenario.network,
//                         .network = network,
//                         .load = load,
//                         .outages = outages,
//                         .trigger_line = trigger_line,
//                         .drift_files = drift_files,
//                         .frames = frame_supply,
//                         .sink = sink,
//                         .run_seed = 1};
//   SimHost host(world, 3, clock, true);
//   boost::asio::co_spawn(context, host_sync.run_slave(host, 0), boost::asio::detached);
#pragma once

#include <boost/intrusive/list.hpp>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "algorithms/ports/host.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/clock/clock_interface.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/random.h"
#include "sim/engine/virtual_executor.h"
#include "sim/faults/faults.h"
#include "sim/host/drift_files.h"
#include "sim/host/frame_supply.h"
#include "sim/host/host_clocks.h"
#include "sim/host/message_stack.h"
#include "sim/host/pulse_lines.h"
#include "sim/host/radio_clock.h"
#include "sim/network/load.h"
#include "sim/network/network.h"

namespace simbench::sim {

class SimChannel;
class SimFrameControl;
class SimHost;
class SimMulticast;

// The frames of the host's cameras, or of one of them, for its programs: a queue that the rig
// fills.
//
// next() returns at the instant of a frame's delivery, as the stamps of a frame already contain all
// delays. The last 1024 frames that no program has taken are kept. A feed exists only from the
// host's first frame_feed() on; until then frames cost nothing, and afterwards a frame costs no
// event unless a coroutine waits.
class SimFrameFeed final : public FrameFeed {
 public:
  // `host` must outlive the feed.
  explicit SimFrameFeed(SimHost& host);

  Task<std::optional<FrameArrival>> next(SteadyTime deadline) override;

  void push(const FrameArrival& frame);
  // Whether a coroutine waits for a frame.
  bool is_awaited() const { return delivered_.waiting(); }

 private:
  SimHost& host_;
  WaitPoint delivered_;
  std::deque<FrameArrival> frames_;
};

// What the hosts of a world have in common. Everything referred to must outlive them.
struct HostWorld {
  VirtualContext& context;
  const scenarios::Hosts& hosts;
  const scenarios::Network& network_parameters;
  SimNetwork& network;
  const RunLoad& load;
  const Outages& outages;
  const TriggerLine& trigger_line;
  const DriftFiles& drift_files;
  FrameSupply& frames;
  RecordingSink& sink;
  std::uint64_t run_seed = 0;
  const AccessPoint* access_point = nullptr;  // null: no radio has a clock for programs
};

class SimHost final : public Host {
 public:
  // `system_clock` must outlive the host, which becomes its observer.
  SimHost(const HostWorld& world, PeerId id, SystemClock& system_clock, bool has_cameras);
  SimHost(const SimHost&) = delete;
  SimHost& operator=(const SimHost&) = delete;
  ~SimHost() override;

  PeerId id() const override { return id_; }
  ClockPort& clock() override { return clock_port_; }
  const SteadyClock& steady_clock() const override { return steady_port_; }
  HardwareClock* hardware_clock() override;
  PulseInput* pulse_input(PulseLine line) override;
  FrameFeed* frame_feed() override;
  RadioClock* radio_clock() override;
  std::span<FrameControl* const> frame_controls() override { return control_ports_; }
  std::optional<StoredFrequency> stored_frequency() override;
  MessageChannel& open_channel(PeerId peer, Transport transport) override;
  Task<void> sleep_for(Nanoseconds interval) override;
  Task<void> sleep_until(HostTime at) override;
  double random_uniform() override { return algorithm_draws_.uniform(); }
  void report_exchange(const Exchange& exchange) override;
  void report_outcome(const SyncOutcome& outcome) override;
  void report_program_failure(const ProgramFailure& failure) override;
  void report_delays(const SessionDelays& delays) override;
  void report_alignment(const AlignmentReport& report) override;

  // One of the host's cameras, whose frames can be controlled.
  void add_frame_control(std::uint32_t camera, const scenarios::Scenario& scenario);
  // Null: the camera's frames cannot be.
  SimFrameControl* frame_control(std::uint32_t camera) const;
  // Whether a coroutine waits for a frame.
  bool awaits_frame() const;

  // The feed if a program has opened it.
  SimFrameFeed* opened_frame_feed() const { return frame_feed_.get(); }

  // As pulse_input().
  SimPulseInput* pulse_line(PulseLine line);
  // A host_sync took a pulse whose time the receiver announced.
  void report_pulse(const PulseStamp& pulse);
  // The trigger line has pulses from now on.
  void trigger_started();

  // For its ports.
  const HostWorld& world() const { return world_; }
  const SystemClock& system_clock() const { return system_clock_; }
  // For what the kernel does to the clock by itself, which costs no call.
  SystemClock& system_clock() { return system_clock_; }
  const ClockInterface& clock_interface() const { return interface_; }
  Cpu& cpu() { return cpu_; }
  SimChannel& datagram_channel(PeerId peer);
  SimMulticast& multicast();
  MessageStack& stack() { return stack_; }
  // Null if the card takes no stamps.
  const NicClock* nic() const { return nic_.get(); }
  NicClock* nic() { return nic_.get(); }
  // The delay that a burst of load adds to the wake-up for an event with the key (what, a, b).
  Nanoseconds load_delay(ComponentKey what, std::uint64_t a, std::uint64_t b) {
    return host_load_.delay(true_now(), what, a, b);
  }
  TrueTime true_now() const { return world_.context.engine().now(); }
  bool is_past(SteadyTime deadline) const { return steady_clock().now() >= deadline; }
  // When a wait for `deadline` should read the clock again: at the deadline's instant, or earlier
  // if that is far off, as its instant depends on the oscillator's future; nothing if the deadline
  // is years away. Only while the deadline is not past.
  std::optional<TrueTime> next_look(SteadyTime deadline) const;
  // "host3: what".
  std::string name(std::string_view what) const;

 private:
  using AutoUnlink =
      boost::intrusive::list_base_hook<boost::intrusive::link_mode<boost::intrusive::auto_unlink>>;
  // A sleep_until() under way.
  struct Sleeper : AutoUnlink {
    Sleeper(VirtualContext& context, std::string label) : adjusted(context, std::move(label)) {}
    WaitPoint adjusted;
  };

  // When a clock that has `left` to go for certain has not got there yet; the end of time if that
  // is years.
  TrueTime part_way(Nanoseconds left) const;
  void on_adjustment(const ClockAdjustment& adjustment);

  HostWorld world_;
  PeerId id_;
  SystemClock& system_clock_;
  ClockInterface interface_;
  Cpu cpu_;
  ClockPort clock_port_;
  SteadyPort steady_port_;
  RandomStream algorithm_draws_;
  bool has_cameras_;
  std::string sleep_label_;
  HostLoad host_load_;
  MessageStack stack_;
  std::unique_ptr<NicClock> nic_;
  PpsReceiver receiver_;
  std::unique_ptr<SimPulseInput> pps_;
  std::unique_ptr<SimPulseInput> trigger_;
  std::unique_ptr<SimRadioClock> radio_;
  std::unique_ptr<SimFrameFeed> frame_feed_;
  std::vector<std::unique_ptr<SimFrameControl>> controls_;
  std::vector<FrameControl*> control_ports_;  // the same
  std::map<std::pair<PeerId, Transport>, std::unique_ptr<SimChannel>> channels_;
  std::unique_ptr<SimMulticast> multicast_;
  boost::intrusive::list<Sleeper, boost::intrusive::constant_time_size<false>> sleepers_;
};

}  // namespace simbench::sim

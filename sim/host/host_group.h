// All hosts of a scenario, with their clocks and the network between them, ready to run.
//
// The clocks at true zero, whenever the world starts: the master's reads 0. The slaves' clocks are
//   kUnsynchronised  off by N(initial_offset_sigma_ms), or as initial_offset_of_host_ms states
//   kLastSet         off by N(last_set.skew_sigma_ppm) * hours_ago, the rate error of those hours
//                    being independent of the present one, plus the present rate difference to the
//                    master times minutes_since_baseline
//   kMaster          the master's own, at every instant.
// Oscillators have their drawn skews, or those of skew_of_host_ppm; an exact master's has no error.
// Each host's steady clock starts from an arbitrary reading of its own within an hour, so that a
// mix of two hosts' steady times shows.
//
// All random numbers but those of the load come from streams named after the hosts alone: all
// pipelines of a seed, and all scenarios that differ in other members, have the same oscillators
// and offsets.
//
// Source: docs/reference/calibration.md section 2 ("Host clock", "None row").
//
//   HostGroup hosts(scenario, seed, "both@18cam_6host_45fps", InitialClocks::kUnsynchronised,
//                   context, sink);
//   hosts.report_clocks();
//   boost::asio::co_spawn(context, host_sync.run_master(hosts.host(0), slaves),
//                         boost::asio::detached);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/clock/oscillator.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/virtual_executor.h"
#include "sim/faults/faults.h"
#include "sim/host/drift_files.h"
#include "sim/host/frame_supply.h"
#include "sim/host/pulse_lines.h"
#include "sim/host/radio_clock.h"
#include "sim/host/sim_host.h"
#include "sim/network/load.h"
#include "sim/network/network.h"
#include "sim/traffic/traffic.h"
#include "sim/trigger/trigger_tree.h"

namespace simbench::sim {

// The oscillator of that host, as every run of the seed has it.
OscillatorModel host_oscillator(const scenarios::Hosts& hosts, std::uint64_t run_seed,
                                std::size_t host,
                                std::size_t kept_blocks = GridWalk<double>::kFewestBlocks);

// The oscillators of the hosts for several runs, one after the other. Runs of one seed share what
// they sample of the noise, which services of many hours need anew otherwise: up to some 8 MB for
// each host (29 hours on a grid of 100 ms), as far as anyone asks.
class HostOscillators {
 public:
  // `hosts` must outlive this.
  explicit HostOscillators(const scenarios::Hosts& hosts) : hosts_(hosts) {}

  OscillatorModel of(std::uint64_t run_seed, std::size_t host);

 private:
  const scenarios::Hosts& hosts_;
  std::uint64_t seed_ = 0;
  std::vector<OscillatorModel> of_seed_;
};

class HostGroup {
 public:
  // `load_key` names the run whose load is drawn: "<pipeline>@<scenario>". The references must
  // outlive the group, and the engine must not run after the group is destroyed. `oscillators` of
  // other runs' hosts, or none.
  HostGroup(const scenarios::Scenario& scenario, std::uint64_t run_seed, std::string_view load_key,
            InitialClocks initial_clocks, VirtualContext& context, RecordingSink& sink,
            HostOscillators* oscillators = nullptr);
  HostGroup(const HostGroup&) = delete;
  HostGroup& operator=(const HostGroup&) = delete;

  std::size_t size() const { return hosts_.size(); }
  // The host that a slave takes the time from.
  PeerId followed(PeerId slave) const { return scenarios::followed_host(parameters_, slave); }
  SimHost& host(std::size_t index) { return hosts_[index]; }
  SystemClock& clock(std::size_t index) { return clocks_[index]; }
  const std::deque<SystemClock>& all_clocks() const { return clocks_; }
  std::vector<SystemClock*> clocks();

  // The times of faults count from now; leap seconds come as the clocks read their instants.
  void begin_faults();
  // The capture begins now, with its faults: its trigger has pulses up to slot `last`.
  void on_capture_start(const TriggerTree& trigger, std::int64_t last);

  SimNetwork& network() { return network_; }
  FrameSupply& frames() { return frames_; }
  const Outages& outages() const { return outages_; }

  // Reports the present setting of every clock, as the beginning of its log of adjustments.
  void report_clocks();

 private:
  void make_clock(OscillatorModel oscillator, std::uint64_t run_seed, InitialClocks initial_clocks);

  VirtualContext& context_;
  Engine& engine_;
  const scenarios::Hosts& parameters_;
  const std::vector<scenarios::Fault>& faults_;
  RecordingSink& sink_;
  RunLoad load_;
  Outages outages_;
  CrossTraffic traffic_;
  SimNetwork network_;
  TriggerLine trigger_line_;
  std::deque<SystemClock> clocks_;
  std::optional<AccessPoint> access_point_;  // in a cell whose time programs can use
  DriftFiles drift_files_;
  FrameSupply frames_;
  std::deque<SimHost> hosts_;
};

}  // namespace simbench::sim

// The traffic between hosts (network/traffic), as the messages of the synchronisation meet it.
//
// Problem: a message shares the ports of its way with TCP, video and bursts, and waits where they
// queue: in its own host, in trunks, in the port to its receiver. Naive: one stationary wait for
// each port, drawn anew for each message. Then neither the asymmetry of a loaded way nor the
// minutes for which a TCP connection keeps a queue are there.
//
// Here TCP is a fluid (sim/traffic/tcp_fluid.h), which takes what paced and random streams leave,
// and these are frames one by one (sim/traffic/frame_bursts.h). A message waits for the longer of
// the two queues: where TCP keeps one standing, its delay counts the others' frames too.
//
// Assumptions, beside those of the two models: the hosts' stacks take 20 us at each end of a
// connection (against queues of hundreds of microseconds, twice as much changes the windows by a
// few percent and standing queues, which the buffer limits, hardly at all); links have the
// network's fixed latency, not one of their own; a host that states no send_queue has a
// first-in-first-out one, 30 kB in its ring and 128 kB for a connection. Messages do not slow the
// traffic.
//
// TCP is begun anew for each minute in which a message comes, five seconds before it, from numbers
// of that minute alone: a message every quarter of an hour does not cost the quarter. What a fluid
// remembers, it forgets in some hundreds of round trips.
//
// Contract: instants nearly in order of time (TcpFluid); the same seed gives the same waits,
// whatever else is asked. Only ports that traffic passes take memory.
// Source: scenario /network/traffic, /network/buffer_kb, /hosts/send_queue; docs/design.md
// section 7.
//
//   CrossTraffic traffic(scenario.network, scenario.hosts, seed, 4);
//   const HostWait wait = traffic.at_host(0, now);
//   const TrafficPassage passage = traffic.at_switch(3, now + wait.in_queue + wait.in_ring);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/traffic/frame_bursts.h"
#include "sim/traffic/tcp_fluid.h"

namespace simbench::sim {

// Behind the traffic of the own host.
struct HostWait {
  Nanoseconds in_queue{0};  // before the kernel's stamp
  Nanoseconds in_ring{0};   // after it, before the card's
};

struct TrafficPassage {
  Nanoseconds wait{0};
  double loss_share = 0;  // the probability that the port drops the message
};

class CrossTraffic {
 public:
  CrossTraffic(const scenarios::Network& network, const scenarios::Hosts& hosts,
               std::uint64_t run_seed, std::size_t host_count);

  bool is_none() const { return connections_.empty() && !bursts_; }

  // A message that host `host` sends then.
  HostWait at_host(PeerId host, TrueTime at);
  // One that comes to the port towards host `to` then.
  TrafficPassage at_switch(PeerId to, TrueTime at);
  // One that comes to the port of switch `number` towards the next (up) or the last.
  TrafficPassage at_trunk(std::size_t number, bool up, TrueTime at);

  // The share of the paced and random streams that a port cannot carry while all are active: for
  // warnings.
  double overload_share_at_host(PeerId host) const { return overload_share(host); }
  double overload_share_at_switch(PeerId to) const { return overload_share(switch_port(to)); }

 private:
  static constexpr std::uint32_t kUnused = UINT32_MAX;

  struct Way {
    std::size_t from = 0;
    std::size_t to = 0;
  };

  std::size_t trunk_port(std::size_t number, bool up) const {
    return host_count_ + 2 * number + (up ? 1 : 0);
  }
  std::size_t switch_port(std::size_t to) const { return host_count_ + 2 * switch_count_ + to; }
  std::size_t switch_of(std::size_t host) const {
    return switch_of_host_.empty() ? 0 : static_cast<std::size_t>(switch_of_host_[host]);
  }
  std::vector<std::size_t> ports_of(Way way) const;
  // In numbers of the ports that are in use.
  std::vector<std::size_t> used_ports_of(Way way) const;
  void number_ports(const std::vector<scenarios::Traffic>& traffic);
  void add(const scenarios::Traffic& traffic, Way way, const scenarios::Network& network);
  Nanoseconds base_round_trip(Way way, const scenarios::Network& network) const;
  Nanoseconds wait(std::size_t port, TrueTime at);
  // The fluid of that minute; none without TCP.
  TcpFluid* fluid_at(TrueTime at);
  TrafficPassage passage(std::size_t port, TrueTime at);
  double overload_share(std::size_t port) const;

  std::size_t host_count_;
  std::size_t switch_count_ = 1;
  std::vector<std::int64_t> switch_of_host_;
  double line_bytes_per_ns_;
  scenarios::SendQueue send_queue_;
  std::vector<std::uint32_t> used_;  // the number of each port among those in use
  std::uint64_t run_seed_;
  std::vector<FluidPort> ports_;
  std::vector<FluidConnection> connections_;
  std::vector<FluidShare> shares_;
  std::vector<BurstStream> streams_;
  std::optional<TcpFluid> fluid_;  // of the newest minute that was asked for
  std::int64_t minute_ = 0;        // its number
  std::optional<FrameBursts> bursts_;
};

}  // namespace simbench::sim

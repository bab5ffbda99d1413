// TCP packet by packet: the reference for the fluid model (sim/traffic/tcp_fluid.h).
//
// A discrete-event simulation of its own, which shares no code with the model that it judges:
// saturating senders (CUBIC or Reno), ports that serve in order of arrival and drop what finds the
// buffer full, receivers that acknowledge every second segment and at once what is out of order.
//
//  - Senders know what arrived by selective acknowledgements, take a segment as lost when three
//    later transmissions arrived (one where fewer than five are under way), reduce the window once
//    per window of data and send as RFC 6937 (PRR) lets them while they recover.
//  - A connection has at most `connection_bytes` in its own host's queue (TCP small queues); its
//    window does not grow while this, and not the window, holds it back.
//  - Each end takes a random time of microseconds for a segment, without which drop-tail ports lock
//    the phases of their senders.
//  - The Reno-friendly window of CUBIC grows by 0.53 segments per round trip for good, as in Linux;
//    RFC 9438 advises 1 above the window of the last reduction.
//
// Left out: segmentation offload, interrupt moderation, pacing, HyStart, the receiver's window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace simbench {

struct PacketPort {
  double ns_per_byte = 8;
  double buffer_bytes = 0;  // 0: without end, as in a host
};

struct PacketConnection {
  std::vector<std::size_t> data_ports;  // the own host's first
  std::vector<std::size_t> ack_ports;
  bool is_cubic = true;
  double connection_bytes = 128e3;
  double fixed_ns = 0;  // each way, behind the last port
  double begin_ns = 0;
};

struct PacketWorld {
  std::vector<PacketPort> ports;
  std::vector<PacketConnection> connections;
  double host_delay_max_ns = 4'000;  // U(0, this) at each end
  std::uint64_t seed = 1;
};

struct PacketResult {
  // The delay of each port at each sample.
  std::vector<std::vector<double>> delays_ns;
  // The share of the arrived data that each port dropped.
  std::vector<double> loss_share;
  std::vector<double> segments;  // delivered in order, by connection, in all
  std::vector<double> reductions;
  std::vector<double> timeouts;
};

// From `from_s` to `to_s`, a sample each `step_s`.
PacketResult run_packets(const PacketWorld& world, double from_s, double to_s, double step_s);

}  // namespace simbench

// The fluid against each packet simulated (tests/sim/traffic/packet_tcp.h): the queues in time.
//
// Tolerances are what was found, 5 % where it was reached. Beyond it: in the chain of two-way
// connections the queue of 64 kB is 15 % or some 25 us too short on average (a real one that is
// empty on average still holds frames by chance), and the hosts' own queues, which depend on who
// lost last, are up to 10 % off.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>
#include <vector>

#include "sim/traffic/tcp_fluid.h"
#include "tests/nonempty.h"
#include "tests/sim/traffic/packet_tcp.h"

namespace simbench::sim {
namespace {

constexpr double kFromS = 3;
constexpr double kLastS = 63;
constexpr double kSampleS = 0.0007;
constexpr std::uint64_t kFluidSeed = 7;

struct TcpCase {
  const char* name;
  std::size_t hosts;
  std::vector<std::pair<std::size_t, std::size_t>> flows;
  int connections;
  bool is_cubic;
  std::vector<std::size_t> congested_hosts;  // whose ports of the switch are full
  double mean_tolerance;
  std::vector<std::size_t> loaded_hosts;  // whose own queues are
};

const std::vector<TcpCase>& tcp_cases() {
  static const std::vector<TcpCase> cases{
      {"2 CUBIC", 3, {{0, 2}, {1, 2}}, 1, true, {2}, 0.05, {}},
      {"2 Reno", 3, {{0, 2}, {1, 2}}, 1, false, {2}, 0.05, {}},
      {"3 x 4 CUBIC", 4, {{0, 3}, {1, 3}, {2, 3}}, 4, true, {3}, 0.05, {}},
      {"chain", 4, {{0, 1}, {1, 0}, {1, 2}, {2, 1}, {2, 3}, {3, 2}}, 1, true, {1, 2}, 0.06, {1, 2}},
  };
  return cases;
}

// Ports 0 to hosts - 1 are the hosts', the others the switch's; clocks differ by up to 50 ppm.
PacketWorld packet_world(const TcpCase& tcp, double buffer_bytes) {
  PacketWorld world;
  std::uint32_t word = 12345;
  for (std::size_t p = 0; p < 2 * tcp.hosts; ++p) {
    word = word * 1664525u + 1013904223u;
    const double ppm = static_cast<double>((word >> 8) % 100'001) / 1e3 - 50;
    world.ports.push_back(
        {.ns_per_byte = 8 * (1 + ppm * 1e-6), .buffer_bytes = p < tcp.hosts ? 0 : buffer_bytes});
  }
  double begin_ns = 0;
  for (const auto& [from, to] : tcp.flows) {
    for (int i = 0; i < tcp.connections; ++i) {
      world.connections.push_back({.data_ports = {from, tcp.hosts + to},
                                   .ack_ports = {to, tcp.hosts + from},
                                   .is_cubic = tcp.is_cubic,
                                   .connection_bytes = 128e3,
                                   .fixed_ns = 25e3,
                                   .begin_ns = begin_ns});
      begin_ns += 37e6;
    }
  }
  return world;
}

TcpFluid fluid_of(const PacketWorld& world) {
  std::vector<FluidPort> ports;
  for (const PacketPort& port : world.ports) {
    ports.push_back({.bytes_per_ns = 1 / port.ns_per_byte, .buffer_bytes = port.buffer_bytes});
  }
  std::vector<FluidConnection> connections;
  for (const PacketConnection& connection : world.connections) {
    const double lines_ns = 2 * (kFullFrameBytes + kAckFrameBytes) * 8;
    connections.push_back(
        {.data_ports = connection.data_ports,
         .ack_ports = connection.ack_ports,
         .congestion = connection.is_cubic ? scenarios::CongestionControl::kCubic
                                           : scenarios::CongestionControl::kReno,
         .connection_bytes = connection.connection_bytes,
         .base_round_trip = from_ns(2 * connection.fixed_ns + world.host_delay_max_ns + lines_ns),
         .begin = TrueTime(from_ns(connection.begin_ns))});
  }
  return TcpFluid(std::move(ports), std::move(connections), {}, kFluidSeed);
}

struct QueueSummary {
  double mean_us = 0;
  double p95_us = 0;
};

QueueSummary summary_of(std::vector<double> delays_ns) {
  QueueSummary summary;
  for (const double delay_ns : delays_ns) summary.mean_us += delay_ns;
  summary.mean_us /= 1e3 * static_cast<double>(delays_ns.size());
  std::sort(delays_ns.begin(), delays_ns.end());
  summary.p95_us = delays_ns[delays_ns.size() * 95 / 100] / 1e3;
  return summary;
}

void expect_like(const QueueSummary& fluid, const QueueSummary& packets, double mean_tolerance,
                 double p95_tolerance) {
  std::printf("  mean %6.0f us of %6.0f: %.3f, p95 %6.0f us of %6.0f: %.3f\n", fluid.mean_us,
              packets.mean_us, fluid.mean_us / packets.mean_us, fluid.p95_us, packets.p95_us,
              fluid.p95_us / packets.p95_us);
  EXPECT_NEAR(fluid.mean_us, packets.mean_us, std::max(mean_tolerance * packets.mean_us, 35.0));
  EXPECT_NEAR(fluid.p95_us, packets.p95_us, p95_tolerance * packets.p95_us);
}

void compare(const TcpCase& tcp, double buffer_bytes) {
  SCOPED_TRACE(testing::Message() << tcp.name << ", buffer " << buffer_bytes << ", fluid's seed "
                                  << kFluidSeed);
  const PacketWorld world = packet_world(tcp, buffer_bytes);
  const PacketResult packets = run_packets(world, kFromS, kLastS, kSampleS);
  TcpFluid fluid = fluid_of(world);
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::vector<double>> delays_ns(world.ports.size());
  for (double s = kFromS; s < kLastS; s += kSampleS) {
    for (std::size_t p = 0; p < world.ports.size(); ++p) {
      const Nanoseconds delay = fluid.delay(p, TrueTime(from_seconds(s)));
      delays_ns[p].push_back(static_cast<double>(delay.count()));
    }
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::printf("%s, %.0f kB: %.0f ns for a simulated second\n", tcp.name, buffer_bytes / 1e3,
              took.count() / kLastS * 1e9);
  for (const std::size_t host : nonempty(tcp.congested_hosts)) {
    const std::size_t p = tcp.hosts + host;
    expect_like(summary_of(delays_ns[p]), summary_of(packets.delays_ns[p]), tcp.mean_tolerance,
                0.05);
  }
  for (const std::size_t host : tcp.loaded_hosts) {
    expect_like(summary_of(delays_ns[host]), summary_of(packets.delays_ns[host]), 0.1, 0.12);
  }
}

TEST(TcpFluidSlowTest, QueuesAreThoseOfPackets) {
  for (const double buffer_bytes : {64e3, 128e3, 512e3}) {
    for (const TcpCase& tcp : nonempty(tcp_cases())) compare(tcp, buffer_bytes);
  }
}

}  // namespace
}  // namespace simbench::sim

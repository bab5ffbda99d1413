// How well the two-way hull synchronises two nodes over this machine's loopback.
//
// Two processes, one node each: a software clock (300 ms apart, oscillators of +30 and -30 ppm),
// the sockets, the algorithm; as in `simbench node` but for cameras. The clocks are functions of
// the machine's monotonic clock, so the true error is known at any instant: both processes sample
// their clocks every 10 ms, and the parent subtracts.
//
// With `flood` it measures a second time while a hostile neighbour sends the slave 10,000 forged,
// replayed, truncated or oversized datagrams a second (root).
//
//   build/release/bin/hull_loopback            (10 s, then 5 s of samples)
//   build/release/bin/hull_loopback flood
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "hardware/clock/software_clock.h"
#include "hardware/net/peer_network.h"
#include "hardware/node/real_host.h"

namespace {

using namespace simbench;
using namespace simbench::hardware;

struct FloodPlan {
  std::uint16_t target_port = 0;
  std::uint16_t pretended_port = 0;
  int per_second = 10'000;
  int seconds = 15;
};

using Payload = std::vector<unsigned char>;
constexpr std::size_t kKept = 256;        // genuine datagrams, the newest
constexpr std::size_t kCounterByte = 10;  // hardware/net/datagram.h

// Takes datagrams from the peer to the target off the wire.
void listen_in(int socket, const FloodPlan& plan, std::vector<Payload>& genuine) {
  std::array<unsigned char, 2048> packet{};
  for (;;) {
    const ssize_t size = recv(socket, packet.data(), packet.size(), MSG_DONTWAIT);
    if (size <= 0) return;
    const std::size_t header = (packet[0] & 0x0fU) * 4;
    udphdr udp{};
    if (static_cast<std::size_t>(size) <= header + sizeof udp) continue;
    std::memcpy(&udp, packet.data() + header, sizeof udp);
    if (ntohs(udp.dest) != plan.target_port || ntohs(udp.source) != plan.pretended_port) continue;
    if (udp.check == 0) continue;  // our own: without a checksum
    if (genuine.size() == kKept) genuine.erase(genuine.begin());
    genuine.emplace_back(packet.begin() + static_cast<std::ptrdiff_t>(header + sizeof udp),
                         packet.begin() + size);
  }
}

void send_hostile(int socket, const FloodPlan& plan, const Payload& payload) {
  std::vector<unsigned char> packet(sizeof(udphdr) + payload.size());
  udphdr udp{};
  udp.source = htons(plan.pretended_port);
  udp.dest = htons(plan.target_port);
  udp.len = htons(static_cast<std::uint16_t>(packet.size()));
  std::memcpy(packet.data(), &udp, sizeof udp);
  if (!payload.empty()) std::memcpy(packet.data() + sizeof udp, payload.data(), payload.size());
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  sendto(socket, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
         sizeof to);
}

Payload hostile(const Payload& genuine, int kind) {
  Payload payload = genuine;
  switch (kind) {
    case 0:
      // A counter of the far future; else it would be refused before its seal is checked.
      if (payload.size() > kCounterByte) payload[kCounterByte] ^= 1U;
      break;
    case 1:
      break;
    case 2:
      payload.resize(payload.size() / 2);
      break;
    default:
      payload.assign(60'000, 0xa5);
      break;
  }
  return payload;
}

[[noreturn]] void flood(int socket, const FloodPlan& plan) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<Payload> genuine;
  const int all = plan.per_second * plan.seconds;
  // Replays the newest datagrams: old ones would be refused for their age alone.
  for (int i = 0; i < all; ++i) {
    std::this_thread::sleep_until(begin +
                                  std::chrono::microseconds(1'000'000LL * i / plan.per_second));
    listen_in(socket, plan, genuine);
    // Oversized ones are one in a hundred: 2,500 a second of them would fill the loopback itself.
    const int kind = i % 100 == 99 ? 3 : i % 3;
    if (!genuine.empty()) send_hostile(socket, plan, hostile(genuine.back(), kind));
  }
  std::_Exit(0);
}

// Starts a hostile neighbour in a process of its own, which ends by itself: it sends a host's port
// what must be refused, at a steady rate. Four kinds in turn: forged (a genuine datagram with one
// bit changed), replayed (genuine ones from the wire), truncated, oversized (60 kB of noise). They
// have the address and port of the host's own peer, which needs raw sockets (root); loopback only.
// Returns -1 if raw sockets are not permitted.
pid_t start_hostile_flood(const FloodPlan& plan) {
  const int raw = socket(AF_INET, SOCK_RAW, IPPROTO_UDP);
  if (raw < 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    flood(raw, plan);
  }
  close(raw);
  return child;
}

constexpr Nanoseconds kSettle = std::chrono::seconds(10);
constexpr Nanoseconds kMeasure = std::chrono::seconds(5);
constexpr Nanoseconds kEach = std::chrono::milliseconds(10);

// The node's clock at an instant that both processes sample.
struct Sample {
  std::int64_t at_ns;
  std::int64_t reads_ns;
};

Task<void> sample(const SoftwareClock& clock, MonotonicTime begin, std::vector<Sample>& samples,
                  boost::asio::io_context& context) {
  boost::asio::steady_timer timer(context);
  for (MonotonicTime at = begin + kSettle; at < begin + kSettle + kMeasure; at += kEach) {
    timer.expires_at(for_timer(at));
    co_await timer.async_wait(boost::asio::use_awaitable);
    samples.push_back({at.time_since_epoch().count(), nanoseconds_of(clock.system_at(at))});
  }
  context.stop();
}

// `master_port` 0: this is the master, which writes its port to the pipe.
std::vector<Sample> run_node(PeerId me, std::uint16_t master_port, int port_pipe,
                             MonotonicTime begin, bool flooded) {
  boost::asio::io_context context(1);
  SoftwareClock clock(
      context, {.host = me,
                .oscillator = {begin, SteadyTime(std::chrono::hours(1)), me == 0 ? 30. : -30.},
                .offset = me == 0 ? Nanoseconds(0) : from_ms(300),
                .system_clock = read_system_clock});
  PeerNetworkSettings settings;
  settings.me = me;
  settings.listen = {"127.0.0.1", 0};
  settings.peers = {{"127.0.0.1", master_port}, {"127.0.0.1", 0}};
  PeerNetwork network(context, settings, clock);
  const std::uint16_t port = network.port();
  if (me == 0 && write(port_pipe, &port, sizeof port) != sizeof port) std::abort();
  pid_t flood = 0;
  if (flooded) flood = start_hostile_flood({.target_port = port, .pretended_port = master_port});
  if (flood < 0) fmt::print(stderr, "raw sockets are not permitted here: no flood\n");
  RealHost host(context, me, clock, network, [](const RecordingEvent&) {});
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>("two_way_hull");
  const auto host_sync = entry->make(check_parameters(entry->info.parameters, {}));
  network.start();
  boost::asio::co_spawn(context,
                        me == 0 ? host_sync->run_master(host, {1}) : host_sync->run_slave(host, 0),
                        boost::asio::detached);
  std::vector<Sample> samples;
  boost::asio::co_spawn(context, sample(clock, begin, samples, context), boost::asio::detached);
  context.run();
  if (flood > 0) {
    kill(flood, SIGKILL);
    waitpid(flood, nullptr, 0);
    const NetworkStatistics& seen = network.statistics();
    fmt::print("refused: {} forged, {} replayed, {} malformed, {} beyond the rate\n",
               seen.refused_forged, seen.refused_replayed, seen.refused_malformed,
               seen.refused_rate);
  }
  return samples;
}

// The samples of the other process, from the pipe.
std::vector<Sample> read_samples(int pipe) {
  std::vector<Sample> samples;
  Sample one{};
  while (read(pipe, &one, sizeof one) == sizeof one) samples.push_back(one);
  return samples;
}

bool measure(bool flooded) {
  int ports[2];
  int results[2];
  if (pipe(ports) != 0 || pipe(results) != 0) return false;
  const MonotonicTime begin = monotonic_now();
  const pid_t master = fork();
  if (master == 0) {
    for (const Sample& one : run_node(0, 0, ports[1], begin, false)) {
      if (write(results[1], &one, sizeof one) != sizeof one) std::_Exit(1);
    }
    std::_Exit(0);
  }
  close(results[1]);
  std::uint16_t port = 0;
  if (read(ports[0], &port, sizeof port) != sizeof port) return false;
  const std::vector<Sample> slave = run_node(1, port, -1, begin, flooded);
  const std::vector<Sample> truth = read_samples(results[0]);
  waitpid(master, nullptr, 0);

  std::vector<double> errors_us;
  std::vector<double> absolute_us;
  for (std::size_t i = 0; i < std::min(slave.size(), truth.size()); ++i) {
    errors_us.push_back(static_cast<double>(slave[i].reads_ns - truth[i].reads_ns) * 1e-3);
    absolute_us.push_back(std::abs(errors_us.back()));
  }
  if (errors_us.empty()) return false;
  std::sort(errors_us.begin(), errors_us.end());
  std::sort(absolute_us.begin(), absolute_us.end());
  const std::size_t n = absolute_us.size();
  fmt::print(
      "{:<8} samples {}  error of the clock (us): median {:+.2f}  |error| median {:.2f}  p95 {:.2f}"
      "  max {:.2f}\n",
      flooded ? "flooded" : "quiet", n, errors_us[n / 2], absolute_us[n / 2],
      absolute_us[n * 95 / 100], absolute_us.back());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const bool flood = argc > 1 && std::string_view(argv[1]) == "flood";
  return measure(false) && (!flood || measure(true)) ? 0 : 1;
}

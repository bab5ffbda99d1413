#include "sim/traffic/traffic.h"

#include <algorithm>
#include <utility>

namespace simbench::sim {
namespace {

constexpr double kStackNs = 20'000;  // of each host, both ways together
constexpr scenarios::SendQueue kDefaultSendQueue{
    .discipline = scenarios::QueueDiscipline::kPfifoFast, .ring_kb = 30, .connection_kb = 128};

constexpr ComponentKey kMinutes("traffic: TCP of a minute");
constexpr Nanoseconds kMinute = std::chrono::minutes(1);
constexpr Nanoseconds kLead = std::chrono::seconds(5);  // from slow start to its usual course

TrueTime at_second(double seconds) { return TrueTime(from_seconds(seconds)); }

}  // namespace

CrossTraffic::CrossTraffic(const scenarios::Network& network, const scenarios::Hosts& hosts,
                           std::uint64_t run_seed, std::size_t host_count)
    : host_count_(host_count),
      switch_of_host_(network.switch_of_host),
      line_bytes_per_ns_(network.bandwidth_mbit_per_s / 8'000),
      send_queue_(hosts.send_queue.value_or(kDefaultSendQueue)),
      run_seed_(run_seed) {
  if (network.traffic.empty() || line_bytes_per_ns_ == 0) return;
  for (const std::int64_t number : switch_of_host_) {
    switch_count_ = std::max(switch_count_, static_cast<std::size_t>(number) + 1);
  }
  number_ports(network.traffic);
  for (const scenarios::Traffic& traffic : network.traffic) {
    const Way there{.from = static_cast<std::size_t>(traffic.from),
                    .to = static_cast<std::size_t>(traffic.to)};
    add(traffic, there, network);
    if (traffic.both_ways) add(traffic, {.from = there.to, .to = there.from}, network);
  }
  std::vector<double> buffers;
  for (std::size_t port = 0; port < used_.size(); ++port) {
    if (used_[port] == kUnused) continue;
    const double buffer_bytes = port < host_count_ ? 0 : network.buffer_kb * 1e3;
    ports_.push_back({.bytes_per_ns = line_bytes_per_ns_,
                      .buffer_bytes = buffer_bytes,
                      .pauses = network.flow_control});
    buffers.push_back(buffer_bytes);
  }
  if (!streams_.empty()) {
    bursts_.emplace(line_bytes_per_ns_, std::move(streams_), std::move(buffers), run_seed);
  }
}

std::vector<std::size_t> CrossTraffic::ports_of(Way way) const {
  std::vector<std::size_t> ports{way.from};
  std::size_t number = switch_of(way.from);
  const std::size_t last = switch_of(way.to);
  while (number != last) {
    const bool up = last > number;
    ports.push_back(trunk_port(number, up));
    number = up ? number + 1 : number - 1;
  }
  ports.push_back(switch_port(way.to));
  return ports;
}

std::vector<std::size_t> CrossTraffic::used_ports_of(Way way) const {
  std::vector<std::size_t> ports = ports_of(way);
  for (std::size_t& port : ports) port = used_[port];
  return ports;
}

void CrossTraffic::number_ports(const std::vector<scenarios::Traffic>& traffic) {
  used_.assign(switch_port(host_count_), kUnused);
  for (const scenarios::Traffic& stream : traffic) {
    const auto from = static_cast<std::size_t>(stream.from);
    const auto to = static_cast<std::size_t>(stream.to);
    for (const std::size_t port : ports_of({.from = from, .to = to})) used_[port] = 0;
    if (stream.both_ways || stream.kind == scenarios::TrafficKind::kTcp) {
      for (const std::size_t port : ports_of({.from = to, .to = from})) used_[port] = 0;
    }
  }
  std::uint32_t next = 0;
  for (std::uint32_t& number : used_) {
    if (number != kUnused) number = next++;
  }
}

void CrossTraffic::add(const scenarios::Traffic& traffic, Way way,
                       const scenarios::Network& network) {
  const TrueTime begin = at_second(traffic.begin_s);
  const TrueTime end = traffic.end_s ? at_second(*traffic.end_s) : TrueTime::max();
  const std::vector<std::size_t> ports = used_ports_of(way);
  if (traffic.kind == scenarios::TrafficKind::kTcp) {
    const FluidConnection connection{.data_ports = ports,
                                     .ack_ports = used_ports_of({.from = way.to, .to = way.from}),
                                     .congestion = traffic.congestion,
                                     .connection_bytes = send_queue_.connection_kb * 1e3,
                                     .base_round_trip = base_round_trip(way, network),
                                     .begin = begin,
                                     .end = end};
    connections_.insert(connections_.end(), static_cast<std::size_t>(traffic.connections),
                        connection);
    return;
  }
  const double bytes_per_ns = traffic.mbit_per_s.value_or(0) / 8'000;
  if (bytes_per_ns == 0) return;
  for (const std::size_t port : ports) {
    shares_.push_back(
        {.port = port, .share = bytes_per_ns / line_bytes_per_ns_, .begin = begin, .end = end});
  }
  streams_.push_back({.kind = traffic.kind,
                      .ports = ports,
                      .bytes_per_ns = bytes_per_ns,
                      .burst_frames = traffic.burst_kb * 1e3 / kSegmentBytes,
                      .tail_exponent = traffic.tail_exponent,
                      .begin = begin,
                      .end = end});
}

Nanoseconds CrossTraffic::base_round_trip(Way way, const scenarios::Network& network) const {
  const auto hops = static_cast<double>(ports_of(way).size());
  const double on_the_lines_ns = hops * (kFullFrameBytes + kAckFrameBytes) / line_bytes_per_ns_;
  const double fixed_ms = 2 * (network.latency_fixed_ms + (hops - 1) * network.switch_residence_ms);
  return from_ms(fixed_ms) + from_ns(on_the_lines_ns + 2 * kStackNs);
}

TcpFluid* CrossTraffic::fluid_at(TrueTime at) {
  if (connections_.empty()) return nullptr;
  const std::int64_t minute = floor_div(at.time_since_epoch().count(), kMinute.count());
  // What comes a little before the newest minute is within its lead.
  if (fluid_ && minute <= minute_) return &*fluid_;
  minute_ = minute;
  const TrueTime begin = TrueTime(minute * kMinute) - kLead;
  std::vector<FluidConnection> connections = connections_;
  for (FluidConnection& connection : connections) {
    connection.begin = std::max(connection.begin, begin);
  }
  RandomStream seed(run_seed_, kMinutes, static_cast<std::uint64_t>(minute));
  fluid_.emplace(ports_, std::move(connections), shares_, seed());
  return &*fluid_;
}

Nanoseconds CrossTraffic::wait(std::size_t port, TrueTime at) {
  TcpFluid* const tcp = fluid_at(at);
  const Nanoseconds behind_tcp = tcp != nullptr ? tcp->delay(port, at) : Nanoseconds(0);
  const Nanoseconds behind_frames = bursts_ ? bursts_->wait(port, at) : Nanoseconds(0);
  return std::max(behind_tcp, behind_frames);
}

HostWait CrossTraffic::at_host(PeerId host, TrueTime at) {
  if (is_none() || used_[host] == kUnused) return {};
  const Nanoseconds backlog = wait(used_[host], at);
  const Nanoseconds ring = from_ns(send_queue_.ring_kb * 1e3 / line_bytes_per_ns_);
  HostWait result;
  result.in_ring = std::min(backlog, ring);
  if (send_queue_.discipline == scenarios::QueueDiscipline::kPfifoFast) {
    result.in_queue = backlog - result.in_ring;
  }
  return result;
}

TrafficPassage CrossTraffic::at_switch(PeerId to, TrueTime at) {
  return passage(switch_port(to), at);
}

TrafficPassage CrossTraffic::at_trunk(std::size_t number, bool up, TrueTime at) {
  return passage(trunk_port(number, up), at);
}

TrafficPassage CrossTraffic::passage(std::size_t port, TrueTime at) {
  if (is_none() || used_[port] == kUnused) return {};
  const std::size_t used = used_[port];
  TrafficPassage result;
  result.wait = wait(used, at);
  TcpFluid* const tcp = fluid_at(at);
  const double by_tcp = tcp != nullptr ? tcp->loss_share(used, at) : 0;
  const double by_overload = bursts_ ? bursts_->overload_share(used, at) : 0;
  result.loss_share = std::max(by_tcp, by_overload);
  return result;
}

double CrossTraffic::overload_share(std::size_t port) const {
  if (!bursts_ || used_[port] == kUnused) return 0;
  return bursts_->overload_share(used_[port]);
}

}  // namespace simbench::sim

#include "sim/traffic/tcp_fluid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace simbench::sim {
namespace {

constexpr ComponentKey kTcpLosses("traffic: losses of tcp");

constexpr double kFirstWindow = 10;
constexpr double kLeastWindow = 2;
constexpr double kLargestWindow = 16'000;
constexpr double kCubicC = 0.4;  // segments/s^3
constexpr double kCubicBeta = 0.7;
constexpr double kRenoBeta = 0.5;
constexpr double kFriendlyGrowth = 3 * (1 - kCubicBeta) / (1 + kCubicBeta);
constexpr double kAckWeight = kAckFrameBytes / (2 * kFullFrameBytes);
// Chosen such that queues agree with those of each packet simulated; see the test.
constexpr double kFrontFrames = 1.3;  // free in a full buffer on average
constexpr double kGrowerLoses = 0.8;  // a frame too many is of a window that has just grown
constexpr double kSameLoses = 0.3;    // or of the connection that lost the last one
constexpr double kFluctuation = 0.6;  // of a queue's frames that circulate through other queues
constexpr double kHeldAcknowledged = 0.5;  // segments that wait for a second one
constexpr double kLongestStepNs = 20e6;
// The share of what is too much in a paused host by which a window shrinks in a step, so that
// windows that share a port do not swing.
constexpr double kHeldShare = 0.1;
constexpr double kLeastLeftToTcp = 0.01;  // what others leave to TCP in any case

double ns_of(TrueTime t) { return static_cast<double>(t.time_since_epoch().count()); }

}  // namespace

TcpFluid::TcpFluid(std::vector<FluidPort> ports, std::vector<FluidConnection> connections,
                   std::vector<FluidShare> others, std::uint64_t run_seed)
    : queues_(ports.size()), others_(std::move(others)), draws_(run_seed, kTcpLosses) {
  for (std::size_t p = 0; p < ports.size(); ++p) {
    Queue& queue = queues_[p];
    queue.line_per_ns = ports[p].bytes_per_ns / kFullFrameBytes;
    queue.free_per_ns = queue.line_per_ns;
    const double frames = std::floor(ports[p].buffer_bytes / kFullFrameBytes);
    if (frames > 0) queue.full_ns = std::max(1.0, frames - kFrontFrames) / queue.line_per_ns;
    queue.pauses = ports[p].pauses && frames > 0;
  }
  for (const FluidConnection& connection : connections) add_flow(connection);
  for (const FluidShare& other : others_) {
    changes_ns_.push_back(ns_of(other.begin));
    changes_ns_.push_back(ns_of(other.end));
  }
  for (const Flow& flow : flows_) {
    changes_ns_.push_back(flow.begin_ns);
    changes_ns_.push_back(flow.end_ns);
  }
  std::sort(changes_ns_.begin(), changes_ns_.end());
  find_queues_that_can_be();
  now_ns_ = changes_ns_.empty() ? 0 : changes_ns_.front();
  times_ns_.assign(kHistory, 0);
  delays_ns_.assign(kHistory * queues_.size(), 0);
  loss_shares_.assign(kHistory * queues_.size(), 0);
  fed_per_ns_.assign(queues_.size(), 0);
  keep();
}

void TcpFluid::add_flow(const FluidConnection& connection) {
  const std::size_t number = flows_.size();
  Flow flow;
  flow.base_ns = std::max(1.0, static_cast<double>(connection.base_round_trip.count()));
  flow.limit_segments = std::max(1.0, connection.connection_bytes / kFullFrameBytes);
  flow.own_port = connection.data_ports.front();
  flow.is_cubic = connection.congestion == scenarios::CongestionControl::kCubic;
  flow.begin_ns = ns_of(connection.begin);
  flow.end_ns = ns_of(connection.end);
  flow.round_trip_ns = flow.base_ns;
  flows_.push_back(flow);
  std::size_t feeder = flow.own_port;
  for (const std::size_t port : connection.data_ports) {
    queues_[port].passers.push_back(
        {.flow = number, .weight = 1, .is_own = port == flow.own_port, .feeder = feeder});
    feeder = port;
  }
  for (const std::size_t port : connection.ack_ports) {
    queues_[port].passers.push_back({.flow = number, .weight = kAckWeight});
  }
  // A port that one other port feeds, at no higher rate, never queues.
  for (const auto* way : {&connection.data_ports, &connection.ack_ports}) {
    for (std::size_t i = 1; i < way->size(); ++i) {
      feeds_.emplace_back((*way)[i - 1], (*way)[i]);
    }
  }
}

void TcpFluid::find_queues_that_can_be() {
  for (std::size_t p = 0; p < queues_.size(); ++p) {
    Queue& queue = queues_[p];
    if (queue.full_ns == 0) continue;
    queue.can_queue = false;
    std::size_t feeder = queues_.size();
    for (const auto& [from, to] : feeds_) {
      if (to != p) continue;
      if (feeder != queues_.size() && feeder != from) queue.can_queue = true;
      feeder = from;
      if (queues_[from].line_per_ns > queue.line_per_ns * 1.001) queue.can_queue = true;
    }
    for (const FluidShare& other : others_) queue.can_queue |= other.port == p;
  }
}

Nanoseconds TcpFluid::delay(std::size_t port, TrueTime at) {
  const Place there = place(at);
  const double before_ns = delays_ns_[cell(there.row, port)];
  const double after_ns = delays_ns_[cell(there.row + 1, port)];
  return from_ns(before_ns + there.share_of_next * (after_ns - before_ns));
}

double TcpFluid::loss_share(std::size_t port, TrueTime at) {
  // A step's losses are kept with its end.
  const Place there = place(at);
  return there.share_of_next > 0 ? loss_shares_[cell(there.row + 1, port)]
                                 : loss_shares_[cell(there.row, port)];
}

TcpFluid::Place TcpFluid::place(TrueTime at) {
  const double at_ns = ns_of(at);
  while (now_ns_ <= at_ns && std::isfinite(now_ns_)) step();
  const std::uint64_t newest = step_count_ - 1;
  if (newest == 0) return {.row = kHistory, .share_of_next = 0};
  const std::uint64_t oldest = newest >= kHistory ? newest - kHistory + 1 : 0;
  std::uint64_t before = newest - 1;
  while (before > oldest && times_ns_[before % kHistory] > at_ns) --before;
  const double begin_ns = times_ns_[before % kHistory];
  const double end_ns = times_ns_[(before + 1) % kHistory];
  const double share = end_ns > begin_ns ? (at_ns - begin_ns) / (end_ns - begin_ns) : 1;
  return {.row = static_cast<std::size_t>(before), .share_of_next = std::clamp(share, 0.0, 1.0)};
}

void TcpFluid::step() {
  double length_ns = step_length_ns();
  bool is_change = false;
  if (next_change_ < changes_ns_.size() && now_ns_ + length_ns >= changes_ns_[next_change_]) {
    length_ns = changes_ns_[next_change_] - now_ns_;
    is_change = true;
  }
  now_ns_ += length_ns;
  if (!std::isfinite(now_ns_)) return;
  for (Flow& flow : flows_) {
    if (flow.phase != Phase::kIdle) advance(flow, length_ns);
  }
  if (is_change) change_activity();
  solve(is_change ? 100 : 8);
  for (std::size_t p = 0; p < queues_.size(); ++p) drop(p, length_ns);
  keep();
}

double TcpFluid::step_length_ns() const {
  double shortest_ns = std::numeric_limits<double>::infinity();
  for (const Flow& flow : flows_) {
    if (flow.phase != Phase::kIdle) shortest_ns = std::min(shortest_ns, flow.round_trip_ns);
  }
  if (!std::isfinite(shortest_ns)) return shortest_ns;
  const double least_ns = shortest_ns * 0.25;
  double length_ns = kLongestStepNs;
  for (const Queue& queue : queues_) {
    if (queue.full_ns == 0 || !queue.can_queue || queue.pauses) continue;
    double growth_per_ns = 0;
    for (const Passer& passer : queue.passers) {
      if (passer.weight == 1) growth_per_ns += flows_[passer.flow].growth_per_ns;
    }
    const double room = (queue.full_ns - queue.delay_ns) * queue.free_per_ns;
    if (growth_per_ns * length_ns * 4 > room) length_ns = room / (4 * growth_per_ns);
  }
  for (const Flow& flow : flows_) {
    if (flow.phase == Phase::kLost) length_ns = std::min(length_ns, flow.knows_ns - now_ns_);
    if (flow.phase == Phase::kRecovering) {
      length_ns = std::min({length_ns, flow.recovered_ns - now_ns_, 0.5 * shortest_ns});
    }
  }
  return std::max(length_ns, least_ns);
}

void TcpFluid::change_activity() {
  while (next_change_ < changes_ns_.size() && changes_ns_[next_change_] <= now_ns_) ++next_change_;
  for (Flow& flow : flows_) {
    const bool is_active = flow.begin_ns <= now_ns_ && now_ns_ < flow.end_ns;
    if (is_active && flow.phase == Phase::kIdle) {
      flow.phase = Phase::kSlowStart;
      flow.window = kFirstWindow;
      flow.in_flight = kFirstWindow;
      flow.lost = flow.lost_while_recovering = flow.window_max = 0;
    } else if (!is_active) {
      flow.phase = Phase::kIdle;
      flow.in_flight = flow.growth_per_ns = flow.per_ns = 0;
    }
    flow.round_trip_ns = flow.base_ns;
  }
  for (Queue& queue : queues_) {
    queue.delay_ns = 0;  // so that what was downstream can go upstream
    queue.free_per_ns = queue.line_per_ns;
  }
  for (const FluidShare& other : others_) {
    if (now_ns_ < ns_of(other.begin) || now_ns_ >= ns_of(other.end)) continue;
    Queue& queue = queues_[other.port];
    queue.free_per_ns = std::max(kLeastLeftToTcp * queue.line_per_ns,
                                 queue.free_per_ns - other.share * queue.line_per_ns);
  }
}

void TcpFluid::advance(Flow& flow, double length_ns) {
  flow.has_grown = false;
  flow.growth_per_ns = 0;
  if (flow.phase == Phase::kRecovering || flow.phase == Phase::kLost) advance_loss(flow);
  if (flow.phase != Phase::kRecovering) {
    const double before = flow.window;
    if (!flow.is_held_back) grow(flow, length_ns);
    flow.has_grown = std::floor(flow.window) > std::floor(before);
    flow.growth_per_ns = (flow.window - before) / length_ns;
    flow.in_flight = std::floor(flow.window) - kHeldAcknowledged - flow.lost;
  } else {
    const double beta = flow.is_cubic ? kCubicBeta : kRenoBeta;
    const double share =
        std::clamp((now_ns_ - flow.knows_ns) / (flow.recovered_ns - flow.knows_ns), 0.0, 1.0);
    const double from = flow.window - flow.lost;
    flow.in_flight = from + share * (std::min(from, beta * flow.window) - from) -
                     kHeldAcknowledged - flow.lost_while_recovering;
  }
  flow.in_flight = std::max(flow.in_flight, 1.0);
}

void TcpFluid::advance_loss(Flow& flow) {
  const double beta = flow.is_cubic ? kCubicBeta : kRenoBeta;
  if (flow.phase == Phase::kLost && now_ns_ >= flow.knows_ns) {
    flow.phase = Phase::kRecovering;
    flow.recovered_ns = flow.knows_ns + flow.round_trip_ns;
    return;
  }
  if (flow.phase != Phase::kRecovering || now_ns_ < flow.recovered_ns) return;
  flow.window_max = flow.window < flow.window_max ? flow.window * (1 + beta) / 2 : flow.window;
  flow.window = std::max(kLeastWindow, beta * flow.window);
  flow.lost = flow.lost_while_recovering;
  flow.lost_while_recovering = 0;
  begin_epoch(flow);
  flow.phase = flow.lost > 0 ? Phase::kLost : Phase::kOpen;
  flow.knows_ns = flow.knows_later_ns;
}

void TcpFluid::begin_epoch(Flow& flow) {
  flow.epoch_ns = now_ns_;
  flow.friendly_window = flow.window;
  if (flow.is_cubic) flow.k_s = std::cbrt(std::max(0.0, flow.window_max - flow.window) / kCubicC);
}

void TcpFluid::grow(Flow& flow, double length_ns) {
  const double round_trips = length_ns / flow.round_trip_ns;
  if (flow.phase == Phase::kSlowStart) {
    flow.window *= 1 + std::min(1.0, round_trips);
  } else if (flow.is_cubic) {
    flow.friendly_window += kFriendlyGrowth * round_trips;
    const double since_s = (now_ns_ - flow.epoch_ns + flow.round_trip_ns) * 1e-9 - flow.k_s;
    const double target =
        std::min(kCubicC * since_s * since_s * since_s + flow.window_max, 1.5 * flow.window);
    if (target > flow.window) flow.window += std::min(1.0, round_trips) * (target - flow.window);
    flow.window = std::max(flow.window, flow.friendly_window);
  } else {
    flow.window += round_trips;
  }
  flow.window = std::min(flow.window, kLargestWindow);
}

void TcpFluid::solve(int most_sweeps) {
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest_ns = 0;
    for (std::size_t p = 0; p < queues_.size(); ++p) {
      if (queues_[p].can_queue && !queues_[p].passers.empty()) {
        largest_ns = std::max(largest_ns, solve_queue(p));
      }
    }
    if (largest_ns < 200) break;
  }
  hold_back();
}

void TcpFluid::hold_back() {
  for (Flow& flow : flows_) flow.paused_ns = 0;
  for (const Queue& queue : queues_) {
    const double paused_ns = queue.paused_ns();
    if (paused_ns == 0) continue;
    for (const Passer& passer : queue.passers) {
      if (passer.weight == 1) flows_[passer.flow].paused_ns += paused_ns;
    }
  }
  for (Flow& flow : flows_) {
    const double own_ns = queues_[flow.own_port].delay_ns + flow.paused_ns;
    const double own_segments = flow.in_flight * own_ns / flow.round_trip_ns;
    flow.is_held_back = own_segments > flow.limit_segments;
    // Nothing is lost that would make the window smaller.
    if (flow.is_held_back && flow.paused_ns > 0) {
      const double too_much = own_segments - flow.limit_segments;
      flow.window = std::max(kLeastWindow, flow.window - kHeldShare * too_much);
    }
  }
}

// A step towards the delay with which the port is just filled; returns its size. For one connection
// the inverse of the load is a straight line in the delay, and one step is exact.
double TcpFluid::solve_queue(std::size_t port) {
  Queue& queue = queues_[port];
  double load = 0;
  double slope = 0;
  for (const Passer& passer : queue.passers) {
    Flow& flow = flows_[passer.flow];
    if (flow.phase == Phase::kIdle) continue;
    const double own_delay_ns = queues_[flow.own_port].delay_ns;
    double per_ns = flow.in_flight / flow.round_trip_ns;
    double its_slope = per_ns / flow.round_trip_ns;
    if (per_ns * own_delay_ns > flow.limit_segments) {
      per_ns = flow.limit_segments / own_delay_ns;
      its_slope = passer.is_own ? per_ns / own_delay_ns : 0;
    }
    flow.per_ns = per_ns;
    load += passer.weight * per_ns;
    slope += passer.weight * its_slope;
  }
  double delay_ns = queue.delay_ns;
  if (slope > 0) delay_ns += (load / queue.free_per_ns - 1) * load / slope;
  delay_ns = std::max(0.0, delay_ns);
  const double change_ns = delay_ns - queue.delay_ns;
  if (change_ns == 0) return 0;
  queue.delay_ns = delay_ns;
  for (const Passer& passer : queue.passers) flows_[passer.flow].round_trip_ns += change_ns;
  return std::abs(change_ns);
}

// The mean queue at which the port begins to drop. Frames of connections that wait elsewhere too
// are here or there by chance: their number fluctuates, binomially if they were independent.
double TcpFluid::overflow_ns(const Queue& queue) const {
  double variance = 0;
  for (const Passer& passer : queue.passers) {
    const Flow& flow = flows_[passer.flow];
    if (passer.weight != 1 || flow.phase == Phase::kIdle) continue;
    const double waiting_ns = std::max(1.0, flow.round_trip_ns - flow.base_ns);
    const double elsewhere = std::clamp(1 - queue.delay_ns / waiting_ns, 0.0, 1.0);
    variance += flow.per_ns * queue.delay_ns * elsewhere;
  }
  const double margin_ns = kFluctuation * std::sqrt(variance) / queue.line_per_ns;
  return std::max(queue.full_ns - margin_ns, 0.5 * queue.full_ns);
}

void TcpFluid::drop(std::size_t port, double length_ns) {
  Queue& queue = queues_[port];
  queue.loss_share = 0;
  if (queue.full_ns == 0 || queue.pauses || queue.delay_ns <= 0.5 * queue.full_ns) return;
  const double limit_ns = overflow_ns(queue);
  if (queue.delay_ns <= limit_ns) return;
  const double too_long_ns = queue.delay_ns - limit_ns;
  const double frames = std::ceil(too_long_ns * queue.free_per_ns);
  for (double i = 0; i < frames; ++i) {
    const bool is_same =
        flows_[queue.last_loser].phase == Phase::kLost && draws_.chance(kSameLoses);
    if (!is_same) queue.last_loser = loser(queue);
    lose(flows_[queue.last_loser]);
  }
  queue.loss_share = std::min(1.0, frames / (frames + queue.free_per_ns * length_ns));
  queue.delay_ns = limit_ns;
  for (const Passer& passer : queue.passers) flows_[passer.flow].round_trip_ns -= too_long_ns;
}

// Frames of one link come one after the other and never collide; a collision is between links, and
// each of two is as likely to lose whatever its share.
std::size_t TcpFluid::loser(const Queue& queue) {
  for (const Passer& passer : queue.passers) fed_per_ns_[passer.feeder] = 0;
  double all = 0;
  for (const Passer& passer : queue.passers) {
    if (passer.weight != 1) continue;
    fed_per_ns_[passer.feeder] += flows_[passer.flow].per_ns;
    all += flows_[passer.flow].per_ns;
  }
  double sum = 0;
  const bool is_growers = draws_.chance(kGrowerLoses);
  const auto weight = [&](const Passer& passer) {
    const Flow& flow = flows_[passer.flow];
    if (passer.weight != 1 || flow.phase == Phase::kIdle) return 0.0;
    return flow.per_ns * (1.0001 - fed_per_ns_[passer.feeder] / all) *
           (is_growers && !flow.has_grown ? 1e-6 : 1.0);
  };
  for (const Passer& passer : queue.passers) sum += weight(passer);
  double left = draws_.uniform() * sum;
  std::size_t last = queue.passers.front().flow;
  for (const Passer& passer : queue.passers) {
    const double its = weight(passer);
    if (its == 0) continue;
    last = passer.flow;
    left -= its;
    if (left <= 0) break;
  }
  return last;
}

void TcpFluid::lose(Flow& flow) {
  flow.has_grown = false;
  if (flow.phase == Phase::kRecovering) {
    if (flow.lost_while_recovering == 0) flow.knows_later_ns = now_ns_ + flow.round_trip_ns;
    ++flow.lost_while_recovering;
    return;
  }
  if (flow.phase != Phase::kLost) {
    flow.phase = Phase::kLost;
    flow.knows_ns = now_ns_ + flow.round_trip_ns;
  }
  ++flow.lost;
}

double TcpFluid::wait_ns(std::size_t port) const {
  const Queue& queue = queues_[port];
  double all = 0;
  double paused = 0;
  for (const Passer& passer : queue.passers) {
    if (!passer.is_own) continue;
    const Flow& flow = flows_[passer.flow];
    all += flow.per_ns;
    paused += flow.per_ns * flow.paused_ns;
  }
  return queue.delay_ns - queue.paused_ns() + (all > 0 ? paused / all : 0);
}

void TcpFluid::keep() {
  times_ns_[step_count_ % kHistory] = now_ns_;
  for (std::size_t p = 0; p < queues_.size(); ++p) {
    delays_ns_[cell(step_count_, p)] = wait_ns(p);
    loss_shares_[cell(step_count_, p)] = queues_[p].loss_share;
  }
  ++step_count_;
}

}  // namespace simbench::sim

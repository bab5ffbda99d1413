#include "algorithms/host_sync/huygens/probe_link.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace simbench {
namespace {

// Part of an interval by which it is varied, so that the hosts' probes do not stay in step.
constexpr double kProbesVary = 0.2;
constexpr int kWindowsKept = 3;
constexpr std::size_t kFewestPoints = 4;

// No more vertices than a message holds: evenly chosen, with both ends. Each is a bound.
std::vector<LinePoint> thinned(std::span<const LinePoint> vertices) {
  constexpr std::size_t kMost = BoundsMessage::kMostVertices;
  if (vertices.size() <= kMost) return {vertices.begin(), vertices.end()};
  std::vector<LinePoint> kept;
  kept.reserve(kMost);
  for (std::size_t i = 0; i < kMost; ++i) {
    kept.push_back(vertices[i * (vertices.size() - 1) / (kMost - 1)]);
  }
  return kept;
}

}  // namespace

ProbeLink::ProbeLink(Host& host, PeerId peer, const HuygensSettings& settings, RawClock& raw)
    : host_(host),
      peer_(peer),
      settings_(settings),
      raw_(raw),
      is_a_(host.id() < peer),
      probes_(settings.purity) {}

Task<void> ProbeLink::probe() {
  SteadyTime next = host_.steady_clock().now() +
                    from_ns(host_.random_uniform() * to_ns(settings_.probe_interval));
  ProbeMessage probe{.pair = 0};
  while (raw_.lacking().empty()) {
    next += settings_.probe_interval;
    const double late = kProbesVary * host_.random_uniform() * to_ns(settings_.probe_interval);
    const Nanoseconds pause = next + from_ns(late) - host_.steady_clock().now();
    if (pause.count() < 0) continue;
    co_await host_.sleep_for(pause);
    const SteadyTime begin = host_.steady_clock().now();
    ++probe.pair;
    probe.member = 0;
    const std::optional<std::int64_t> first = co_await send(probe);
    const Nanoseconds rest = begin + settings_.spacing - host_.steady_clock().now();
    if (rest.count() > 0) co_await host_.sleep_for(rest);
    probe.member = 1;
    const std::optional<std::int64_t> second = co_await send(probe);
    const bool is_stamped = first && second;
    probe.left_pair = is_stamped ? probe.pair : 0;
    probe.left_ns = is_stamped ? std::array{*first, *second} : std::array<std::int64_t, 2>{};
  }
}

Task<std::optional<std::int64_t>> ProbeLink::send(ProbeMessage probe) {
  MessageChannel& channel = host_.open_channel(peer_, Transport::kDatagram);
  Bytes bytes = encode(probe);
  const SteadyTime begin = host_.steady_clock().now();
  const MessageId id = co_await channel.send(std::move(bytes));
  const std::optional<std::int64_t> left = co_await raw_.departure(channel, id, begin);
  co_return left;
}

std::optional<BoundsMessage> ProbeLink::take(const ProbeMessage& probe, std::int64_t arrived_ns) {
  probes_.arrive(probe.pair, probe.member, arrived_ns);
  if (probe.left_pair == 0) return std::nullopt;
  const std::optional<CodedProbes::Pair> ways = probes_.departed(probe.left_pair, probe.left_ns);
  if (!ways) return std::nullopt;
  if (!is_a_) return add_above(probe.left_pair, *ways);
  add_below(*ways);
  return std::nullopt;
}

std::optional<BoundsMessage> ProbeLink::add_above(std::uint32_t pair,
                                                  const CodedProbes::Pair& ways) {
  const auto pairs =
      std::max<std::int64_t>(1, settings_.window.count() / settings_.probe_interval.count());
  const auto number = static_cast<std::uint32_t>(pair / pairs);
  std::optional<BoundsMessage> ended;
  if (number != window_.number) {
    if (window_.points >= kFewestPoints) {
      ended = BoundsMessage{.begin_ns = window_.begin_ns,
                            .end_ns = window_.end_ns,
                            .vertices = thinned(window_.hull.vertices())};
    }
    window_ = Window{.number = number, .hull = {}};
  }
  for (const ProbeWay& way : ways) {
    if (window_.points > 0 && way.left_ns <= window_.end_ns) continue;
    if (window_.points == 0) window_.begin_ns = way.left_ns;
    window_.end_ns = way.left_ns;
    ++window_.points;
    window_.hull.add({.x = way.left_ns, .y = way.arrived_ns - way.left_ns});
  }
  return ended;
}

void ProbeLink::add_below(const CodedProbes::Pair& ways) {
  for (const ProbeWay& way : ways) {
    const LinePoint point{.x = way.arrived_ns, .y = way.arrived_ns - way.left_ns};
    if (!below_negated_.empty() && point.x <= below_negated_.back().x) continue;
    below_negated_.push_back(point);
  }
  const std::int64_t oldest = below_negated_.back().x - kWindowsKept * settings_.window.count();
  while (below_negated_.front().x < oldest) below_negated_.pop_front();
}

std::optional<PairLine> ProbeLink::take(const BoundsMessage& bounds) {
  if (!is_a_) return std::nullopt;
  LowerHull below;
  std::size_t points = 0;
  for (const LinePoint& point : below_negated_) {
    if (point.x < bounds.begin_ns || point.x > bounds.end_ns) continue;
    below.add(point);
    ++points;
  }
  if (points < kFewestPoints) return std::nullopt;
  const std::int64_t middle = bounds.begin_ns + (bounds.end_ns - bounds.begin_ns) / 2;
  return separating_line(bounds.vertices, below.vertices(), middle, settings_.max_rate_ppm * 1e-6);
}

}  // namespace simbench

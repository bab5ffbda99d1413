#include "evaluation/certificates/fact_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "evaluation/certificates/observed_rates.h"

namespace simbench::evaluation {
namespace {

Nanoseconds count_of(DeviceTime device) { return Nanoseconds(nanoseconds_of(device)); }
Nanoseconds count_of(SteadyTime steady) { return steady.time_since_epoch(); }
Picoseconds at_least(Nanoseconds delay) { return -Picoseconds(delay); }

// What a clock counts in the time of the first one, roughly. Never decides more than an order.
struct RoughClock {
  Nanoseconds from{};    // what it counts then
  Nanoseconds common{};  // at this time of the first clock
  double rate = 0;       // against the first clock

  Nanoseconds common_of(Nanoseconds local) const {
    const Nanoseconds step = local - from;
    return common + step -
           Nanoseconds(static_cast<std::int64_t>(static_cast<double>(step.count()) * rate));
  }
};
using RoughClocks = std::vector<std::optional<RoughClock>>;

// Ties of clocks to times that are known: at the latest, or at the earliest.
enum class Bound : std::uint8_t { kLatest, kEarliest };

class RoughTies {
 public:
  void add(std::size_t clock, Nanoseconds at, Nanoseconds common, Bound bound) {
    ties_[clock].push_back({at, common, bound});
  }

  // Sets the clocks that are tied, but those whose two bounds lie so far apart that they say
  // little, as of stamps that a clock read twice, unless `takes_wide`. Whether any was set.
  bool set(RoughClocks& clocks, bool takes_wide) {
    bool any = false;
    for (auto& [clock, ties] : ties_) {
      std::ranges::sort(ties, {}, &Tie::at);
      if (!takes_wide && is_wide(ties)) continue;
      clocks[clock] = clock_of(ties);
      any = true;
    }
    return any;
  }

 private:
  struct Tie {
    Nanoseconds at{};
    Nanoseconds common{};
    Bound bound{};

    Nanoseconds ahead() const { return at - common; }
  };

  // One among neighbours that was not put off: by an odd delay, or since its clock read the same
  // before a step back.
  static Tie middle_of(std::span<Tie> ties) {
    const auto middle = ties.begin() + static_cast<std::ptrdiff_t>(ties.size() / 2);
    std::ranges::nth_element(ties, middle, {}, &Tie::ahead);
    return *middle;
  }

  static bool is_wide(std::span<const Tie> ties) {
    constexpr Nanoseconds kWide = std::chrono::seconds(1);
    std::vector<Tie> latest, earliest;
    for (const Tie& tie : ties) {
      (tie.bound == Bound::kLatest ? latest : earliest).push_back(tie);
    }
    if (latest.empty() || earliest.empty()) return false;
    return middle_of(latest).ahead() - middle_of(earliest).ahead() > kWide;
  }

  // Over less than kLong the delays matter more than the rate, and no clock is faster than
  // kMostRate.
  static RoughClock clock_of(std::span<Tie> ties) {
    constexpr Nanoseconds kLong = std::chrono::seconds(100);
    constexpr double kMostRate = 1e-3;
    const std::size_t third = (ties.size() + 2) / 3;
    const Tie last = middle_of(ties.last(third));
    const Tie first = middle_of(ties.first(third));
    RoughClock clock{first.at, first.common};
    const Nanoseconds span = last.at - first.at;
    if (span < kLong) return clock;
    const double rate = to_ns(last.ahead() - first.ahead()) / to_ns(span);
    if (std::abs(rate) <= kMostRate) clock.rate = rate;
    return clock;
  }

  std::map<std::size_t, std::vector<Tie>> ties_;
};

// Hosts that no message ties are taken to begin with their first frames at one time.
void align_by_first_arrivals(const CaptureEvidence& evidence, RoughClocks& clocks) {
  std::vector<std::optional<Nanoseconds>> first(evidence.layout().hosts);
  for (const FrameEvidence& frame : evidence.frames()) {
    auto& arrival = first[evidence.layout().cameras[frame.camera].host];
    if (!arrival) arrival = count_of(frame.arrival);
  }
  std::optional<Nanoseconds> begin;  // on the first clock
  for (std::size_t host = 0; host < first.size() && !begin; ++host) {
    if (first[host] && clocks[host]) begin = clocks[host]->common_of(*first[host]);
  }
  // Where none of them has frames, as a master without cameras, any origin does.
  for (std::size_t host = 0; host < first.size() && !begin; ++host) begin = first[host];
  for (std::size_t host = 0; begin && host < first.size(); ++host) {
    if (first[host] && !clocks[host]) clocks[host] = RoughClock{*first[host], *begin};
  }
}

// From each clock that is known to those that messages tie to it.
void follow_messages(const CaptureEvidence& evidence, RoughClocks& clocks, bool takes_wide) {
  for (bool is_changed = true; is_changed;) {
    RoughTies ties;
    for (const HostMessage& message : evidence.messages()) {
      const std::size_t from = evidence.clock_of(message.from);
      const std::size_t to = evidence.clock_of(message.to);
      const Nanoseconds sent = count_of(message.sent);
      const Nanoseconds received = count_of(message.received);
      if (clocks[from] && !clocks[to]) {
        ties.add(to, received, clocks[from]->common_of(sent), Bound::kLatest);
      }
      if (clocks[to] && !clocks[from]) {
        ties.add(from, sent, clocks[to]->common_of(received), Bound::kEarliest);
      }
    }
    is_changed = ties.set(clocks, takes_wide);
  }
}

// Each camera from its host, by its polls and frames.
void follow_cameras(const CaptureEvidence& evidence, RoughClocks& clocks) {
  const std::size_t hosts = evidence.layout().hosts;
  RoughTies ties;
  const auto tie = [&](std::uint32_t camera, DeviceTime device, SteadyTime steady) {
    const std::optional<RoughClock>& host = clocks[evidence.layout().cameras[camera].host];
    ties.add(hosts + camera, count_of(device),
             host ? host->common_of(count_of(steady)) : count_of(steady), Bound::kLatest);
  };
  for (const ClockPollEvidence& poll : evidence.polls()) tie(poll.camera, poll.device, poll.t1);
  for (const FrameEvidence& frame : evidence.frames())
    tie(frame.camera, frame.sensor, frame.arrival);
  ties.set(clocks, true);
}

std::vector<RoughClock> rough_clocks(const CaptureEvidence& evidence) {
  RoughClocks clocks(evidence.clocks());
  clocks[0] = RoughClock{};
  follow_messages(evidence, clocks, false);
  align_by_first_arrivals(evidence, clocks);
  follow_messages(evidence, clocks, true);
  follow_cameras(evidence, clocks);
  std::vector<RoughClock> rough;
  rough.reserve(clocks.size());
  for (const auto& known : clocks) rough.push_back(known.value_or(RoughClock{}));
  return rough;
}

// Calls `take` with each stamp and its clock.
template <class Take>
void each_stamp(const CaptureEvidence& evidence, const Take& take) {
  const std::size_t hosts = evidence.layout().hosts;
  const auto host_of = [&](std::uint32_t camera) { return evidence.layout().cameras[camera].host; };
  for (const HostMessage& message : evidence.messages()) {
    take(evidence.clock_of(message.from), count_of(message.sent));
    take(evidence.clock_of(message.to), count_of(message.received));
  }
  for (const ClockPollEvidence& poll : evidence.polls()) {
    take(hosts + poll.camera, count_of(poll.device));
    take(host_of(poll.camera), count_of(poll.t0));
    take(host_of(poll.camera), count_of(poll.t1));
  }
  for (const FrameEvidence& frame : evidence.frames()) {
    take(hosts + frame.camera, count_of(frame.sensor));
    take(host_of(frame.camera), count_of(frame.arrival));
  }
}

void check_spans(const CaptureEvidence& evidence) {
  if (!evidence.broken().empty()) {
    throw NotCertifiable(
        fmt::format("certificates: found {} with a stamp that no clock counts, "
                    "allowed: 40 years since a host's start, 80 since 1970",
                    evidence.broken()));
  }
  struct Span {
    Nanoseconds first = Nanoseconds::max();
    Nanoseconds last = Nanoseconds::min();
  };
  constexpr Nanoseconds kMostSpan = std::chrono::hours(20 * 24);
  std::vector<Span> spans(evidence.clocks());
  each_stamp(evidence, [&](std::size_t clock, Nanoseconds local) {
    spans[clock].first = std::min(spans[clock].first, local);
    spans[clock].last = std::max(spans[clock].last, local);
  });
  for (std::size_t clock = 0; clock < spans.size(); ++clock) {
    const auto& [first, last] = spans[clock];
    if (first > last) continue;  // it has no stamp
    if (last / 2 - first / 2 <= kMostSpan / 2) continue;
    throw NotCertifiable(
        fmt::format("certificates: found stamps of {}'s clock from {:.6g} to {:.6g} s, allowed: at "
                    "most 20 days "
                    "in all; is one of them broken?",
                    evidence.name_of(clock), to_ns(first) * 1e-9, to_ns(last) * 1e-9));
  }
}

// Places 0 .. n-1 by key: begin[k] .. begin[k + 1] of `sorted` have key k.
template <class Key>
void sort_by_key(std::size_t count, std::size_t keys, const Key& key,
                 std::vector<std::uint32_t>& begin, std::vector<std::uint32_t>& sorted) {
  begin.assign(keys + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++begin[key(i) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  sorted.resize(count);
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < count; ++i) sorted[next[key(i)]++] = static_cast<std::uint32_t>(i);
}

}  // namespace

std::vector<RateBound> equal_rates(const CaptureEvidence& evidence, double host_ppm,
                                   double camera_ppm) {
  std::vector<RateBound> rates(evidence.layout().hosts, RateBound(host_ppm));
  rates.resize(rates.size() + evidence.layout().cameras.size(), RateBound(camera_ppm));
  for (const OutsideClock& clock : evidence.outside_clocks()) {
    rates.emplace_back(clock.is_exact ? 0 : host_ppm);
  }
  return rates;
}

std::vector<RateBound> assumed_rates(const CaptureEvidence& evidence) {
  const Assumptions& assumed = evidence.assumptions();
  if (!assumed.observed_margin_ppm) {
    return equal_rates(evidence, assumed.host_rate_ppm, assumed.camera_rate_ppm);
  }
  std::vector<RateBound> rates = equal_rates(evidence, 2 * assumed.host_rate_ppm,
                                             assumed.host_rate_ppm + assumed.camera_rate_ppm);
  // Against host 0, whose clock is time here.
  for (std::size_t i = 0; i < evidence.outside_clocks().size(); ++i) {
    if (!evidence.outside_clocks()[i].is_exact) continue;
    rates[rates.size() - evidence.outside_clocks().size() + i] = RateBound(assumed.host_rate_ppm);
  }
  const std::vector<std::optional<double>> observed = observed_rates_ppm(evidence);
  for (std::size_t clock = 0; clock < rates.size(); ++clock) {
    if (observed[clock]) rates[clock] = RateBound(*observed[clock], *assumed.observed_margin_ppm);
  }
  rates[0] = RateBound(0);
  return rates;
}

FactOrder::FactOrder(const CaptureEvidence& evidence)
    : FactOrder(evidence, assumed_rates(evidence)) {}

FactOrder::FactOrder(const CaptureEvidence& evidence, std::vector<RateBound> rates)
    : hosts_(evidence.layout().hosts), rates_(std::move(rates)) {
  check_spans(evidence);
  add_points(evidence);
  sort_points(evidence);
  index_facts();
}

std::uint32_t FactOrder::add(std::size_t clock, Nanoseconds local) {
  points_.push_back({static_cast<std::uint32_t>(clock), local});
  return static_cast<std::uint32_t>(points_.size() - 1);
}

void FactOrder::fact(std::uint32_t from, std::uint32_t to, Picoseconds most, FactKind kind,
                     std::size_t source) {
  facts_.push_back({from, to, most, kind, static_cast<std::uint32_t>(source)});
}

void FactOrder::add_points(const CaptureEvidence& evidence) {
  const Assumptions& assumed = evidence.assumptions();
  for (std::size_t i = 0; i < evidence.messages().size(); ++i) {
    const HostMessage& message = evidence.messages()[i];
    const std::uint32_t received = add(evidence.clock_of(message.to), count_of(message.received));
    const std::uint32_t sent = add(evidence.clock_of(message.from), count_of(message.sent));
    const Nanoseconds least = message.is_pulse ? Nanoseconds(0) : from_ms(assumed.message_ms);
    fact(received, sent, at_least(least - message.slack),
         message.is_pulse ? FactKind::kPulse : FactKind::kMessage, i);
  }
  const Picoseconds poll_delay = at_least(from_ms(assumed.poll_ms));
  for (std::size_t i = 0; i < evidence.polls().size(); ++i) {
    const ClockPollEvidence& poll = evidence.polls()[i];
    const std::size_t camera = hosts_ + poll.camera;
    const std::uint32_t host = evidence.layout().cameras[poll.camera].host;
    const std::uint32_t least = add(camera, count_of(poll.device));
    const std::uint32_t most = add(camera, count_of(poll.device) + kRegisterStep);
    fact(most, add(host, count_of(poll.t0) - kSteadyStep), poll_delay, FactKind::kPollRequest, i);
    fact(add(host, count_of(poll.t1) + kSteadyStep), least, poll_delay, FactKind::kPollReply, i);
  }
  const Nanoseconds stamp_error = from_us(assumed.sensor_stamp_us);
  const Nanoseconds arrival_error = from_ms(assumed.arrival_stamp_ms) + kSteadyStep;
  for (std::size_t i = 0; i < evidence.frames().size(); ++i) {
    const FrameEvidence& frame = evidence.frames()[i];
    const std::size_t camera = hosts_ + frame.camera;
    const std::uint32_t host = evidence.layout().cameras[frame.camera].host;
    const Nanoseconds sensor = count_of(frame.sensor);
    frames_.push_back(
        {add(camera, sensor - stamp_error), add(camera, sensor + stamp_error + kRegisterStep)});
    const Nanoseconds half = Microseconds(frame.exposure_us / 2);
    const Picoseconds way = rates_[camera].least(half) + Picoseconds(from_ms(assumed.arrival_ms));
    fact(add(host, count_of(frame.arrival) + arrival_error), frames_.back().least, -way,
         FactKind::kArrival, i);
  }
}

// Points by their time, roughly; facts and frames follow them.
void FactOrder::sort_points(const CaptureEvidence& evidence) {
  const std::vector<RoughClock> rough = rough_clocks(evidence);
  std::vector<std::uint32_t> order(points_.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    const ClockPoint& point = points_[i];
    return std::tuple(rough[point.clock].common_of(point.local), point.clock, point.local);
  };
  std::ranges::stable_sort(order, {}, key);
  std::vector<std::uint32_t> place(points_.size());
  std::vector<ClockPoint> sorted;
  sorted.reserve(points_.size());
  for (const std::uint32_t i : order) {
    place[i] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(points_[i]);
  }
  points_ = std::move(sorted);
  for (ClockFact& fact : facts_) {
    fact.from = place[fact.from];
    fact.to = place[fact.to];
  }
  for (FramePoints& frame : frames_) frame = {place[frame.least], place[frame.most]};
}

void FactOrder::index_facts() {
  sort_by_key(
      facts_.size(), points_.size(), [&](std::size_t i) { return facts_[i].later(); },
      closed_begin_, closed_);
  sort_by_key(
      facts_.size(), points_.size(), [&](std::size_t i) { return facts_[i].earlier(); },
      opened_begin_, opened_);
}

std::span<const std::uint32_t> FactOrder::closed_by(std::size_t point) const {
  return std::span(closed_).subspan(closed_begin_[point],
                                    closed_begin_[point + 1] - closed_begin_[point]);
}

std::span<const std::uint32_t> FactOrder::opened_by(std::size_t point) const {
  return std::span(opened_).subspan(opened_begin_[point],
                                    opened_begin_[point + 1] - opened_begin_[point]);
}

}  // namespace simbench::evaluation

#include "evaluation/certificates/fact_order.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "evaluation/certificates/observed_rates.h"

namespace simbench::evaluation {
namespace {

Nanoseconds count_of(DeviceTime device) { return Nanoseconds(nanoseconds_of(device)); }
Nanoseconds count_of(SteadyTime steady) { return steady.time_since_epoch(); }
Picoseconds at_least(Nanoseconds delay) { return -Picoseconds(delay); }

// Hosts that no message ties are taken to begin with their first frames at one time.
void align_by_first_arrivals(const CaptureEvidence& evidence,
                             std::vector<std::optional<Nanoseconds>>& offset) {
  std::vector<std::optional<Nanoseconds>> first(evidence.layout().hosts);
  for (const FrameEvidence& frame : evidence.frames()) {
    auto& arrival = first[evidence.layout().cameras[frame.camera].host];
    if (!arrival) arrival = count_of(frame.arrival);
  }
  std::optional<Nanoseconds> begin;  // on the first clock
  for (std::size_t host = 0; host < first.size() && !begin; ++host) {
    if (first[host] && offset[host]) begin = *first[host] - *offset[host];
  }
  // Where none of them has frames, as a master without cameras, any origin does.
  for (std::size_t host = 0; host < first.size() && !begin; ++host) begin = first[host];
  for (std::size_t host = 0; begin && host < first.size(); ++host) {
    if (first[host] && !offset[host]) offset[host] = *first[host] - *begin;
  }
}

// By how much each clock is ahead of the first, roughly: what its first tie to a clock that is
// known says.
std::vector<Nanoseconds> rough_offsets(const CaptureEvidence& evidence, std::size_t hosts) {
  std::vector<std::optional<Nanoseconds>> offset(hosts + evidence.layout().cameras.size());
  offset[0] = Nanoseconds(0);
  for (std::size_t pass = 0; pass < hosts; ++pass) {
    for (const HostMessage& message : evidence.messages()) {
      const Nanoseconds ahead = count_of(message.received) - count_of(message.sent);
      std::optional<Nanoseconds>& from = offset[message.from];
      std::optional<Nanoseconds>& to = offset[message.to];
      if (from && !to) to = *from + ahead;
      if (to && !from) from = *to - ahead;
    }
  }
  align_by_first_arrivals(evidence, offset);
  const auto tie = [&](std::uint32_t camera, DeviceTime device, SteadyTime steady) {
    std::optional<Nanoseconds>& own = offset[hosts + camera];
    const std::uint32_t host = evidence.layout().cameras[camera].host;
    if (!own) own = offset[host].value_or(Nanoseconds(0)) + count_of(device) - count_of(steady);
  };
  for (const ClockPollEvidence& poll : evidence.polls()) tie(poll.camera, poll.device, poll.t1);
  for (const FrameEvidence& frame : evidence.frames())
    tie(frame.camera, frame.sensor, frame.arrival);
  std::vector<Nanoseconds> rough;
  rough.reserve(offset.size());
  for (const auto& known : offset) rough.push_back(known.value_or(Nanoseconds(0)));
  return rough;
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
  return rates;
}

std::vector<RateBound> assumed_rates(const CaptureEvidence& evidence) {
  const Assumptions& assumed = evidence.assumptions();
  if (!assumed.observed_margin_ppm) {
    return equal_rates(evidence, assumed.host_rate_ppm, assumed.camera_rate_ppm);
  }
  std::vector<RateBound> rates = equal_rates(evidence, 2 * assumed.host_rate_ppm,
                                             assumed.host_rate_ppm + assumed.camera_rate_ppm);
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
    fact(add(message.to, count_of(message.received)), add(message.from, count_of(message.sent)),
         at_least(from_ms(assumed.message_ms)), FactKind::kMessage, i);
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

// Points by their clock's count less its rough offset; facts and frames follow them.
void FactOrder::sort_points(const CaptureEvidence& evidence) {
  const std::vector<Nanoseconds> offset = rough_offsets(evidence, hosts_);
  std::vector<std::uint32_t> order(points_.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    return std::pair(points_[i].local - offset[points_[i].clock], points_[i].clock);
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

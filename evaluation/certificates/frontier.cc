#include "evaluation/certificates/frontier.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {

void Distances::close(bool may_be_long) { may_be_long ? close_all<true>() : close_all<false>(); }

template <bool kMayBeLong>
void Distances::close_all() {
  for (std::size_t k = 0; k < size_; ++k) {
    const std::int64_t* const onward = (*this)[k];
    for (std::size_t i = 0; i < size_; ++i) {
      std::int64_t* const distances = (*this)[i];
      const std::int64_t there = distances[k];
      if (there >= kFar) continue;
      // A sum with what is unbounded stays above kFar.
      for (std::size_t j = 0; j < size_; ++j) {
        std::int64_t sum = there + onward[j];
        if (kMayBeLong) sum = std::max(sum, -kFar);
        distances[j] = std::min(distances[j], sum);
      }
    }
  }
}

FrontierWalk::FrontierWalk(const FactOrder& order, Direction direction)
    : order_(order),
      direction_(direction),
      next_(direction == kForward ? 0 : order.points().size() - 1),
      graph_(order.rates()),
      place_in_open_(order.facts().size()) {}

std::optional<std::uint32_t> FrontierWalk::take_next() {
  const bool is_forward = direction_ == kForward;
  const std::size_t point = next_;
  next_ += is_forward ? std::size_t{1} : ~std::size_t{0};
  ++taken_;
  if (graph_.live().size() > kMostLive) {
    throw NotCertifiable(fmt::format(
        "certificates: found more than {} instants that wait for another, allowed: stamps that "
        "order the clocks; is a clock in the recording reset, or a message's stamp far off?",
        kMostLive));
  }
  const ClockPoint& taken = order_.points()[point];
  const ClockGraph::Point here = graph_.advance(taken.clock, taken.local);
  for (const std::uint32_t fact : is_forward ? order_.opened_by(point) : order_.closed_by(point)) {
    place_in_open_[fact] = static_cast<std::uint32_t>(open_.size());
    open_.push_back({fact, here});
    graph_.keep(here);
  }
  for (const std::uint32_t fact : is_forward ? order_.closed_by(point) : order_.opened_by(point)) {
    if (const auto contradicted = close_fact(fact, here)) return contradicted;
  }
  return std::nullopt;
}

std::optional<std::uint32_t> FrontierWalk::close_fact(std::uint32_t number,
                                                      ClockGraph::Point here) {
  const ClockFact& fact = order_.facts()[number];
  const ClockGraph::Point there = open_[place_in_open_[number]].point;
  open_[place_in_open_[number]] = open_.back();
  place_in_open_[open_.back().fact] = place_in_open_[number];
  open_.pop_back();
  const bool from_is_here = (fact.from > fact.to) == (direction_ == kForward);
  const bool is_possible =
      from_is_here ? graph_.bound(here, there, fact.most) : graph_.bound(there, here, fact.most);
  if (!is_possible) return number;
  graph_.release(there);
  return std::nullopt;
}

Frontier FrontierWalk::frontier() const {
  Frontier frontier;
  frontier.is_long = graph_.is_long();
  for (std::size_t clock = 0; clock < graph_.clocks(); ++clock) {
    if (!graph_.has_begun(clock)) continue;
    const ClockGraph::Point point = graph_.newest(clock);
    frontier.places.push_back(
        {false, static_cast<std::uint32_t>(clock), graph_.local_of(point), point});
  }
  for (const Open& open : open_) {
    frontier.places.push_back({true, open.fact, graph_.local_of(open.point), open.point});
  }
  const std::size_t size = frontier.places.size();
  frontier.distances = Distances(size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      frontier.distances[i][j] =
          graph_.most(frontier.places[i].point, frontier.places[j].point).count();
    }
  }
  return frontier;
}

FrontierWalk::Saved FrontierWalk::save() const { return {taken_, next_, graph_, open_}; }

void FrontierWalk::restore(const Saved& saved) {
  taken_ = saved.taken;
  next_ = saved.next;
  graph_ = saved.graph;
  open_ = saved.open;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    place_in_open_[open_[i].fact] = static_cast<std::uint32_t>(i);
  }
}

namespace {

// The ways from a point of the past to its counterpart in the future, and back.
struct Crossing {
  std::optional<std::size_t> there{};
  std::int64_t out = ClockGraph::kUnbounded.count();
  std::int64_t back = ClockGraph::kUnbounded.count();
};

Crossing crossing_of(const FactOrder& order, const Frontier::Place& here, const Frontier& future) {
  const auto there = std::ranges::find_if(future.places, [&](const Frontier::Place& place) {
    return place.is_fact == here.is_fact && place.number == here.number;
  });
  if (there == future.places.end()) return {};
  Crossing crossing{.there = static_cast<std::size_t>(there - future.places.begin())};
  if (here.is_fact) {
    const ClockFact& fact = order.facts()[here.number];
    (fact.from < fact.to ? crossing.out : crossing.back) = fact.most.count();
    return crossing;
  }
  const RateBound& rate = order.rates()[here.number];
  crossing.out = rate.most(there->local - here.local).count();
  crossing.back = -rate.least(there->local - here.local).count();
  return crossing;
}

}  // namespace

// What the future adds to the past is a way out, a way there, and a way back.
Distances join(const FactOrder& order, const Frontier& past, const Frontier& future) {
  const std::size_t size = past.places.size();
  std::vector<Crossing> crossings;
  for (const Frontier::Place& place : past.places) {
    crossings.push_back(crossing_of(order, place, future));
  }
  Distances joined = past.distances;
  for (std::size_t i = 0; i < size; ++i) {
    if (crossings[i].out >= Distances::kFar) continue;
    const std::int64_t* const onward = future.distances[*crossings[i].there];
    for (std::size_t j = 0; j < size; ++j) {
      if (crossings[j].back >= Distances::kFar) continue;
      const std::int64_t there = onward[*crossings[j].there];
      if (there >= Distances::kFar) continue;
      const std::int64_t sum = crossings[i].out + there + crossings[j].back;
      joined[i][j] = std::min(joined[i][j], std::max(sum, -Distances::kFar));
    }
  }
  joined.close(past.is_long || future.is_long);
  return joined;
}

}  // namespace simbench::evaluation

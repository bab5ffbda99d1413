#include "algorithms/certificates/clock_graph.h"

#include <algorithm>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench {

ClockGraph::ClockGraph(std::vector<RateBound> clocks)
    : rates_(std::move(clocks)), newest_(rates_.size(), kNone) {}

// Doubles the matrix.
void ClockGraph::grow() {
  const std::size_t old_stride = stride_;
  const std::size_t stride = std::max<std::size_t>(16, 2 * old_stride);
  std::vector<std::int64_t> distances(stride * stride, kUnbounded.count());
  for (std::size_t i = 0; i < old_stride; ++i) {
    std::copy_n(row(static_cast<Point>(i)), old_stride, distances.begin() + i * stride);
  }
  distances_ = std::move(distances);
  stride_ = stride;
  places_.resize(stride);
  place_in_live_.resize(stride);
  for (std::size_t i = stride; i > old_stride; --i) free_.push_back(static_cast<Point>(i - 1));
}

ClockGraph::Point ClockGraph::take_place() {
  if (free_.empty()) grow();
  const Point point = free_.back();
  free_.pop_back();
  place_in_live_[point] = static_cast<std::uint32_t>(live_.size());
  live_.push_back(point);
  return point;
}

void ClockGraph::remove(Point point) {
  const std::uint32_t place = place_in_live_[point];
  live_[place] = live_.back();
  place_in_live_[live_[place]] = place;
  live_.pop_back();
  free_.push_back(point);
}

ClockGraph::Point ClockGraph::newest(std::size_t clock) const {
  SIMBENCH_ASSERT(has_begun(clock), "the clock has no point yet");
  return newest_[clock];
}

ClockGraph::Point ClockGraph::advance(std::size_t clock, Nanoseconds local) {
  const Point point = take_place();
  places_[point] = {static_cast<std::uint32_t>(clock), 0, local};
  const Point before = std::exchange(newest_[clock], point);
  std::int64_t* const from_here = row(point);
  if (before == kNone) {
    std::fill_n(from_here, stride_, kUnbounded.count());
    for (const Point other : live_) row(other)[point] = kUnbounded.count();
    from_here[point] = 0;
    return point;
  }
  const Nanoseconds step = local - places_[before].local;
  const std::int64_t ahead = rates_[clock].most(step).count();
  const std::int64_t back = -rates_[clock].least(step).count();
  go_further(std::max(std::abs(ahead), std::abs(back)));
  const std::int64_t* const from_before = row(before);
  for (std::size_t i = 0; i < stride_; ++i) {
    from_here[i] =
        from_before[i] >= kFar ? kUnbounded.count() : std::max(from_before[i] + back, -kFar);
  }
  for (const Point other : live_) {
    std::int64_t* const from_other = row(other);
    const std::int64_t here = from_other[before];
    from_other[point] = here >= kFar || ahead >= kFar ? kUnbounded.count() : here + ahead;
  }
  from_here[point] = 0;
  if (places_[before].kept == 0) remove(before);
  return point;
}

void ClockGraph::keep(Point point) { ++places_[point].kept; }

void ClockGraph::release(Point point) {
  Place& place = places_[point];
  SIMBENCH_ASSERT(place.kept > 0, "a point that is not kept cannot be released");
  if (--place.kept == 0 && newest_[place.clock] != point) remove(point);
}

bool ClockGraph::bound(Point from, Point to, Picoseconds most) {
  const std::int64_t fact = most.count();
  if (row(from)[to] <= fact || fact >= kFar) return true;
  const std::int64_t return_way = row(to)[from];
  if (return_way < kFar && return_way + fact < 0) return false;
  go_further(-fact);
  is_long() ? shorten<true>(from, to, fact) : shorten<false>(from, to, fact);
  return true;
}

template <bool kIsLong>
void ClockGraph::shorten(Point from, Point to, std::int64_t fact) {
  const std::int64_t* const onward = row(to);
  for (const Point other : live_) {
    std::int64_t* const distances = row(other);
    if (distances[from] >= kFar) continue;
    std::int64_t there = distances[from] + fact;
    if (kIsLong) there = std::max(there, -kFar);
    if (there >= distances[to]) continue;  // then no way over the fact is shorter
    for (std::size_t j = 0; j < stride_; ++j) {
      std::int64_t sum = there + onward[j];
      if (kIsLong) sum = std::max(sum, -kFar);
      const bool is_shorter = onward[j] < kFar && sum < distances[j];
      distances[j] = is_shorter ? sum : distances[j];
    }
  }
}

}  // namespace simbench

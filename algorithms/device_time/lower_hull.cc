#include "algorithms/device_time/lower_hull.h"

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Keeps at most half of them and the two ends, at about equal distances.
void thin(std::vector<LinePoint>& vertices) {
  const std::int64_t span = vertices.back().x - vertices.front().x;
  const std::int64_t gap = span / static_cast<std::int64_t>(LowerHull::kMaxVertices / 2);
  std::size_t kept = 1;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    if (vertices[i].x - vertices[kept - 1].x > gap) vertices[kept++] = vertices[i];
  }
  vertices[kept++] = vertices.back();
  vertices.resize(kept);
}

// Drops the vertices that a point to the right of all takes the place of.
void make_way(std::vector<LinePoint>& hull, LinePoint point) {
  std::size_t size = hull.size();
  while (size >= 2 && !is_vertex(hull[size - 2], hull[size - 1], point)) --size;
  hull.resize(size);
}

void append(std::vector<LinePoint>& hull, LinePoint point) {
  make_way(hull, point);
  hull.push_back(point);
}

}  // namespace

void LowerHull::add(LinePoint point) {
  SIMBENCH_ASSERT(vertices_.empty() || point.x > vertices_.back().x,
                  "points of a hull come in order");
  make_way(vertices_, point);
  if (vertices_.size() == kMaxVertices) thin(vertices_);
  vertices_.push_back(point);
}

SupportLine support_line(std::span<const LinePoint> vertices, std::int64_t twice_x,
                         double max_slope) {
  SIMBENCH_ASSERT(!vertices.empty(), "a hull without points has no lines");
  if (vertices.size() == 1) return {.touches = vertices.front(), .slope = 0};
  const auto end = std::lower_bound(
      vertices.begin() + 1, vertices.end() - 1, twice_x,
      [](const LinePoint& vertex, std::int64_t sum) { return 2 * vertex.x < sum; });
  auto right = static_cast<std::size_t>(end - vertices.begin());
  double slope = slope_between(vertices[right - 1], vertices[right]);
  if (slope > max_slope) {
    while (right > 1 && slope_between(vertices[right - 2], vertices[right - 1]) > max_slope) {
      --right;
    }
    return {.touches = vertices[right - 1], .slope = max_slope};
  }
  if (slope < -max_slope) {
    while (right + 1 < vertices.size() &&
           slope_between(vertices[right], vertices[right + 1]) < -max_slope) {
      ++right;
    }
    return {.touches = vertices[right], .slope = -max_slope};
  }
  return {.touches = vertices[right - 1], .slope = slope};
}

WindowHull::WindowHull(std::size_t capacity) : capacity_(capacity), older_hull_(capacity) {
  SIMBENCH_ASSERT(capacity > 0, "a window holds a point");
  older_.reserve(capacity);
  newer_.reserve(capacity);
}

void WindowHull::push(LinePoint point) {
  SIMBENCH_ASSERT(!full(), "remove the oldest point first");
  newer_.push_back(point);
  append(newer_hull_, point);
}

void WindowHull::pop() {
  SIMBENCH_ASSERT(!empty(), "no point to remove");
  if (older_.empty()) rebuild_older();
  const Older& oldest = older_.back();
  older_hull_[older_vertices_ - 1] = oldest.displaced;
  older_vertices_ = oldest.vertices_before;
  older_.pop_back();
}

void WindowHull::clear() {
  older_.clear();
  older_vertices_ = 0;
  newer_.clear();
  newer_hull_.clear();
}

void WindowHull::rebuild_older() {
  older_vertices_ = 0;
  for (std::size_t i = newer_.size(); i-- > 0;) {
    const LinePoint point = newer_[i];
    std::size_t place = older_vertices_;
    while (place >= 2 && !is_vertex(point, older_hull_[place - 1], older_hull_[place - 2])) --place;
    older_.push_back({point, older_vertices_, older_hull_[place]});
    older_hull_[place] = point;
    older_vertices_ = place + 1;
  }
  newer_.clear();
  newer_hull_.clear();
}

std::span<const LinePoint> WindowHull::hull() {
  if (older_.empty()) return newer_hull_;
  joined_.clear();
  for (std::size_t i = older_vertices_; i-- > 0;) joined_.push_back(older_hull_[i]);
  for (const LinePoint& point : newer_hull_) append(joined_, point);
  return joined_;
}

}  // namespace simbench

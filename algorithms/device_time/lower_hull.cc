#include "algorithms/device_time/lower_hull.h"

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// Leaves at most half of them and the two ends, none much closer together than another.
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

double slope_between(LinePoint a, LinePoint b) {
  return static_cast<double>(b.y - a.y) / static_cast<double>(b.x - a.x);
}

}  // namespace

void LowerHull::add(LinePoint point) {
  SIMBENCH_ASSERT(vertices_.empty() || point.x > vertices_.back().x,
                  "points of a hull come in order");
  std::size_t size = vertices_.size();
  while (size >= 2 && !is_vertex(vertices_[size - 2], vertices_[size - 1], point)) --size;
  vertices_.resize(size);
  if (size == kMaxVertices) thin(vertices_);
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

}  // namespace simbench

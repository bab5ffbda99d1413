// Lower convex hulls of growing sets of points, and lines that lie under all of them.
//
// Delays are one-sided: an arrival is never early. The line of a clock therefore lies under all
// points (sensor stamp, offset) and touches some of them; the edge of the lower hull over the
// middle of the data is the highest such line there. Moon's linear programme and Zhang's hull give
// the same line. Four hulls differ in what they forget:
//
//   LowerHull      nothing, but for thinning at kMaxVertices
//   WindowHull     the oldest point, when told to
//   SwitchingHull  what is older than one to two periods
//   Envelope       what is older than a window, to within an eighth; points in double precision
//
// LowerHull: points come with strictly increasing x; |x| and |y| up to 2^61. Arithmetic is exact.
// Only vertices are kept, not points on an edge: about 2 ln n of n random points. Convex data would
// keep every point, so at kMaxVertices those closer together than 1/2048 of the span are thinned
// out, which lifts the hull by no more than a chord of that length does.
//
// Complexity: add amortised O(1), support_line O(log vertices).
// Source: Zhang, Liu, Xia 2002; docs/reference/device_time.md section 1. The midpoint is taken anew
// for each line, also of two points (the reference implementation keeps a stale one there).
//
//   LowerHull hull;
//   hull.add({.x = 0, .y = 3}); hull.add({.x = 2, .y = 9}); hull.add({.x = 4, .y = 5});
//   support_line(hull.vertices(), hull.vertices().front().x + hull.vertices().back().x).at(4);
//   // 5
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "laws/line_fit.h"

namespace simbench {

class LowerHull {
 public:
  static constexpr std::size_t kMaxVertices = 4096;

  void add(LinePoint point);
  void clear() { vertices_.clear(); }
  std::span<const LinePoint> vertices() const { return vertices_; }

 private:
  std::vector<LinePoint> vertices_;  // x increases, and so do the slopes between them
};

// Whether b lies strictly below the line from a to c, for a.x < b.x < c.x: a vertex between them.
inline bool is_vertex(const LinePoint& a, const LinePoint& b, const LinePoint& c) {
  return Int128{c.y - a.y} * (b.x - a.x) > Int128{b.y - a.y} * (c.x - a.x);
}

// A line that supports a hull at a point.
template <class Point>
struct HullLine {
  Point touches;
  double slope = 0;
  double at(decltype(Point::x) x) const {
    return static_cast<double>(touches.y) + slope * static_cast<double>(x - touches.x);
  }
};
using SupportLine = HullLine<LinePoint>;

// The edge of the hull over x = twice_x / 2, the earlier one at a vertex (of a single vertex the
// level line). If it is steeper than max_slope, the line of that slope that touches the hull from
// below. `vertices`, a span of points, is not empty.
template <class Vertices, class Point = typename Vertices::value_type>
HullLine<Point> support_line(const Vertices& vertices, decltype(Point::x) twice_x,
                             double max_slope = std::numeric_limits<double>::infinity()) {
  SIMBENCH_ASSERT(!vertices.empty(), "a hull without points has no lines");
  if (vertices.size() == 1) return {.touches = vertices.front(), .slope = 0};
  const auto end =
      std::lower_bound(vertices.begin() + 1, vertices.end() - 1, twice_x,
                       [](const Point& vertex, auto sum) { return 2 * vertex.x < sum; });
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

// The same over the middle of the hull.
template <class Vertices>
auto middle_line(const Vertices& vertices,
                 double max_slope = std::numeric_limits<double>::infinity()) {
  return support_line(vertices, vertices.front().x + vertices.back().x, max_slope);
}

// The lower convex hull of the newest points: a queue of points with its hull at any time.
//
// The queue is two parts. The newer part has a growing hull. The older part was built from its
// newest point back to its oldest, and each point remembers what it displaced, so taking the oldest
// one out restores the hull without it. When the older part is used up, the newer one becomes it.
// The hull of all is the two joined at their common tangent.
//
// Complexity: push and pop amortised O(1) (a rebuild of n points once in n pops), hull() O(number
// of vertices). Memory: up to 3 * capacity points, as they come. Points and arithmetic as in
// LowerHull, but no vertex is thinned out.
//
//   WindowHull window(300);
//   if (window.full()) window.pop();
//   window.push(point);
//   middle_line(window.hull());
class WindowHull {
 public:
  // Room for `capacity` points, at least 1.
  explicit WindowHull(std::size_t capacity);

  // x must be greater than that of all points within; not if full().
  void push(LinePoint point);
  // Removes the oldest point; not if empty().
  void pop();
  void clear();

  std::size_t size() const { return older_.size() + newer_.size(); }
  bool empty() const { return size() == 0; }
  bool full() const { return size() == capacity_; }
  LinePoint oldest() const { return older_.empty() ? newer_.front() : older_.back().point; }

  // Valid until the next change.
  std::span<const LinePoint> hull();

 private:
  struct Older {
    LinePoint point;
    std::size_t vertices_before = 0;
    LinePoint displaced;  // the vertex whose place this point took
  };

  void rebuild_older();

  std::size_t capacity_;
  std::vector<Older> older_;           // newest first, so the oldest is at the end
  std::vector<LinePoint> older_hull_;  // newest first; the first older_vertices_ are valid
  std::size_t older_vertices_ = 0;
  std::vector<LinePoint> newer_;
  std::vector<LinePoint> newer_hull_;
  std::vector<LinePoint> joined_;
};

// Two growing lower hulls fed in parallel, so that old points leave (TICSync; the switching hull of
// cuckoo_time_translator): once the pending one is `period` old, the next point makes it the
// current one and begins a new pending one. The current hull then spans one to two periods.
//
// Complexity and memory: two of LowerHull.
//
//   SwitchingHull hull(10'000'000);   // period in units of x
//   hull.add(point);
//   middle_line(hull.current());
class SwitchingHull {
 public:
  explicit SwitchingHull(std::int64_t period) : period_(period) {}

  // As LowerHull::add.
  void add(LinePoint point) {
    if (pending_.vertices().empty()) {
      pending_since_ = point.x;
    } else if (point.x - pending_since_ >= period_) {
      std::swap(current_, pending_);
      pending_.clear();
      pending_since_ = point.x;
    }
    current_.add(point);
    pending_.add(point);
  }
  void clear() {
    current_.clear();
    pending_.clear();
  }

  std::span<const LinePoint> current() const { return current_.vertices(); }
  std::span<const LinePoint> pending() const { return pending_.vertices(); }

 private:
  std::int64_t period_;
  std::int64_t pending_since_ = 0;
  LowerHull current_;
  LowerHull pending_;
};

// The lower convex envelope of the newest points of a stream, in bounded memory.
//
// A delay can only make a stamp later, so the points (time, stamp difference) of a stream lie above
// their line without delay; the edges of their lower convex hull touch that line from above. For an
// upper envelope negate y.
//
// The points of the last `window` are kept, to within one part of kParts: each part of the window
// has a hull of its own, and the oldest part is dropped as a whole. A part with kPartVertices hull
// vertices ends early, so memory is at most (kParts + 1) * kPartVertices points.
//
// Contract: x does not decrease (a smaller x counts as the last one); units are the caller's.
// Complexity: add() amortised O(1); the first query after an add O(vertices), usually some tens.
// Source: docs/reference/host_sync.md section 1 (two-way convex hull).
//
//   Envelope envelope(60e9);
//   envelope.add(x, y);
//   Envelope::Point touched = envelope.touch(slope);  // the vertex that the line rests on
class Envelope {
 public:
  struct Point {
    double x = 0;
    double y = 0;
  };
  static constexpr int kParts = 8;
  static constexpr std::size_t kPartVertices = 64;

  explicit Envelope(double window) : part_length_(window / kParts) {}

  void add(double x, double y);
  void clear();
  bool empty() const { return parts_.empty(); }
  // From the first kept point to the last.
  double span() const;

  // The vertices, in order of x, with strictly growing slopes between them.
  const std::vector<Point>& vertices() const;
  // The vertex with the smallest y - slope * x. Not for an empty envelope.
  Point touch(double slope) const;
  // The envelope at x; nothing outside of its points.
  std::optional<double> at(double x) const;

 private:
  struct Part {
    double begin = 0;
    std::vector<Point> hull;
  };

  double part_length_;
  std::deque<Part> parts_;
  mutable std::vector<Point> vertices_;
  mutable bool is_current_ = false;
};

// As of points with whole numbers, in double precision.
inline bool is_vertex(const Envelope::Point& a, const Envelope::Point& b,
                      const Envelope::Point& c) {
  return (c.y - a.y) * (b.x - a.x) > (b.y - a.y) * (c.x - a.x);
}

}  // namespace simbench

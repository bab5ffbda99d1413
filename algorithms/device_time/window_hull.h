// The lower convex hull of the newest points: a queue of points with its hull at any time.
//
// The queue is two parts. The newer part has a growing hull. The older part was built from its
// newest point back to its oldest, and each point remembers what it displaced, so taking the oldest
// one out restores the hull without it. When the older part is used up, the newer one becomes it.
// The hull of all is the two joined at their common tangent.
//
// Complexity: push and pop amortised O(1) (a rebuild of n points once in n pops), hull() O(number
// of vertices). Memory: 3 * capacity points, allocated when made. Points and arithmetic as in
// lower_hull.h, except that no vertex is ever dropped.
//
//   WindowHull window(300);
//   if (window.full()) window.pop();
//   window.push(point);
//   middle_line(window.hull());
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_WINDOW_HULL_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_WINDOW_HULL_H_

#include <cstddef>
#include <span>
#include <vector>

#include "algorithms/device_time/line_fit.h"

namespace simbench {

class WindowHull {
 public:
  // Room for `capacity` points, at least 1.
  explicit WindowHull(std::size_t capacity);

  // x greater than that of all points within; not if full().
  void push(LinePoint point);
  // Takes the oldest point out; not if empty().
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

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_WINDOW_HULL_H_

// Least-squares lines from exact running sums, over all points or over a sliding window.
//
// Textbook sums lose the slope of a clock within hours: in double precision, n*Sxx - Sx^2 cancels
// once x is large against the window. Here x and y are integers and the sums are exact in 128 bits,
// so nothing accumulates, adding and removing a point leaves no trace, and doubles appear only in
// the last division. Where x is counted from (a fixed anchor, say the first frame) does not matter.
//
// Exact while |x| and |y| stay below 2^61 / capacity; larger values count as that. With x in
// microseconds and a capacity of 30 that is 2400 years, with 3.2 million (10 h at 90 Hz) 8 days.
//
// Complexity: add, remove, line: O(1). Source: docs/reference/paper.md section 3.
//
//   LineSums sums(1000);
//   sums.add({.x = 0, .y = 5});
//   sums.add({.x = 10, .y = 7});
//   sums.line().at(20);   // 9
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_LINE_FIT_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_LINE_FIT_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithms/device_time/saturate.h"
#include "algorithms/ports/assert.h"

namespace simbench {

struct LinePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

// Of points with different x.
inline double slope_between(LinePoint a, LinePoint b) {
  return static_cast<double>(b.y - a.y) / static_cast<double>(b.x - a.x);
}

// The fitted line. With fewer than two points, or all at one x, its slope is 0: the mean of y.
struct Line {
  double slope = 0;
  std::int64_t count = 0;
  std::int64_t sum_x = 0;
  std::int64_t sum_y = 0;
  // The line's value at x (0 with no points); never a NaN.
  double at(std::int64_t x) const {
    if (count == 0) return 0;
    const Int128 lever = Int128{count} * x - sum_x;
    return (static_cast<double>(sum_y) + slope * to_double(lever)) / static_cast<double>(count);
  }
};

class LineSums {
 public:
  // At most `capacity` points (at least 1) will be in the sums at a time. The reach keeps every sum
  // of x or y below 2^61, and so each product in line() within 2^123.
  explicit LineSums(std::size_t capacity)
      : reach_((std::int64_t{1} << 61) / static_cast<std::int64_t>(capacity)) {
    SIMBENCH_ASSERT(reach_ > 0, "a line needs room for one point, and no more than 2^61");
  }

  void add(LinePoint point) {
    point = within_reach(point);
    ++count_;
    sum_x_ += point.x;
    sum_y_ += point.y;
    sum_xx_ += Int128{point.x} * point.x;
    sum_xy_ += Int128{point.x} * point.y;
  }
  // Takes out a point that was added.
  void remove(LinePoint point) {
    point = within_reach(point);
    --count_;
    sum_x_ -= point.x;
    sum_y_ -= point.y;
    sum_xx_ -= Int128{point.x} * point.x;
    sum_xy_ -= Int128{point.x} * point.y;
  }
  Line line() const {
    const Int128 spread = count_ * sum_xx_ - Int128{sum_x_} * sum_x_;
    const Int128 common = count_ * sum_xy_ - Int128{sum_x_} * sum_y_;
    const double slope = spread == 0 ? 0.0 : to_double(common) / to_double(spread);
    return {.slope = slope, .count = count_, .sum_x = sum_x_, .sum_y = sum_y_};
  }

 private:
  LinePoint within_reach(LinePoint point) const {
    return {std::clamp(point.x, -reach_, reach_), std::clamp(point.y, -reach_, reach_)};
  }

  std::int64_t reach_;
  std::int64_t count_ = 0;
  std::int64_t sum_x_ = 0;
  std::int64_t sum_y_ = 0;
  Int128 sum_xx_ = 0;
  Int128 sum_xy_ = 0;
};

// The line through the last `size` points. Allocates once, when made.
class LineWindow {
 public:
  explicit LineWindow(std::size_t size) : sums_(size), points_(size) {}

  void push(LinePoint point) {
    if (full_) sums_.remove(points_[next_]);
    sums_.add(point);
    points_[next_] = point;
    if (++next_ == points_.size()) {
      next_ = 0;
      full_ = true;
    }
  }
  Line line() const { return sums_.line(); }

 private:
  LineSums sums_;
  std::vector<LinePoint> points_;  // a ring; the oldest is at next_ once it is full
  std::size_t next_ = 0;
  bool full_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_LINE_FIT_H_

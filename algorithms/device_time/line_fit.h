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
// Complexity: each O(1). Source: docs/reference/paper.md section 3.
//
//   LineSums sums(1000);
//   sums.add({.x = 0, .y = 5});
//   sums.add({.x = 10, .y = 7});
//   sums.line().at(20);   // 9
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_LINE_FIT_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_LINE_FIT_H_

#include <algorithm>
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

// What the line through n points depends on.
struct LineMoments {
  std::int64_t count = 0;
  std::int64_t sum_x = 0;
  std::int64_t sum_y = 0;
  Int128 spread = 0;  // n * sum of x^2 - (sum of x)^2
  Int128 common = 0;  // n * sum of xy - (sum of x)(sum of y)

  // Exchanges one of the points: n x - sum of x is below 2^62, as n |x| is within 2^61.
  void replace(LinePoint old, LinePoint by) {
    const std::int64_t dx = by.x - old.x;
    const std::int64_t dy = by.y - old.y;
    const std::int64_t lever_before = count * old.x - sum_x;
    const std::int64_t height_before = count * old.y - sum_y;
    sum_x += dx;
    sum_y += dy;
    const std::int64_t lever = count * by.x - sum_x;
    spread += Int128{dx} * (lever_before + lever);
    common += Int128{dx} * height_before + Int128{dy} * lever;
  }

  Line line() const {
    const double slope = spread == 0 ? 0.0 : to_double(common) / to_double(spread);
    return {.slope = slope, .count = count, .sum_x = sum_x, .sum_y = sum_y};
  }
};

class LineSums {
 public:
  // At most `capacity` points (at least 1) will be in the sums. The reach keeps every sum of x or y
  // below 2^61, and so each product in moments() within 2^123.
  explicit LineSums(std::size_t capacity)
      : reach_((std::int64_t{1} << 61) / static_cast<std::int64_t>(capacity)) {
    SIMBENCH_ASSERT(reach_ > 0, "a line needs room for one point, and no more than 2^61");
  }

  LinePoint within_reach(LinePoint point) const {
    const auto is_within = [this](std::int64_t v) { return v >= -reach_ && v <= reach_; };
    if (is_within(point.x) && is_within(point.y)) return point;
    return {std::clamp(point.x, -reach_, reach_), std::clamp(point.y, -reach_, reach_)};
  }

  void add(LinePoint point) {
    point = within_reach(point);
    ++count_;
    sum_x_ += point.x;
    sum_y_ += point.y;
    sum_xx_ += Int128{point.x} * point.x;
    sum_xy_ += Int128{point.x} * point.y;
  }
  LineMoments moments() const {
    return {.count = count_,
            .sum_x = sum_x_,
            .sum_y = sum_y_,
            .spread = count_ * sum_xx_ - Int128{sum_x_} * sum_x_,
            .common = count_ * sum_xy_ - Int128{sum_x_} * sum_y_};
  }
  Line line() const { return moments().line(); }

 private:
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
  explicit LineWindow(std::size_t size) : points_(size), sums_(size) {}

  void push(LinePoint point) {
    point = sums_.within_reach(point);
    if (!full_) return grow(point);
    LinePoint& oldest = points_[static_cast<std::size_t>(next_)];
    moments_.replace(oldest, point);
    oldest = point;
    if (++next_ == moments_.count) next_ = 0;
  }
  Line line() const { return moments_.line(); }

 private:
  [[gnu::noinline]] void grow(LinePoint point) {
    sums_.add(point);
    moments_ = sums_.moments();
    const auto count = static_cast<std::size_t>(moments_.count);
    points_[count - 1] = point;
    full_ = count == points_.size();
  }

  LineMoments moments_;
  std::vector<LinePoint> points_;  // a ring; the oldest is at next_ once it is full
  std::int64_t next_ = 0;
  bool full_ = false;
  LineSums sums_;  // until it is full
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_LINE_FIT_H_

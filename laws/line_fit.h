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
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithms/ports/assert.h"
#include "laws/saturate.h"

namespace simbench {

struct LinePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

// The slope from one point to another, whose x differ.
template <class Point>
double slope_between(const Point& a, const Point& b) {
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
    const double height = static_cast<double>(sum_y) + slope * lever(x);
    return height / static_cast<double>(count);
  }
  // count * x - sum_x
  double lever(std::int64_t x) const {
    std::int64_t near = 0;
    if (!__builtin_mul_overflow(count, x, &near) && !__builtin_sub_overflow(near, sum_x, &near)) {
      return static_cast<double>(near);
    }
    return far_to_double(Int128{count} * x - sum_x);
  }
};

class LineSums {
 public:
  // At most `capacity` points (at least 1) will be in the sums. The reach keeps every sum of x or y
  // below 2^61, and so each product in spread() and common() within 2^123.
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
  void clear() {
    count_ = sum_x_ = sum_y_ = 0;
    sum_xx_ = sum_xy_ = 0;
  }

  // n * sum of x^2 - (sum of x)^2, and n * sum of xy - (sum of x)(sum of y).
  Int128 spread() const { return count_ * sum_xx_ - Int128{sum_x_} * sum_x_; }
  Int128 common() const { return count_ * sum_xy_ - Int128{sum_x_} * sum_y_; }
  std::int64_t sum_x() const { return sum_x_; }
  std::int64_t sum_y() const { return sum_y_; }

  Line line() const {
    const Int128 over = spread();
    const double slope = over == 0 ? 0.0 : to_double(common()) / to_double(over);
    return {.slope = slope, .count = count_, .sum_x = sum_x_, .sum_y = sum_y_};
  }

 private:
  std::int64_t reach_;
  std::int64_t count_ = 0;
  std::int64_t sum_x_ = 0;
  std::int64_t sum_y_ = 0;
  Int128 sum_xx_ = 0;
  Int128 sum_xy_ = 0;
};

// The line through the last `size` points. Allocates once, when made.
//
// A full window exchanges a point: its spread and common (see LineSums) do not depend on where x
// and y are counted from, so for points within seconds of each other they fit 64 bits. Where they
// do not, the sums are made anew, O(size).
class LineWindow {
 public:
  explicit LineWindow(std::size_t size) : points_(size), sums_(size) {}

  void push(LinePoint point) {
    point = sums_.within_reach(point);
    if (!is_near_ || !exchange(point)) push_any(point);
  }

  Line line() const {
    if (!is_near_) return sums_.line();
    const double slope =
        spread_ == 0 ? 0.0 : static_cast<double>(common_) / static_cast<double>(spread_);
    return {.slope = slope, .count = count_, .sum_x = sum_x_, .sum_y = sum_y_};
  }

 private:
  // False, and no change, if a number does not fit. n x - sum of x is below 2^62.
  bool exchange(LinePoint point) {
    const LinePoint oldest = points_[static_cast<std::size_t>(next_)];
    const std::int64_t dx = point.x - oldest.x;
    const std::int64_t dy = point.y - oldest.y;
    const std::int64_t lever = count_ * point.x - (sum_x_ + dx);
    const std::int64_t levers = count_ * oldest.x - sum_x_ + lever;
    const std::int64_t height = count_ * oldest.y - sum_y_;
    std::int64_t spread = 0;
    std::int64_t by_x = 0;
    std::int64_t by_y = 0;
    if (__builtin_mul_overflow(dx, levers, &spread) ||
        __builtin_add_overflow(spread_, spread, &spread) ||
        __builtin_mul_overflow(dx, height, &by_x) || __builtin_mul_overflow(dy, lever, &by_y) ||
        __builtin_add_overflow(common_, by_x, &by_x) || __builtin_add_overflow(by_x, by_y, &by_x)) {
      return false;
    }
    spread_ = spread;
    common_ = by_x;
    sum_x_ += dx;
    sum_y_ += dy;
    replace_oldest(point);
    return true;
  }

  [[gnu::noinline]] void push_any(LinePoint point) {
    const auto size = static_cast<std::int64_t>(points_.size());
    if (count_ < size) {
      points_[static_cast<std::size_t>(count_++)] = point;
      sums_.add(point);
      if (count_ < size) return;
    } else {
      replace_oldest(point);
      sums_.clear();
      for (const LinePoint& each : points_) sums_.add(each);
    }
    spread_ = static_cast<std::int64_t>(sums_.spread());
    common_ = static_cast<std::int64_t>(sums_.common());
    sum_x_ = sums_.sum_x();
    sum_y_ = sums_.sum_y();
    is_near_ = spread_ == sums_.spread() && common_ == sums_.common();
  }

  void replace_oldest(LinePoint point) {
    points_[static_cast<std::size_t>(next_)] = point;
    if (++next_ == count_) next_ = 0;
  }

  std::int64_t count_ = 0;
  std::int64_t sum_x_ = 0;
  std::int64_t sum_y_ = 0;
  std::int64_t spread_ = 0;
  std::int64_t common_ = 0;
  std::int64_t next_ = 0;
  bool is_near_ = false;           // full, and the five numbers are the sums'
  std::vector<LinePoint> points_;  // a ring; the oldest is at next_ once it is full
  LineSums sums_;                  // of the points, while they are not near
};

}  // namespace simbench

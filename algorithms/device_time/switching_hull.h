// Two lower hulls fed in parallel, so that a growing hull forgets (TICSync; the switching hull of
// cuckoo_time_translator): once the pending one is `period` old, the next point makes it the
// current one and begins a new pending one. The current hull then spans one to two periods.
//
// Complexity and memory: two of LowerHull.
//
//   SwitchingHull hull(10'000'000);   // period in units of x
//   hull.add(point);
//   middle_line(hull.current());
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_SWITCHING_HULL_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_SWITCHING_HULL_H_

#include <cstdint>
#include <span>
#include <utility>

#include "algorithms/device_time/lower_hull.h"

namespace simbench {

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

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_SWITCHING_HULL_H_

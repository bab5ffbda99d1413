#include "algorithms/device_time/line_fit.h"

#include "algorithms/ports/assert.h"

namespace simbench {

// The reach keeps every sum of x or y below 2^61, and so each product below within 2^123.
LineSums::LineSums(std::size_t capacity)
    : reach_((std::int64_t{1} << 61) / static_cast<std::int64_t>(capacity)) {
  SIMBENCH_ASSERT(reach_ > 0, "a line needs room for one point, and no more than 2^61");
}

Line LineSums::line() const {
  const Int128 spread = count_ * sum_xx_ - Int128{sum_x_} * sum_x_;
  const Int128 common = count_ * sum_xy_ - Int128{sum_x_} * sum_y_;
  const double slope = spread == 0 ? 0.0 : to_double(common) / to_double(spread);
  return {.slope = slope, .count = count_, .sum_x = sum_x_, .sum_y = sum_y_};
}

}  // namespace simbench

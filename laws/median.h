// The median of values that may be reordered.
//
//   std::vector<double> values = ...;
//   double middle = median_in_place(values);
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "algorithms/ports/assert.h"

namespace simbench {

// The mean of the middle two if the number of values is even; at least one value. O(n).
inline double median_in_place(std::span<double> values) {
  SIMBENCH_ASSERT(!values.empty(), "a median needs a value");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

}  // namespace simbench

// The standard normal law: its density and its distribution function.
//
//   normal_probability(0);  // 0.5: half of all values are below the mean
//   normal_density(0);      // 0.3989
#pragma once

#include <cmath>
#include <numbers>

namespace simbench {

inline double normal_density(double z) {
  return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
}

// The probability that a standard normal value is below z.
inline double normal_probability(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

}  // namespace simbench

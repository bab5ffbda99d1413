// Integer arithmetic on stamps that cannot overflow: 128 bits within, 64 for the results.
//
// Stamps of a real recording may be anything, and the difference of two need not fit 64 bits. A
// result beyond the range becomes the end of the range. Nearly all results fit 64 bits: the way of
// the others is out of line, which leaves the registers to the common one.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace simbench {

// Not `using`: only a typedef can have the mark that silences -Wpedantic.
__extension__ typedef __int128 Int128;  // NOLINT(modernize-use-using)

inline std::int64_t saturate(Int128 value) {
  constexpr Int128 kLow = std::numeric_limits<std::int64_t>::min();
  constexpr Int128 kHigh = std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(std::clamp(value, kLow, kHigh));
}

[[gnu::cold, gnu::noinline]] inline double far_to_double(Int128 value) {
  return static_cast<double>(value);
}

// The nearest double.
inline double to_double(Int128 value) {
  const auto low = static_cast<std::int64_t>(value);
  return low == value ? static_cast<double>(low) : far_to_double(value);
}

[[gnu::cold, gnu::noinline]] inline std::int64_t saturate_far_round(double value) {
  return std::llrint(std::clamp(value, -0x1p62, 0x1p62));
}

// The nearest integer, the even one of two, within +-2^62. The value is not a NaN.
inline std::int64_t saturate_round(double value) {
  // Where doubles are one apart, so that a sum is rounded to whole numbers; without a call.
  constexpr double kWhole = 0x1.8p52;
  if (std::abs(value) < 0x1p51) {
    return std::bit_cast<std::int64_t>(value + kWhole) - std::bit_cast<std::int64_t>(kWhole);
  }
  return saturate_far_round(value);
}

}  // namespace simbench

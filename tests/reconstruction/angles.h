// Angles as the tests of reconstruction/ state them.
#pragma once

#include <numbers>

namespace simbench::reconstruction {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;

}  // namespace simbench::reconstruction

// Angles as the tests of reconstruction/ state them.
#ifndef SIMBENCH_TESTS_RECONSTRUCTION_ANGLES_H_
#define SIMBENCH_TESTS_RECONSTRUCTION_ANGLES_H_

#include <numbers>

namespace simbench::reconstruction {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180;

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_TESTS_RECONSTRUCTION_ANGLES_H_

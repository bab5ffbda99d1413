// Errors as colours: from dark blue (none) through green to yellow (kPaintedUpTo and more), grey
// where there is no error to show. The scale is legible without seeing red from green, and in
// print.
//
//   mesh.colours = error_colours(by_vertex);
#ifndef SIMBENCH_RECONSTRUCTION_PAINT_H_
#define SIMBENCH_RECONSTRUCTION_PAINT_H_

#include <Eigen/Core>
#include <vector>

#include "reconstruction/reprojection.h"

namespace simbench::reconstruction {

inline constexpr double kPaintedUpTo = 0.10;  // m

// Red, green, blue in [0, 1]. NaN: grey.
Eigen::Vector3f error_colour(double error_m);

// One for each vertex: of its mean error.
std::vector<Eigen::Vector3f> error_colours(const VertexErrors& errors);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_PAINT_H_

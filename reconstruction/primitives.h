// Closed meshes of simple solids about the origin of their own frame, finely tessellated.
//
// Triangles face outwards, vertices lie on the smooth surface; `largest_error_m` bounds the
// distance between the mesh and that surface. Lengths are in metres and must be more than 0 (a
// capsule's length may be 0); std::invalid_argument if one is not.
//
//   const TriangleMesh head = make_ellipsoid({0.10, 0.08, 0.12}, /*largest_error_m=*/0.001);
#pragma once

#include <Eigen/Core>

#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

TriangleMesh make_sphere(double radius_m, double largest_error_m);
TriangleMesh make_ellipsoid(const Eigen::Vector3d& semi_axes_m, double largest_error_m);
// The hull of a sphere about the origin and one about (0, 0, -length_m): a limb that hangs down.
// If one sphere is inside the other, the other sphere alone.
TriangleMesh make_tapered_capsule(double radius_m, double end_radius_m, double length_m,
                                  double largest_error_m);

}  // namespace simbench::reconstruction

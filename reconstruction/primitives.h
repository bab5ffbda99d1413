// Closed meshes of simple solids about the origin of their own frame, finely tessellated.
//
// Triangles face outwards. `largest_error_m` is the largest distance between the mesh and the
// smooth surface.
#ifndef SIMBENCH_RECONSTRUCTION_PRIMITIVES_H_
#define SIMBENCH_RECONSTRUCTION_PRIMITIVES_H_

#include <Eigen/Core>

#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

TriangleMesh make_sphere(double radius_m, double largest_error_m);
TriangleMesh make_ellipsoid(const Eigen::Vector3d& semi_axes_m, double largest_error_m);
// The hull of a sphere about the origin and one about (0, 0, -length_m): a limb that hangs down.
TriangleMesh make_tapered_capsule(double radius_m, double end_radius_m, double length_m,
                                  double largest_error_m);
TriangleMesh make_box(const Eigen::Vector3d& sizes_m);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_PRIMITIVES_H_

// The simplest closed mesh that tests can know all about.
#pragma once

#include <Eigen/Core>

#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

// About the origin; its triangles face outwards.
inline TriangleMesh make_box(const Eigen::Vector3d& sizes_m) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {  // bits: x, y, z
    const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                               corner & 4 ? 0.5 : -0.5);
    mesh.vertices.emplace_back(sign.cwiseProduct(sizes_m).cast<float>());
  }
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : faces) {
    mesh.triangles.emplace_back(face[0], face[1], face[2]);
    mesh.triangles.emplace_back(face[0], face[2], face[3]);
  }
  return mesh;
}

}  // namespace simbench::reconstruction

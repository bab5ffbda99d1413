// A surface of triangles, as plain data.
//
// Units: metres. A triangle is three indices into `vertices`; seen from outside its corners run
// counter-clockwise. `colours` is empty, or one for each vertex, red, green, blue in [0, 1].
#pragma once

#include <Eigen/Core>
#include <vector>

namespace simbench::reconstruction {

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Eigen::Vector3f> colours{};
};

}  // namespace simbench::reconstruction

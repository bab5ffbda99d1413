#include "reconstruction/reprojection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench::reconstruction {

double VertexErrors::mean_m(std::size_t vertex) const {
  if (matches[vertex] == 0) return std::numeric_limits<double>::quiet_NaN();
  return sum_m[vertex] / matches[vertex];
}

DepthMap spread_to_neighbours(const DepthMap& zbuffer) {
  DepthMap spread(zbuffer.width, zbuffer.height);
  for (int row = 0; row < zbuffer.height; ++row) {
    for (int column = 0; column < zbuffer.width; ++column) {
      const float depth = zbuffer.at(column, row);
      if (depth <= 0) continue;
      for (int y = std::max(0, row - 1); y <= std::min(zbuffer.height - 1, row + 1); ++y) {
        for (int x = std::max(0, column - 1); x <= std::min(zbuffer.width - 1, column + 1); ++x) {
          float& nearest = spread.depth_m[spread.index(x, y)];
          if (nearest <= 0 || depth < nearest) nearest = depth;
        }
      }
    }
  }
  return spread;
}

void add_reprojection_errors(const TriangleMesh& mesh, const DepthMap& zbuffer,
                             const DepthMap& measured, const StudioCamera& camera,
                             double tolerance_m, ErrorStatistics& errors, VertexErrors& by_vertex) {
  SIMBENCH_ASSERT(zbuffer.width == measured.width && zbuffer.height == measured.height,
                  "images of one camera");
  SIMBENCH_ASSERT(by_vertex.matches.size() == mesh.vertices.size(), "one for each vertex");
  const DepthMap nearest = spread_to_neighbours(zbuffer);
  const Eigen::Isometry3d camera_from_world = camera.believed.inverse();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d vertex = camera_from_world * mesh.vertices[v].cast<double>();
    if (vertex.z() <= 0) continue;
    const Eigen::Vector2d pixel = camera.intrinsics.pixel_of(vertex);
    const double column = std::round(pixel.x());
    const double row = std::round(pixel.y());
    if (!(column >= 0 && column < measured.width && row >= 0 && row < measured.height)) continue;
    const std::size_t at = measured.index(static_cast<int>(column), static_cast<int>(row));
    if (measured.depth_m[at] <= 0 || nearest.depth_m[at] <= 0) continue;
    if (vertex.z() > static_cast<double>(nearest.depth_m[at]) + tolerance_m) continue;
    const Eigen::Vector3d seen =
        camera.intrinsics.point_at({column, row}, static_cast<double>(measured.depth_m[at]));
    const double error = (vertex - seen).norm();
    errors.add(error);
    by_vertex.sum_m[v] += error;
    ++by_vertex.matches[v];
  }
}

}  // namespace simbench::reconstruction

#include "reconstruction/libraries/surface.h"

#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>

#include <memory>

#include "reconstruction/libraries/quiet_errors.h"

namespace simbench::reconstruction {

void add_points(const DepthMap& measured, const StudioCamera& camera, double spacing_m,
                OrientedPoints& points) {
  open3d::geometry::PointCloud cloud;
  for (int row = 0; row < measured.height; ++row) {
    for (int column = 0; column < measured.width; ++column) {
      const auto depth = static_cast<double>(measured.at(column, row));
      if (depth <= 0) continue;
      cloud.points_.push_back(camera.believed * camera.intrinsics.point_at({column, row}, depth));
    }
  }
  if (cloud.points_.empty()) return;
  const std::shared_ptr<open3d::geometry::PointCloud> thinned = cloud.VoxelDownSample(spacing_m);
  constexpr int kMostNeighbours = 40;
  thinned->EstimateNormals(
      open3d::geometry::KDTreeSearchParamHybrid(kNormalRadius, kMostNeighbours));
  thinned->OrientNormalsTowardsCameraLocation(camera.believed.translation());
  points.points.insert(points.points.end(), thinned->points_.begin(), thinned->points_.end());
  points.normals.insert(points.normals.end(), thinned->normals_.begin(), thinned->normals_.end());
}

TriangleMesh poisson_surface(const OrientedPoints& points) {
  TriangleMesh result;
  if (points.points.size() < kFewestPoints) return result;
  open3d::geometry::PointCloud cloud;
  cloud.points_ = points.points;
  cloud.normals_ = points.normals;
  constexpr float kScale = 1.1F;
  const QuietErrors::Scope quiet;
  const auto [mesh, densities] = open3d::geometry::TriangleMesh::CreateFromPointCloudPoisson(
      cloud, kPoissonDepth, /*width=*/0, kScale, /*linear_fit=*/false, /*n_threads=*/1);
  for (const Eigen::Vector3d& vertex : mesh->vertices_) {
    result.vertices.emplace_back(vertex.cast<float>());
  }
  result.triangles = mesh->triangles_;
  return result;
}

}  // namespace simbench::reconstruction

#include "reconstruction/libraries/picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algorithms/ports/assert.h"
#include "reconstruction/libraries/ray_caster.h"

namespace simbench::reconstruction {
namespace {

constexpr int kWidth = 400;
constexpr int kHeight = 640;
constexpr int kRaysPerSide = 2;  // of each pixel, against jagged outlines

// From the side, a little above the middle, upright.
Eigen::Isometry3d view_of(const Eigen::Vector3d& middle) {
  constexpr double kAbove = 0.5;  // m
  const Eigen::Vector3d from(std::cos(kPictureAzimuth) * kPictureDistance,
                             std::sin(kPictureAzimuth) * kPictureDistance, kAbove);
  const Eigen::Vector3d ahead = -from.normalized();
  const Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d view = Eigen::Isometry3d::Identity();
  view.linear() << right, ahead.cross(right), ahead;
  view.translation() = middle + from;
  return view;
}

Eigen::Vector3f colour_at(const TriangleMesh& mesh, const RayHit& hit) {
  const Eigen::Vector3i& corners = mesh.triangles[hit.triangle];
  const auto colour = [&](int corner) {
    return mesh.colours[static_cast<std::size_t>(corners[corner])];
  };
  return colour(0) * (1 - hit.u - hit.v) + colour(1) * hit.u + colour(2) * hit.v;
}

// Bright where the surface faces the viewer.
float shade_at(const TriangleMesh& mesh, const RayHit& hit, const Eigen::Vector3f& ray) {
  const Eigen::Vector3i& corners = mesh.triangles[hit.triangle];
  const auto vertex = [&](int corner) {
    return mesh.vertices[static_cast<std::size_t>(corners[corner])];
  };
  const Eigen::Vector3f normal = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
  const float facing = std::abs(normal.dot(ray)) / std::max(normal.norm() * ray.norm(), 1e-12F);
  constexpr float kDarkest = 0.35F;
  return kDarkest + (1 - kDarkest) * facing;
}

}  // namespace

Picture picture_of(const TriangleMesh& mesh) {
  SIMBENCH_ASSERT(mesh.colours.size() == mesh.vertices.size(), "a colour for each vertex");
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
  const Eigen::Isometry3d view =
      view_of(box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center()));
  const int columns = kWidth * kRaysPerSide;
  const int rows = kHeight * kRaysPerSide;
  constexpr double kSeenHeight = 2.3;  // m, at the middle
  const Pinhole camera = centred_pinhole(columns, rows, rows * kPictureDistance / kSeenHeight);
  std::vector<RayHit> hits;
  const DepthMap depth = RayCaster({mesh}).depth(camera, view, &hits);
  std::vector<Eigen::Vector3f> sums(static_cast<std::size_t>(kWidth) * kHeight,
                                    Eigen::Vector3f::Zero());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Eigen::Vector3f colour = Eigen::Vector3f::Ones();
      if (depth.at(column, row) > 0) {
        const RayHit& hit = hits[depth.index(column, row)];
        const Eigen::Vector3f ray =
            (view.linear() * camera.point_at({column, row}, 1.0)).cast<float>();
        colour = colour_at(mesh, hit) * shade_at(mesh, hit, ray);
      }
      sums[static_cast<std::size_t>(row / kRaysPerSide) * kWidth +
           static_cast<std::size_t>(column / kRaysPerSide)] += colour;
    }
  }
  Picture picture{kWidth, kHeight, {}};
  for (const Eigen::Vector3f& sum : sums) {
    for (int channel = 0; channel < 3; ++channel) {
      const float value = sum[channel] / (kRaysPerSide * kRaysPerSide);
      picture.rgb.push_back(
          static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F)));
    }
  }
  return picture;
}

}  // namespace simbench::reconstruction

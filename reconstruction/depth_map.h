// Depth images and the pinhole cameras that see them.
//
// A depth image has for each pixel the z of the surface seen there, in the camera's frame: row by
// row, in metres, 0 where nothing is seen (as in the D400 family).
//
// A pinhole camera converts points of its own frame to pixels, and back. It looks along +z, x to
// the right and y down in its image. Pixels are square; the centre of the pixel in column i and row
// j is at (i, j). There is no distortion: depth images of the D400 family are rectified.
//
//   const Pinhole camera = centred_pinhole(848, 480, 430.0);
//   const Eigen::Vector2d pixel = camera.pixel_of(point);          // point.z() > 0
//   const Eigen::Vector3d again = camera.point_at(pixel, point.z());
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace simbench::reconstruction {

struct DepthMap {
  DepthMap() = default;
  DepthMap(int columns, int rows)
      : width(columns),
        height(rows),
        depth_m(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0F) {}

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
  float at(int column, int row) const { return depth_m[index(column, row)]; }

  int width = 0;
  int height = 0;
  std::vector<float> depth_m;
};

// A ray caster's image: the true depth, and the cosine between the ray and the surface's normal, in
// [0, 1]; 0 where nothing is seen.
struct SeenDepth {
  DepthMap depth;
  std::vector<float> cos_incidence;
};

struct Pinhole {
  int width = 0;
  int height = 0;
  double focal_px = 0;
  double centre_x_px = 0;
  double centre_y_px = 0;

  Eigen::Vector2d pixel_of(const Eigen::Vector3d& point) const {
    return {centre_x_px + focal_px * point.x() / point.z(),
            centre_y_px + focal_px * point.y() / point.z()};
  }
  // The point seen at `pixel` whose z is `depth_m`.
  Eigen::Vector3d point_at(const Eigen::Vector2d& pixel, double depth_m) const {
    return {(pixel.x() - centre_x_px) / focal_px * depth_m,
            (pixel.y() - centre_y_px) / focal_px * depth_m, depth_m};
  }
};

// A camera with its principal point in the middle of the image.
inline Pinhole centred_pinhole(int width, int height, double focal_px) {
  return {width, height, focal_px, (width - 1) / 2.0, (height - 1) / 2.0};
}

}  // namespace simbench::reconstruction

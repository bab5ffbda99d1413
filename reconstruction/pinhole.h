// A pinhole camera: how points of its own frame become pixels, and back.
//
// The camera looks along +z, x to the right and y down in its image. Pixels are square; the centre
// of the pixel in column i and row j is at (i, j). No distortion: depth images of the D400 family
// are rectified.
//
//   const Pinhole camera = centred_pinhole(848, 480, 430.0);
//   const Eigen::Vector2d pixel = camera.pixel_of(point);          // point.z() > 0
//   const Eigen::Vector3d again = camera.point_at(pixel, point.z());
#ifndef SIMBENCH_RECONSTRUCTION_PINHOLE_H_
#define SIMBENCH_RECONSTRUCTION_PINHOLE_H_

#include <Eigen/Core>

namespace simbench::reconstruction {

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

// With its principal point in the middle of the image.
inline Pinhole centred_pinhole(int width, int height, double focal_px) {
  return {width, height, focal_px, (width - 1) / 2.0, (height - 1) / 2.0};
}

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_PINHOLE_H_

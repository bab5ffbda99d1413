#include "reconstruction/depth_map.h"

#include <gmock/gmock.h>

namespace simbench::reconstruction {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(Pinhole, TheAxisMeetsTheMiddleOfTheImage) {
  const Pinhole camera = centred_pinhole(848, 480, 430);
  EXPECT_EQ(camera.pixel_of({0, 0, 1}), Vector2d(423.5, 239.5));
  EXPECT_EQ(camera.pixel_of({0, 0, 7}), Vector2d(423.5, 239.5));
}

TEST(Pinhole, PixelsAreFocalLengthsOfTheSlope) {
  const Pinhole camera{
      .width = 100, .height = 80, .focal_px = 50, .centre_x_px = 40, .centre_y_px = 30};
  EXPECT_EQ(camera.pixel_of({1, 0, 2}), Vector2d(65, 30));     // right
  EXPECT_EQ(camera.pixel_of({0, -1, 4}), Vector2d(40, 17.5));  // up
  EXPECT_EQ(camera.point_at({65, 30}, 2), Vector3d(1, 0, 2));
}

// The D455's depth image sees 89 by 58 degrees, as far as 848 pixels at 430 pixels go.
TEST(Pinhole, FieldOfView) {
  const Pinhole camera = centred_pinhole(848, 480, 430);
  const Vector3d left = camera.point_at({-0.5, 239.5}, 1);
  const Vector3d right = camera.point_at({847.5, 239.5}, 1);
  EXPECT_NEAR(right.x() - left.x(), 848 / 430.0, 1e-12);
  const Vector3d top = camera.point_at({423.5, -0.5}, 1);
  EXPECT_NEAR(top.y(), -240 / 430.0, 1e-12);
}

TEST(Pinhole, ThereAndBackAgain) {
  const Pinhole camera = centred_pinhole(640, 360, 324.5);
  for (int column = 0; column < 640; column += 53) {
    for (int row = 0; row < 360; row += 31) {
      const Vector2d pixel(column, row);
      const Vector3d point = camera.point_at(pixel, 2.25);
      EXPECT_EQ(point.z(), 2.25);
      EXPECT_NEAR((camera.pixel_of(point) - pixel).norm(), 0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace simbench::reconstruction

#include "reconstruction/libraries/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reconstruction/primitives.h"
#include "tests/nonempty.h"
#include "tests/reconstruction/box.h"

namespace simbench::reconstruction {
namespace {

constexpr double kFine = 1e-4;  // m, of the tessellation

Eigen::Isometry3d shifted(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

const Pinhole kCamera = centred_pinhole(101, 81, 100.0);

// The first crossing of the ray through a pixel with a sphere on the camera's axis, as depth.
double sphere_depth(double column, double row, double distance, double radius) {
  const Eigen::Vector3d ray = kCamera.point_at({column, row}, 1.0);
  const double b = distance;  // ray.dot(centre), as ray.z is 1
  const double discriminant = b * b - ray.squaredNorm() * (distance * distance - radius * radius);
  return discriminant < 0 ? 0 : (b - std::sqrt(discriminant)) / ray.squaredNorm();
}

TEST(RayCaster, SeesASphereWhereItIs) {
  RayCaster caster({make_sphere(0.5, kFine)});
  caster.pose({shifted(0, 0, 2)});
  const SeenDepth seen = caster.see(kCamera, Eigen::Isometry3d::Identity());
  int hits = 0;
  for (int row = 0; row < 81; ++row) {
    for (int column = 0; column < 101; ++column) {
      const double inner = sphere_depth(column, row, 2, 0.5 - 2 * kFine);
      const double outer = sphere_depth(column, row, 2, 0.5);
      const auto depth = static_cast<double>(seen.depth.at(column, row));
      if (inner > 0) {
        ++hits;
        EXPECT_GE(depth, outer - 1e-5) << column << ' ' << row;
        EXPECT_LE(depth, inner + 1e-5) << column << ' ' << row;
      } else if (outer == 0) {
        EXPECT_EQ(depth, 0) << column << ' ' << row;
      }
    }
  }
  EXPECT_GT(hits, 1500);  // a disc of some 25 pixels radius
}

TEST(RayCaster, TellsHowSteeplyASurfaceIsMet) {
  RayCaster caster({make_box({2, 2, 0.1})});
  for (const double turn : {0.0, 0.5, 1.0}) {
    Eigen::Isometry3d pose = shifted(0, 0, 2);
    pose.rotate(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()));
    caster.pose({pose});
    const SeenDepth seen = caster.see(kCamera, Eigen::Isometry3d::Identity());
    const std::size_t middle = seen.depth.index(50, 40);
    EXPECT_NEAR(seen.cos_incidence[middle], std::cos(turn), 1e-5);
    EXPECT_NEAR(static_cast<double>(seen.depth.depth_m[middle]), 2 - 0.05 / std::cos(turn), 1e-5);
  }
}

TEST(RayCaster, LooksFromWhereTheCameraStands) {
  RayCaster caster({make_box({1, 1, 1})});
  Eigen::Isometry3d camera = shifted(3, 0, 0);
  // Looking along -x, y of the image down the world's z.
  camera.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  const DepthMap depth = caster.depth(kCamera, camera);
  EXPECT_NEAR(static_cast<double>(depth.at(50, 40)), 2.5, 1e-5);
  // 0.5 m above and beside the axis at 2.5 m are 20 pixels.
  EXPECT_GT(depth.at(50 + 19, 40), 0);
  EXPECT_EQ(depth.at(50 + 21, 40), 0);
}

TEST(RayCaster, TheNearestPartHidesTheOthersAndPosesCanChange) {
  RayCaster caster({make_sphere(0.2, kFine), make_sphere(0.2, kFine)});
  caster.pose({shifted(0, 0, 2), shifted(0, 0, 3)});
  std::vector<RayHit> hits;
  DepthMap depth = caster.depth(kCamera, Eigen::Isometry3d::Identity(), &hits);
  EXPECT_NEAR(static_cast<double>(depth.at(50, 40)), 1.8, 1e-3);
  EXPECT_EQ(hits[depth.index(50, 40)].part, 0U);
  caster.pose({shifted(0, 0, 4), shifted(0, 0, 3)});
  depth = caster.depth(kCamera, Eigen::Isometry3d::Identity(), &hits);
  EXPECT_NEAR(static_cast<double>(depth.at(50, 40)), 2.8, 1e-3);
  EXPECT_EQ(hits[depth.index(50, 40)].part, 1U);
}

TEST(RayCaster, SeesNothingOfWhatIsBehindOrEmpty) {
  RayCaster caster({make_sphere(0.5, kFine), TriangleMesh{}});
  caster.pose({shifted(0, 0, -2), shifted(0, 0, 2)});
  for (const float depth : nonempty(caster.depth(kCamera, Eigen::Isometry3d::Identity()).depth_m)) {
    ASSERT_EQ(depth, 0);
  }
}

TEST(RayCaster, FromInsideABoxSeesItsWalls) {
  RayCaster caster({make_box({2, 2, 2})});
  const DepthMap depth = caster.depth(kCamera, Eigen::Isometry3d::Identity());
  for (const float z : depth.depth_m) ASSERT_NEAR(z, 1.0F, 1e-5F);
}

}  // namespace
}  // namespace simbench::reconstruction

#include "reconstruction/reprojection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace simbench::reconstruction {
namespace {

constexpr double kTolerance = 0.05;
constexpr int kReach = 1;

// At the origin, looking along the world's z.
StudioCamera camera_at_origin() {
  return {.intrinsics = centred_pinhole(101, 81, 100.0),
          .world_from_camera = Eigen::Isometry3d::Identity(),
          .believed = Eigen::Isometry3d::Identity()};
}

DepthMap flat(float depth_m) {
  DepthMap map(101, 81);
  for (float& depth : map.depth_m) depth = depth_m;
  return map;
}

TriangleMesh mesh_of(std::vector<Eigen::Vector3f> vertices) {
  return {.vertices = std::move(vertices), .triangles = {}};
}

struct Scored {
  ErrorSummary all;
  VertexErrors by_vertex;
};

Scored score(const TriangleMesh& mesh, const DepthMap& zbuffer, const DepthMap& measured,
             const StudioCamera& camera = camera_at_origin()) {
  ErrorStatistics errors;
  VertexErrors by_vertex(mesh.vertices.size());
  add_reprojection_errors(mesh, zbuffer, measured, camera, {kTolerance, kReach}, errors, by_vertex);
  return {errors.summary(), by_vertex};
}

TEST(Reprojection, AWallMeasuredTooFarIsOffByThatMuchOnTheAxis) {
  const TriangleMesh mesh = mesh_of({{0, 0, 2}});
  const Scored scored = score(mesh, flat(2.0F), flat(2.03F));
  EXPECT_EQ(scored.all.count, 1);
  EXPECT_NEAR(scored.all.mean_cm, 3.0, 1e-4);
  EXPECT_NEAR(scored.by_vertex.mean_m(0), 0.03, 1e-6);
}

// Off the axis, the measured point lies farther along the vertex's own ray.
TEST(Reprojection, OffTheAxisTheErrorIsAlongTheRay) {
  const TriangleMesh mesh = mesh_of({{0.8F, 0.4F, 2}});  // pixel (90, 60) exactly
  const Scored scored = score(mesh, flat(2.0F), flat(2.2F));
  EXPECT_NEAR(scored.all.mean_cm, 100 * 0.1 * std::sqrt(0.8 * 0.8 + 0.4 * 0.4 + 4.0), 1e-3);
}

TEST(Reprojection, AVertexBehindTheSurfaceBeyondTheToleranceIsNotSeen) {
  const TriangleMesh mesh = mesh_of({{0, 0, 2.04F}, {0, 0, 2.06F}});
  const Scored scored = score(mesh, flat(2.0F), flat(2.0F));
  EXPECT_EQ(scored.all.count, 1);
  EXPECT_EQ(scored.by_vertex.matches[0], 1);
  EXPECT_EQ(scored.by_vertex.matches[1], 0);
  EXPECT_TRUE(std::isnan(scored.by_vertex.mean_m(1)));
}

TEST(Reprojection, PixelsWithoutDepthMatchNothing) {
  const TriangleMesh mesh = mesh_of({{0, 0, 2}});
  EXPECT_EQ(score(mesh, flat(2.0F), flat(0.0F)).all.count, 0);
}

TEST(Reprojection, VerticesBehindTheCameraOrOutsideTheImageMatchNothing) {
  const TriangleMesh mesh = mesh_of({{0, 0, -2}, {3, 0, 2}, {0, -3, 2}, {0, 0, 0}});
  EXPECT_EQ(score(mesh, flat(2.0F), flat(2.0F)).all.count, 0);
}

TEST(Reprojection, AVertexBesideANearOutlineIsHiddenByIt) {
  DepthMap zbuffer = flat(3.0F);
  zbuffer.depth_m[zbuffer.index(50, 40)] = 2.0F;         // a limb's outermost pixel
  const TriangleMesh beside = mesh_of({{0.03F, 0, 3}});  // its right neighbour
  const TriangleMesh farther = mesh_of({{0.06F, 0, 3}});
  EXPECT_EQ(score(beside, zbuffer, flat(3.0F)).all.count, 0);
  EXPECT_EQ(score(farther, zbuffer, flat(3.0F)).all.count, 1);
}

TEST(Reprojection, BelievedPosesDecideWhereAVertexIsLookedFor) {
  StudioCamera camera = camera_at_origin();
  camera.believed.translation() = Eigen::Vector3d(0, 0, -1);
  camera.world_from_camera.translation() = Eigen::Vector3d(5, 5, 5);  // never looked at
  const TriangleMesh mesh = mesh_of({{0, 0, 1}});                     // 2 m from where it believes
  const Scored scored = score(mesh, flat(2.0F), flat(2.01F), camera);
  EXPECT_NEAR(scored.all.mean_cm, 1.0, 1e-3);
}

TEST(Spread, ReachesTheStatedNeighboursAndTheNearestWins) {
  DepthMap map(9, 9);
  map.depth_m[map.index(4, 4)] = 2.0F;
  map.depth_m[map.index(6, 4)] = 1.0F;
  const DepthMap spread = spread_to_neighbours(map, 2);
  EXPECT_EQ(spread.at(2, 2), 2.0F);
  EXPECT_EQ(spread.at(1, 4), 0.0F);
  EXPECT_EQ(spread.at(4, 4), 1.0F);
  EXPECT_EQ(spread.at(8, 6), 1.0F);
  EXPECT_EQ(spread.at(3, 4), 2.0F);
  EXPECT_EQ(spread.at(4, 7), 0.0F);
}

TEST(Spread, OfReachZeroChangesNothing) {
  DepthMap map(5, 4);
  map.depth_m[map.index(2, 1)] = 2.0F;
  EXPECT_EQ(spread_to_neighbours(map, 0).depth_m, map.depth_m);
}

float lightness(const Eigen::Vector3f& colour) {
  return colour.dot(Eigen::Vector3f(0.3F, 0.6F, 0.1F));
}

TEST(ErrorColour, GetsLighterWithTheErrorAndThenStays) {
  for (int step = 1; step <= 10; ++step) {
    EXPECT_GT(lightness(error_colour(kPaintedUpTo * step / 10)),
              lightness(error_colour(kPaintedUpTo * (step - 1) / 10)))
        << step;
  }
  EXPECT_EQ(error_colour(kPaintedUpTo), error_colour(5 * kPaintedUpTo));
}

TEST(ErrorColour, OfNoErrorIsGreyAndOfEveryErrorIsNot) {
  const Eigen::Vector3f grey = error_colour(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(grey.x(), grey.y());
  EXPECT_EQ(grey.y(), grey.z());
  for (int step = 0; step <= 20; ++step) {
    const Eigen::Vector3f colour = error_colour(kPaintedUpTo * step / 20);
    EXPECT_GT(colour.maxCoeff() - colour.minCoeff(), 0.2F) << step;
    EXPECT_GE(colour.minCoeff(), 0.0F);
    EXPECT_LE(colour.maxCoeff(), 1.0F);
  }
}

TEST(ErrorColours, AreThoseOfTheMeanErrors) {
  VertexErrors errors(2);
  errors.sum_m[0] = 0.08;
  errors.matches[0] = 2;
  const auto colours = error_colours(errors);
  ASSERT_EQ(colours.size(), 2U);
  EXPECT_EQ(colours[0], error_colour(0.04));
  EXPECT_EQ(colours[1], error_colour(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace simbench::reconstruction

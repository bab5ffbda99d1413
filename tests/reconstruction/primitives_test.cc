#include "reconstruction/primitives.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/reconstruction/angles.h"

namespace simbench::reconstruction {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-6;  // of a float, in m

struct Corners {
  Vector3d a, b, c;
  Vector3d normal() const { return (b - a).cross(c - a); }  // twice the area long
};

std::vector<Corners> triangles_of(const TriangleMesh& mesh) {
  std::vector<Corners> triangles;
  const auto corner = [&](int i) {
    return Vector3d(mesh.vertices.at(static_cast<std::size_t>(i)).cast<double>());
  };
  for (const Eigen::Vector3i& t : mesh.triangles) {
    triangles.push_back({corner(t[0]), corner(t[1]), corner(t[2])});
  }
  return triangles;
}

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const Corners& t : triangles_of(mesh)) area += t.normal().norm() / 2;
  return area;
}

double volume_of(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Corners& t : triangles_of(mesh)) volume += t.a.dot(t.b.cross(t.c)) / 6;
  return volume;
}

// Every edge belongs to two triangles that run along it in opposite directions; all vertices are
// used; one piece without handles (Euler).
void expect_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    ASSERT_EQ(count, 1) << edge.first << " to " << edge.second;
    ASSERT_EQ(uses.count({edge.second, edge.first}), 1U) << edge.first << " to " << edge.second;
  }
  EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size() - uses.size() / 2, 2U);
}

void expect_outward(const TriangleMesh& mesh, const Vector3d& inside) {
  for (const Corners& t : nonempty(triangles_of(mesh))) {
    ASSERT_GT(t.normal().norm(), 0);
    ASSERT_GT(t.normal().dot(t.a - inside), 0) << t.a.transpose();
  }
}

// `distance` from the smooth surface, negative inside: 0 at vertices, and elsewhere at most the
// largest error deep. Returns the deepest.
double expect_near(const TriangleMesh& mesh, double largest_error,
                   const std::function<double(const Vector3d&)>& distance) {
  for (const Eigen::Vector3f& vertex : nonempty(mesh.vertices)) {
    EXPECT_NEAR(distance(vertex.cast<double>()), 0, kRounding) << vertex.transpose();
  }
  double deepest = 0;
  constexpr int kSteps = 2;
  for (const Corners& t : nonempty(triangles_of(mesh))) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vector3d point = t.a + (t.b - t.a) * i / kSteps + (t.c - t.a) * j / kSteps;
        deepest = std::max(deepest, -distance(point));
      }
    }
    const Vector3d centroid = (t.a + t.b + t.c) / 3;
    EXPECT_LT(distance(centroid), kRounding);
    deepest = std::max(deepest, -distance(centroid));
  }
  EXPECT_LE(deepest, largest_error + kRounding);
  return deepest;
}

// An upper bound: along the ray from the centre.
double ellipsoid_distance(const Vector3d& point, const Vector3d& axes) {
  const double share = point.cwiseQuotient(axes).norm();
  return point.norm() * (1 - 1 / share);
}

// To the hull of all spheres between the ends, by definition. The distance is convex along the
// axis.
double capsule_distance(const Vector3d& point, double radius, double end_radius, double length) {
  const auto from_sphere = [&](double t) {
    return (point - Vector3d(0, 0, -t * length)).norm() - (radius + t * (end_radius - radius));
  };
  double low = 0;
  double high = 1;
  for (int i = 0; i < 40; ++i) {
    const double left = low + (high - low) / 3;
    const double right = high - (high - low) / 3;
    if (from_sphere(left) < from_sphere(right)) {
      high = right;
    } else {
      low = left;
    }
  }
  return from_sphere((low + high) / 2);
}

// Two spherical caps and a frustum between them; `s` is the sine of the latitude where they meet.
struct CapsuleSize {
  CapsuleSize(double r, double e, double length) {
    const double s = (e - r) / length;
    const double c = std::sqrt(1 - s * s);
    const double frustum = length - (e - r) * s;
    volume = kPi / 3 *
             (r * r * r * (1 - s) * (1 - s) * (2 + s) + e * e * e * (1 + s) * (1 + s) * (2 - s) +
              frustum * c * c * (r * r + r * e + e * e));
    area = 2 * kPi * (r * r * (1 - s) + e * e * (1 + s)) + kPi * (r + e) * c * length * c;
  }
  double volume;
  double area;
};

TEST(Primitives, ASphereIsWithinItsError) {
  for (const double error : {0.05, 0.01, 0.001, 0.0003}) {
    SCOPED_TRACE(error);
    const double radius = 0.5;
    const TriangleMesh sphere = make_sphere(radius, error);
    expect_closed(sphere);
    expect_outward(sphere, Vector3d::Zero());
    const double deepest =
        expect_near(sphere, error, [&](const Vector3d& p) { return p.norm() - radius; });
    if (error < 0.02) {
      EXPECT_GT(deepest, error / 2) << "finer than it need be";
    }
    // It contains a sphere of radius - error.
    EXPECT_LT(volume_of(sphere), 4 * kPi / 3 * std::pow(radius, 3));
    EXPECT_GT(volume_of(sphere), 4 * kPi / 3 * std::pow(radius - error, 3));
    EXPECT_LT(area_of(sphere), 4 * kPi * std::pow(radius, 2));
    EXPECT_GT(area_of(sphere), 4 * kPi * std::pow(radius - error, 2));
    EXPECT_TRUE(sphere.colours.empty());
  }
}

TEST(Primitives, TrianglesGrowAsTheErrorShrinks) {
  const auto count = [](double error) { return make_sphere(0.1, error).triangles.size(); };
  EXPECT_LT(count(0.001), 1500U);
  EXPECT_NEAR(static_cast<double>(count(0.00001)) / static_cast<double>(count(0.001)), 100, 15);
}

TEST(Primitives, AnErrorLargerThanTheSphereStillGivesASolid) {
  const TriangleMesh sphere = make_sphere(0.01, 1.0);
  expect_closed(sphere);
  EXPECT_GT(volume_of(sphere), 0.7 * 4 * kPi / 3 * 1e-6);
}

TEST(Primitives, AnEllipsoidIsWithinItsError) {
  const double error = 0.001;
  for (const Vector3d& axes :
       {Vector3d(0.1, 0.2, 0.3), Vector3d(0.3, 0.05, 0.1), Vector3d(0.1, 0.4, 0.1)}) {
    SCOPED_TRACE(axes.transpose());
    const TriangleMesh ellipsoid = make_ellipsoid(axes, error);
    expect_closed(ellipsoid);
    expect_outward(ellipsoid, Vector3d::Zero());
    expect_near(ellipsoid, error, [&](const Vector3d& p) { return ellipsoid_distance(p, axes); });
    const double smooth = 4 * kPi / 3 * axes.prod();
    EXPECT_LT(volume_of(ellipsoid), smooth);
    EXPECT_GT(volume_of(ellipsoid), smooth * std::pow(1 - error / axes.maxCoeff(), 3));
  }
}

TEST(Primitives, ATaperedCapsuleIsWithinItsError) {
  const double error = 0.002;
  const double length = 0.4;
  for (const auto& [radius, end_radius] :
       {std::pair(0.1, 0.1), std::pair(0.1, 0.04), std::pair(0.05, 0.2), std::pair(0.4, 0.01)}) {
    SCOPED_TRACE(testing::Message() << radius << " to " << end_radius);
    const TriangleMesh limb = make_tapered_capsule(radius, end_radius, length, error);
    expect_closed(limb);
    expect_outward(limb, Vector3d::Zero());
    expect_near(limb, error, [&, r = radius, e = end_radius](const Vector3d& p) {
      return capsule_distance(p, r, e, length);
    });
    const CapsuleSize smooth(radius, end_radius, length);
    EXPECT_LT(volume_of(limb), smooth.volume);
    EXPECT_GT(volume_of(limb), smooth.volume - smooth.area * error);
    EXPECT_LT(area_of(limb), smooth.area);
    EXPECT_GT(area_of(limb), smooth.area * (1 - 2 * error / std::min(radius, end_radius)));
  }
}

TEST(Primitives, ACapsuleOfEqualEndsIsACylinderWithTwoHalfSpheres) {
  const double r = 0.1;
  const double length = 0.5;
  const TriangleMesh capsule = make_tapered_capsule(r, r, length, 1e-5);
  EXPECT_NEAR(volume_of(capsule), kPi * r * r * length + 4 * kPi / 3 * r * r * r, 1e-5);
  EXPECT_NEAR(area_of(capsule), 2 * kPi * r * length + 4 * kPi * r * r, 1e-4);
}

TEST(Primitives, ACapsuleOfOneSphereInsideTheOtherIsTheLargerOne) {
  const double sphere = 4 * kPi / 3 * 1e-3;
  const TriangleMesh small_end = make_tapered_capsule(0.1, 0.04, 0.05, 1e-3);
  expect_closed(small_end);
  expect_near(small_end, 1e-3, [](const Vector3d& p) { return p.norm() - 0.1; });
  EXPECT_NEAR(volume_of(small_end), sphere, 2e-4);

  const TriangleMesh large_end = make_tapered_capsule(0.04, 0.1, 0.05, 1e-3);
  expect_closed(large_end);
  expect_near(large_end, 1e-3,
              [](const Vector3d& p) { return (p + Vector3d(0, 0, 0.05)).norm() - 0.1; });

  EXPECT_EQ(make_tapered_capsule(0.1, 0.1, 0, 1e-3).vertices, make_sphere(0.1, 1e-3).vertices);
}

TEST(Primitives, WhatHasNoSizeIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -0.1, nan, std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(bad);
    EXPECT_THROW(make_sphere(bad, 0.001), std::invalid_argument);
    EXPECT_THROW(make_sphere(0.1, bad), std::invalid_argument);
    EXPECT_THROW(make_ellipsoid({0.1, bad, 0.1}, 0.001), std::invalid_argument);
    EXPECT_THROW(make_tapered_capsule(bad, 0.1, 0.3, 0.001), std::invalid_argument);
    EXPECT_THROW(make_tapered_capsule(0.1, bad, 0.3, 0.001), std::invalid_argument);
    EXPECT_THROW(make_tapered_capsule(0.1, 0.1, 0.3, bad), std::invalid_argument);
  }
  EXPECT_THROW(make_tapered_capsule(0.1, 0.1, -0.3, 0.001), std::invalid_argument);
}

}  // namespace
}  // namespace simbench::reconstruction

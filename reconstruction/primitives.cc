#include "reconstruction/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace simbench::reconstruction {
namespace {

void require_positive(double length_m, const char* what) {
  if (length_m > 0 && std::isfinite(length_m)) return;
  throw std::invalid_argument(fmt::format("{} of {} m, must be more than 0", what, length_m));
}

// A circle of latitude of a solid of revolution about z.
struct Ring {
  double radius = 0;
  double z = 0;
};

// The longest steps of latitude and longitude at which a sphere's triangles keep the largest error.
//
// Around the middle of a cell with steps of t, the haversine of the angle d to its corners is at
// most 2 sin(t / 4)^2; no point of a triangle with these corners is deeper than r (1 - cos d),
// which is r 4 sin(t / 4)^2.
double longest_step(double radius, double largest_error) {
  const double coarsest = std::numbers::pi / 4;
  const double half_sine = std::sqrt(largest_error / radius) / 2;
  return half_sine >= std::sin(coarsest / 4) ? coarsest : 4 * std::asin(half_sine);
}

int steps_for(double angle, double step) {
  return std::max(1, static_cast<int>(std::ceil(angle / step - 1e-9)));
}

// Rings of a sphere about (0, 0, centre_z) from latitude `from` to `to`, both included.
void append_rings(std::vector<Ring>& rings, double radius, double centre_z, double from, double to,
                  double step) {
  const int count = steps_for(std::abs(from - to), step);
  for (int i = 0; i <= count; ++i) {
    const double latitude = from + (to - from) * i / count;
    rings.push_back({radius * std::cos(latitude), centre_z + radius * std::sin(latitude)});
  }
}

// Meshes rings from top to bottom; the first and the last are points.
TriangleMesh revolve(const std::vector<Ring>& rings, int segments) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0.0F, 0.0F, static_cast<float>(rings.front().z));
  const int inner = static_cast<int>(rings.size()) - 2;
  for (int i = 1; i <= inner; ++i) {
    const Ring& ring = rings[static_cast<std::size_t>(i)];
    for (int k = 0; k < segments; ++k) {
      const double longitude = 2 * std::numbers::pi * k / segments;
      const Eigen::Vector3d vertex(ring.radius * std::cos(longitude),
                                   ring.radius * std::sin(longitude), ring.z);
      mesh.vertices.emplace_back(vertex.cast<float>());
    }
  }
  mesh.vertices.emplace_back(0.0F, 0.0F, static_cast<float>(rings.back().z));
  const int bottom = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int ring, int k) { return 1 + (ring - 1) * segments + k % segments; };
  for (int k = 0; k < segments; ++k) {
    mesh.triangles.emplace_back(0, at(1, k), at(1, k + 1));
    for (int i = 1; i < inner; ++i) {
      mesh.triangles.emplace_back(at(i, k), at(i + 1, k), at(i + 1, k + 1));
      mesh.triangles.emplace_back(at(i, k), at(i + 1, k + 1), at(i, k + 1));
    }
    mesh.triangles.emplace_back(at(inner, k), bottom, at(inner, k + 1));
  }
  return mesh;
}

void move(TriangleMesh& mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += by.cast<float>();
}

}  // namespace

TriangleMesh make_sphere(double radius_m, double largest_error_m) {
  return make_ellipsoid(Eigen::Vector3d::Constant(radius_m), largest_error_m);
}

// A stretched unit sphere: no distance grows by more than the longest semi-axis.
TriangleMesh make_ellipsoid(const Eigen::Vector3d& semi_axes_m, double largest_error_m) {
  for (const double semi_axis : semi_axes_m) require_positive(semi_axis, "a semi-axis");
  require_positive(largest_error_m, "a largest error");
  const double step = longest_step(semi_axes_m.maxCoeff(), largest_error_m);
  std::vector<Ring> rings;
  append_rings(rings, 1.0, 0.0, std::numbers::pi / 2, -std::numbers::pi / 2, step);
  TriangleMesh mesh = revolve(rings, steps_for(2 * std::numbers::pi, step));
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = vertex.cast<double>().cwiseProduct(semi_axes_m).cast<float>();
  }
  return mesh;
}

// The cone that touches both spheres does so where their normal has z = (end radius - radius) /
// length: there the change of the radius makes up for the move of the centre.
TriangleMesh make_tapered_capsule(double radius_m, double end_radius_m, double length_m,
                                  double largest_error_m) {
  require_positive(radius_m, "a radius");
  require_positive(end_radius_m, "a radius");
  require_positive(largest_error_m, "a largest error");
  if (length_m != 0) require_positive(length_m, "a length");
  if (length_m <= std::abs(end_radius_m - radius_m)) {
    TriangleMesh mesh = make_sphere(std::max(radius_m, end_radius_m), largest_error_m);
    if (end_radius_m > radius_m) move(mesh, {0, 0, -length_m});
    return mesh;
  }
  const double step = longest_step(std::max(radius_m, end_radius_m), largest_error_m);
  const double touching = std::asin((end_radius_m - radius_m) / length_m);
  std::vector<Ring> rings;
  append_rings(rings, radius_m, 0.0, std::numbers::pi / 2, touching, step);
  append_rings(rings, end_radius_m, -length_m, touching, -std::numbers::pi / 2, step);
  return revolve(rings, steps_for(2 * std::numbers::pi, step));
}

}  // namespace simbench::reconstruction

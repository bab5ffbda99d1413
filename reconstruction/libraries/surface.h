// From depth maps to a surface: one oriented point set, then Poisson surface reconstruction, with
// Open3D.
//
// Each depth map becomes points in the world's frame, averaged on a grid of `spacing_m`; their
// normals are those of planes through the points within kNormalRadius, turned towards the camera.
// The points of all cameras are reconstructed together (Kazhdan, Bolitho and Hoppe 2006; screened,
// of depth kPoissonDepth: 256 cells along the longest side plus a tenth). Nothing is cut off: the
// surface is closed also where nothing was seen.
//
// Deterministic, on one thread. Cost: some seconds for a person.
//
//   OrientedPoints points;
//   add_points(measured, camera, 0.005, points);   // for each camera
//   const TriangleMesh mesh = poisson_surface(points);
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reconstruction/depth_map.h"
#include "reconstruction/studio.h"
#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

inline constexpr int kPoissonDepth = 8;
inline constexpr double kNormalRadius = 0.03;  // m

struct OrientedPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;  // of length 1, out of the surface
};

// Adds the points of a depth map, from the camera's believed pose.
void add_points(const DepthMap& measured, const StudioCamera& camera, double spacing_m,
                OrientedPoints& points);

// A mesh without triangles if there are too few points (kFewestPoints) to make a surface of.
inline constexpr std::size_t kFewestPoints = 100;
TriangleMesh poisson_surface(const OrientedPoints& points);

}  // namespace simbench::reconstruction

// The reprojection error: the distance of a reconstructed surface from each camera's measurement.
//
// Every vertex is projected into every depth map. Where it is visible (z-buffer test) and the pixel
// has a value, the error is the distance between the vertex and the point that the depth map has
// at that pixel, in the world's frame: section 4.4 of the paper. All of it uses believed camera
// poses, as a user has no others.
//
// z-buffer test: the mesh itself, rendered from the camera at the depth map's resolution, each
// pixel's depth spread to the pixels around it (the nearest wins). A vertex is visible if it is no
// farther than that plus a tolerance. Spreading excludes vertices just beside the outline of a
// nearer limb: calibration errors shift outlines by some pixels and would match such a vertex with
// the limb in front of it or the wall behind. The width is a choice that moves the result: a still
// person has 3.0, 2.8, 2.5, 2.1, 1.9 cm with 0, 1, 2, 4, 8 pixels of an 848x480 image (2 pixels are
// 9 mm at 2 m).
//
//   ErrorStatistics errors;
//   VertexErrors painted(mesh.vertices.size());
//   add_reprojection_errors(mesh, zbuffer, measured, camera, {.tolerance_m = 0.05, .spread_px = 2},
//                           errors, painted);
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reconstruction/depth_map.h"
#include "reconstruction/error_statistics.h"
#include "reconstruction/studio.h"
#include "reconstruction/triangle_mesh.h"

namespace simbench::reconstruction {

// The sum of each vertex's errors over the depth maps that it was matched with.
struct VertexErrors {
  explicit VertexErrors(std::size_t vertices) : sum_m(vertices), matches(vertices) {}
  // NaN for a vertex that no depth map matched.
  double mean_m(std::size_t vertex) const;

  std::vector<double> sum_m;
  std::vector<std::int32_t> matches;
};

struct VisibilityTest {
  double tolerance_m = 0;
  int spread_px = 0;
};

// Each pixel's nearest depth within `reach_px` columns and rows; 0 where there is none.
DepthMap spread_to_neighbours(const DepthMap& zbuffer, int reach_px);

// `zbuffer`: the mesh as rendered from camera.believed, before spreading. `measured`: the camera's
// depth map, of the same size.
void add_reprojection_errors(const TriangleMesh& mesh, const DepthMap& zbuffer,
                             const DepthMap& measured, const StudioCamera& camera,
                             const VisibilityTest& test, ErrorStatistics& errors,
                             VertexErrors& by_vertex);

inline constexpr double kPaintedUpTo = 0.10;  // m

// An error as a colour: red, green, blue in [0, 1]. From dark blue (none) through green to yellow
// (kPaintedUpTo and more); NaN is grey. Legible in print and without telling red from green.
Eigen::Vector3f error_colour(double error_m);

// The colour of each vertex's mean error.
std::vector<Eigen::Vector3f> error_colours(const VertexErrors& errors);

}  // namespace simbench::reconstruction

// The reprojection error: how far a reconstructed surface is from what each camera measured.
//
// Every vertex is projected into every depth map. Where it is visible (z-buffer test) and the pixel
// has a value, the error is the distance between the vertex and the point that the depth map has
// at that pixel, in the world's frame: section 4.4 of the paper. All of it uses believed camera
// poses, as a user has no others.
//
// z-buffer test: the mesh itself, rendered from the camera at the depth map's resolution, each
// pixel's depth spread to the pixels around it (the nearest wins). A vertex is visible if it is no
// farther than that plus a tolerance. The spreading is for vertices just beside the outline of a
// nearer limb: calibration errors shift outlines by some pixels, and such a vertex is matched with
// the limb in front of it or the wall behind. How far to spread is a choice that moves the result:
// a still person has 3.0, 2.8, 2.5, 2.1, 1.9 cm with 0, 1, 2, 4, 8 pixels of an 848x480 image (9 mm
// are 2 at 2 m).
//
//   ErrorStatistics errors;
//   VertexErrors painted(mesh.vertices.size());
//   add_reprojection_errors(mesh, zbuffer, measured, camera, {.tolerance_m = 0.05, .spread_px = 2},
//                           errors, painted);
#ifndef SIMBENCH_RECONSTRUCTION_REPROJECTION_H_
#define SIMBENCH_RECONSTRUCTION_REPROJECTION_H_

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
  // NaN of a vertex that no depth map matched.
  double mean_m(std::size_t vertex) const;

  std::vector<double> sum_m;
  std::vector<std::int32_t> matches;
};

struct VisibilityTest {
  double tolerance_m = 0;
  int spread_px = 0;
};

// Each pixel's nearest depth in the square that reaches so far around it; 0 where there is none.
DepthMap spread_to_neighbours(const DepthMap& zbuffer, int reach_px);

// `zbuffer`: the mesh as rendered from camera.believed, before spreading. `measured`: what the
// camera saw; of the same size.
void add_reprojection_errors(const TriangleMesh& mesh, const DepthMap& zbuffer,
                             const DepthMap& measured, const StudioCamera& camera,
                             const VisibilityTest& test, ErrorStatistics& errors,
                             VertexErrors& by_vertex);

}  // namespace simbench::reconstruction

#endif  // SIMBENCH_RECONSTRUCTION_REPROJECTION_H_

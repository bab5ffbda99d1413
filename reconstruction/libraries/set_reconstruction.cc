#include "reconstruction/libraries/set_reconstruction.h"

#include <utility>

#include "algorithms/ports/assert.h"
#include "reconstruction/depth_noise.h"
#include "reconstruction/libraries/surface.h"

namespace simbench::reconstruction {
namespace {

constexpr double kMetresPerMm = 1e-3;

}  // namespace

SetReconstruction::SetReconstruction(const scenarios::Scenario& scenario, const Subject& subject,
                                     std::uint64_t seed)
    : parameters_(scenario.studio.value()),
      subject_(subject),
      seed_(seed),
      visibility_{.tolerance_m = parameters_.visibility_tolerance_mm * kMetresPerMm,
                  .spread_px = static_cast<int>(parameters_.visibility_spread_px)},
      studio_(scenario, seed),
      caster_(subject.parts()) {}

DepthMap SetReconstruction::measure(std::size_t camera, const evaluation::SetExposure& exposure) {
  caster_.pose(subject_.poses(exposure.mid_exposure_s));
  const StudioCamera& place = studio_.cameras()[camera];
  const SeenDepth seen = caster_.see(place.intrinsics, place.world_from_camera);
  return measured_depth(
      seen, parameters_, place.intrinsics.focal_px,
      {.seed = seed_, .camera = static_cast<std::uint32_t>(camera), .frame = exposure.counter});
}

std::optional<ScoredSurface> SetReconstruction::reconstruct(const evaluation::ExposureSet& set,
                                                            ErrorStatistics& errors) {
  SIMBENCH_ASSERT(set.cameras.size() == studio_.cameras().size(), "a place for each camera");
  std::vector<DepthMap> measured(set.cameras.size());
  OrientedPoints points;
  for (std::size_t camera = 0; camera < set.cameras.size(); ++camera) {
    if (!set.cameras[camera]) continue;
    measured[camera] = measure(camera, *set.cameras[camera]);
    add_points(measured[camera], studio_.cameras()[camera],
               parameters_.point_spacing_mm * kMetresPerMm, points);
  }
  TriangleMesh mesh = poisson_surface(points);
  if (mesh.triangles.empty()) return std::nullopt;
  VertexErrors by_vertex(mesh.vertices.size());
  const RayCaster surface({mesh});
  for (std::size_t camera = 0; camera < set.cameras.size(); ++camera) {
    if (!set.cameras[camera]) continue;
    const StudioCamera& place = studio_.cameras()[camera];
    add_reprojection_errors(mesh, surface.depth(place.intrinsics, place.believed), measured[camera],
                            place, visibility_, errors, by_vertex);
  }
  return ScoredSurface{std::move(mesh), std::move(by_vertex)};
}

}  // namespace simbench::reconstruction

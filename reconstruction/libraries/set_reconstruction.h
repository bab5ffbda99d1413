// One frame set: from exposure instants to a surface and its reprojection errors.
//
// Each camera of the set sees the subject at its own frame's true mid-exposure, from its true pose;
// fusion, reconstruction and scoring use only believed poses and measured depths.
//
// Memory: a depth map for each camera, the points, Poisson's octree; nothing is kept between sets.
// One object is for one thread.
//
//   SetReconstruction studio(scenario, *subject, seed);
//   ErrorStatistics errors;
//   const auto surface = studio.reconstruct(set, errors);
//   if (surface) surface->by_vertex.mean_m(0);
#pragma once

#include <cstdint>
#include <optional>

#include "evaluation/run/exposure_sets.h"
#include "reconstruction/error_statistics.h"
#include "reconstruction/libraries/ray_caster.h"
#include "reconstruction/reprojection.h"
#include "reconstruction/studio.h"
#include "reconstruction/subject.h"
#include "reconstruction/triangle_mesh.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

struct ScoredSurface {
  TriangleMesh mesh;
  VertexErrors by_vertex;
};

class SetReconstruction {
 public:
  // `scenario` and `subject` must outlive it.
  SetReconstruction(const scenarios::Scenario& scenario, const Subject& subject,
                    std::uint64_t seed);

  // Adds the errors of the set. Nothing if the cameras saw too little for a surface.
  std::optional<ScoredSurface> reconstruct(const evaluation::ExposureSet& set,
                                           ErrorStatistics& errors);

  // The depth map that the camera measures at this exposure.
  DepthMap measure(std::size_t camera, const evaluation::SetExposure& exposure);

 private:
  const scenarios::Studio& parameters_;
  const Subject& subject_;
  std::uint64_t seed_;
  VisibilityTest visibility_;
  StudioRig studio_;
  RayCaster caster_;
};

}  // namespace simbench::reconstruction

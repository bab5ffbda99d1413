// The reconstruction experiment: pipelines and seeds to frame sets, frame sets to meshes, meshes to
// errors.
//
// For every (pipeline, seed): simulate the capture, take `frames` sets of simultaneous frames as
// the pipeline's stamps have them (evaluation/run/exposure_sets.h), ray-cast each camera's
// depth map at its frame's true mid-exposure, reconstruct with the believed calibration, measure
// the reprojection error. Cameras, calibration errors and noise depend on the seed alone, so that
// pipelines are paired by seed.
//
// Jobs run on `jobs` threads, each with one frame set in memory at a time: memory grows neither
// with frames nor with seeds. Results do not depend on the number of threads.
//
// Needs Embree and Open3D: run_reconstruction() is in simbench::reconstruction_libraries, which is
// built where they are found (cmake/reconstruction.cmake).
//
//   const ReconstructionResults results = run_reconstruction(
//       scenario, make_simulated, options, on_mesh, progress);
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "reconstruction/results.h"
#include "reconstruction/triangle_mesh.h"
#include "scenarios/scenario.h"

namespace simbench::reconstruction {

struct ReconstructionOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 5;
  unsigned jobs = 0;                     // threads; 0: as many as there are cores
  std::vector<std::string> pipelines{};  // by name, in this order; empty: all of the scenario
  std::int64_t frames = 10;              // sets of each capture
  // The curve: factors on the script's speeds, desynchronisations, sets for each seed and point.
  // Empty: no curve.
  std::vector<double> curve_speed_factors{};
  std::vector<double> curve_desync_ms{};
  std::int64_t curve_frames = 1;
  // Factors on the script's speeds, tried from 1 upwards or downwards with the worst row's own
  // exposures until its published error is passed. Each takes all sets of a row. Empty: no search.
  std::vector<double> search_speed_factors{};
  const std::atomic<bool>* cancel = nullptr;  // once true, no more sets are begun
};

// The mesh of a pipeline's first set at the first seed, its vertices coloured by error
// (error_colour in reprojection.h), and its picture. Called one at a time, from any thread, in any
// order.
struct ShownMesh {
  std::string pipeline;
  TriangleMesh mesh;
  std::string ply;                // the mesh as the bytes of a file
  std::vector<std::uint8_t> png;  // the picture, likewise
  double desync_ms = 0;
  ErrorSummary errors;  // of this set alone
};
using MeshKeeper = std::function<void(const ShownMesh&)>;

// The end after ReconstructionOptions::cancel.
class ReconstructionCancelled final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws scenarios::InputError: the scenario has no studio, or too many cameras for it; a pipeline
// is not known; a mesh file cannot be used; no camera sees the subject. ReconstructionCancelled.
// Exceptions of the simulation pass through, but a failed capture (RecordingFailed) is a note of
// its row.
ReconstructionResults run_reconstruction(const scenarios::Scenario& scenario,
                                         const evaluation::SourceFactory& make_source,
                                         const ReconstructionOptions& options,
                                         const MeshKeeper& on_mesh,
                                         const evaluation::Progress& progress);

// What simbench-reconstruct hands to the command line (cli/command_line.h).
struct Reconstruction {
  decltype(&run_reconstruction) run = nullptr;
};

}  // namespace simbench::reconstruction

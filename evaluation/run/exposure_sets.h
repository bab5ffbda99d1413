// Frames that a user would take for simultaneous, with their true exposures (for reconstruction/).
//
// Frame sets are made in the same way for every pipeline: a frame of the anchor (the master's first
// camera that has frames, else the first camera that has) and from each other camera the frame with
// the nearest global stamp. The range of a set has no threshold: with half a period, Algorithm 3
// emits no set at all where hosts are hundreds of milliseconds apart, and there would be nothing to
// compare. The nearest frame of a running camera is at most half a period away, so a camera without
// a frame within three quarters of a period of the anchor's stamp (lost frame, stopped camera, end
// of the capture) is missing from the set.
//
// Anchors are spread evenly over the evaluated pulses at which the stamps of all cameras with
// frames overlap; without any, over all evaluated pulses. A frame of a free-running camera counts
// as one of the last trigger pulse before its mid-exposure, in the score too.
//
//   const ExposureSets sets = exposure_sets(scenario, choice, seed, source, /*count=*/10);
//   sets.sets[0].cameras[17]->mid_exposure_s;
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/results.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct SetExposure {
  double mid_exposure_s = 0;  // true time since the first evaluated trigger pulse
  std::uint32_t counter = 0;  // of the frame
};

struct ExposureSet {
  std::vector<std::optional<SetExposure>> cameras;  // by camera; nothing: missing

  // The largest difference of true mid-exposures, in ms; 0 with fewer than two.
  double spread_ms() const;
};

struct ExposureSets {
  std::vector<ExposureSet> sets;  // in order of time
  // Complete sets that the pipeline's own gathering emitted at the evaluated pulses.
  std::int64_t gathered_sets = 0;
  SeedScore score;  // as evaluate() gives it, with pulses
};

// Makes one simulated capture, with any number of cameras. Throws what a job of evaluate() throws,
// without its context, and RecordingFailed if the capture has no truth.
ExposureSets exposure_sets(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                           std::uint64_t seed, RecordingSource& source, std::size_t count);

}  // namespace simbench::evaluation

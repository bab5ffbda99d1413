// Which frames a user would take for simultaneous, and when each of them was really exposed.
//
// For what is made of several cameras' frames together (reconstruction/). Frame sets are the same
// for every pipeline in kind: around a frame of the anchor (the master's first camera; if that has
// no frame, the next one that has), of each other camera the frame whose global stamp is nearest.
// There is no threshold on how far apart stamps of a set are: with half a period, Algorithm 3 gives
// no set at all where hosts are hundreds of milliseconds apart, and there would be nothing to
// compare. But the nearest frame of a camera that runs is at most half a period away: one without a
// frame within three quarters of a period of the anchor's stamp (the frame was lost, the camera
// dropped out, or the capture is over by then) is missing from the set.
//
// Anchors are spread evenly over those evaluated pulses at which the stamps of all cameras overlap
// (that have any); if there are none, over all evaluated pulses. A frame of free-running cameras
// counts as one of the last trigger pulse before its mid-exposure; so it does in the score.
//
//   const ExposureSets sets = exposure_sets(scenario, choice, seed, source, /*count=*/10);
//   sets.sets[0].cameras[17]->mid_exposure_s;
#ifndef SIMBENCH_EVALUATION_RUN_EXPOSURE_SETS_H_
#define SIMBENCH_EVALUATION_RUN_EXPOSURE_SETS_H_

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

  // The largest difference of true mid-exposures, in ms; 0 of fewer than two.
  double spread_ms() const;
};

struct ExposureSets {
  std::vector<ExposureSet> sets;  // in order of time
  // Complete sets that the pipeline's own gathering emitted at the evaluated pulses.
  std::int64_t gathered_sets = 0;
  SeedScore score;  // as evaluate() gives it, with pulses
};

// One simulated capture, with any number of cameras. Throws what evaluate() throws for one job, but
// bare, and RecordingFailed if the capture has no truth.
ExposureSets exposure_sets(const scenarios::Scenario& scenario, const PipelineChoice& choice,
                           std::uint64_t seed, RecordingSource& source, std::size_t count);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_RUN_EXPOSURE_SETS_H_

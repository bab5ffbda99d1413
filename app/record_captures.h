// A scenario recorded: every pipeline's capture of every seed into one recording folder.
//
// A capture that fails is left without an end, and the others are made all the same; what went
// wrong while one was made (RecordingCost::notes) is a warning and kept with it.
//
//   RecordingWriter writer("monday", {.backend = "sim", .scenario_json = scenario.resolved_json});
//   CapturesMade made;
//   record_captures(choices, *simulated_world(scenario), {.seeds = 3}, writer, made, progress);
#ifndef SIMBENCH_APP_RECORD_CAPTURES_H_
#define SIMBENCH_APP_RECORD_CAPTURES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "evaluation/run/pipeline_choice.h"
#include "recording/recording.h"
#include "recording/recording_folder.h"

namespace simbench::app {

struct CapturePlan {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;
};

struct CapturesMade {
  std::uint64_t recorded = 0;
  std::vector<std::string> warnings{};
};

// `made` is up to date also when this ends by an exception. Throws Interrupted (app/interrupt.h),
// what the source throws but RecordingFailed, and RecordingFolderError (a full disk). Progress
// counts captures.
void record_captures(const std::vector<evaluation::PipelineChoice>& choices,
                     RecordingSource& source, const CapturePlan& plan, RecordingWriter& writer,
                     CapturesMade& made, const evaluation::Progress& progress);

}  // namespace simbench::app

#endif  // SIMBENCH_APP_RECORD_CAPTURES_H_

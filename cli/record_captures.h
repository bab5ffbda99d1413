// Captures into a recording folder, whatever backend makes them.
//
// Every pipeline with every seed (on a real rig: repetition), each under its own host_sync.
// Progress and Ctrl-C are the command's usual ones; after Ctrl-C the folder holds what was recorded
// until then. A capture that cannot be made (RecordingFailed) is a warning and the next one goes
// on; what went wrong while one was made (RecordingCost::notes) is a warning and kept with it.
//
//   RecordingWriter writer("monday", {.backend = "sim", .scenario_json = scenario.resolved_json});
//   const auto source = app::interruptible(sim::make_simulation(scenario));
//   return record_captures(choices, *source, {.folder = "monday"}, writer);
#ifndef SIMBENCH_CLI_RECORD_CAPTURES_H_
#define SIMBENCH_CLI_RECORD_CAPTURES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/pipeline_choice.h"
#include "recording/recording.h"
#include "recording/recording_folder.h"

namespace simbench::cli {

struct RecordPlan {
  std::string folder;  // of the writer, for messages
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 1;
};

// The exit status: kOk, kInterrupted, or kBadInput if no capture could be made at all. `source`
// must end at the first Ctrl-C (app/interrupt.h). What the source throws but RecordingFailed
// passes through, and so does RecordingFolderError (a full disk).
int record_captures(const std::vector<evaluation::PipelineChoice>& choices, RecordingSource& source,
                    const RecordPlan& plan, RecordingWriter& writer);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_RECORD_CAPTURES_H_

// Pipelines whose host synchronisation is real programs: what they need of this machine.
//
// Programs are found before the run (bare names as the shell would, sim/programs/find_program.h),
// and so is the preloaded library (own_program.h). What is missing is one line, with what would
// help; the pipelines of algorithms go on.
//
//   use_programs({.log_folder = "logs"});  // before running anything
//   evaluation::evaluate(scenario, make_source, options, progress);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// In the environment: how many seconds a program may compute between two requests, for those who
// stop it in a debugger.
inline constexpr char kPatienceVariable[] = "SIMBENCH_PATIENCE_S";

struct ProgramFolders {
  // Where the hosts' folders stay, in PIPELINE/seed1/host0, with what the programs printed; empty:
  // nowhere.
  std::string log_folder{};
};

// The programs of a pipeline on the host of a node (hardware/node/node_programs.h), whose programs'
// network is on this interface; files stay in LOG_FOLDER/PIPELINE/host0. Throws
// scenarios::InputError for what cannot run here.
std::unique_ptr<HostSync> make_node_programs(const scenarios::Pipeline& pipeline,
                                             const std::string& interface,
                                             const ProgramFolders& options);

// What is to be known of how this machine runs a pipeline's programs, each one line: that root's
// are not nobody's (processes/lesser_user.h). Nothing of programs that cannot run.
std::vector<std::string> program_remarks(const scenarios::Pipeline& pipeline);

// Says how pipelines with programs run from here on (evaluation/run/pipeline_choice.h).
void use_programs(const ProgramFolders& options = {});

}  // namespace simbench::app

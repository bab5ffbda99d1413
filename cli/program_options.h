// The options of commands that run real programs on the simulated hosts: --program, --program-log.
//
//   ProgramOptions programs;
//   add_program_options(command, programs);
//   std::vector<std::string> pipelines = {"chrony"};
//   const scenarios::Scenario star = load_with_programs("6host_star", {}, programs, pipelines);
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "evaluation/run/ad_hoc_pipelines.h"
#include "scenarios/loader.h"
#include "scenarios/scenario.h"

namespace simbench::cli {

struct ProgramOptions {
  std::vector<std::string> programs;  // NAME=FILE.json, or the name of a built-in row
  std::string log_folder;
};

void add_program_options(Command& command, ProgramOptions& options);

// A change of a scenario for each of these programs, which adds its pipeline; they are added to
// `pipelines` if those are chosen. `first`: the scenario's first pipeline, which has what a FILE
// does not state of device_time and gathering. Throws scenarios::InputError.
std::vector<scenarios::Override> program_pipelines(const std::vector<std::string>& programs,
                                                   const scenarios::Pipeline& first,
                                                   std::vector<std::string>& pipelines);

// What is to be known of how this machine runs the programs of these pipelines (none: of all).
std::vector<std::string> program_remarks(const scenarios::Scenario& scenario,
                                         const std::vector<std::string>& pipelines);

// The scenario with a pipeline more for each of `pipelines` that is stated by its algorithms
// (evaluation/run/ad_hoc_pipelines.h) and for each program, as program_pipelines() has them. Throws
// scenarios::InputError.
scenarios::Scenario load_with_programs(const std::string& scenario,
                                       const std::vector<std::string>& sets,
                                       const ProgramOptions& options,
                                       std::vector<std::string>& pipelines,
                                       evaluation::AdHoc ad_hoc = evaluation::AdHoc::kAllStages);

}  // namespace simbench::cli

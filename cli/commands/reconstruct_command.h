// simbench reconstruct: what desynchronisation costs a 3D reconstruction, the paper's Table 4.
#ifndef SIMBENCH_CLI_COMMANDS_RECONSTRUCT_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_RECONSTRUCT_COMMAND_H_

#include "cli/options.h"
#include "reconstruction/experiment.h"

namespace simbench::cli {

// `arguments` is the command as given, for the folder's manifest and page, and for
// simbench-reconstruct, which this process becomes where `run` is null (like simbench-mpi:
// cli/mpi_launch.h).
void add_reconstruct_command(CLI::App& app, Action& action, std::vector<std::string> arguments,
                             reconstruction::RunReconstruction run);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_RECONSTRUCT_COMMAND_H_

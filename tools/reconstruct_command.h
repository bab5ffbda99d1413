// simbench reconstruct: what desynchronisation costs a 3D reconstruction, the paper's Table 4.
#ifndef SIMBENCH_TOOLS_RECONSTRUCT_COMMAND_H_
#define SIMBENCH_TOOLS_RECONSTRUCT_COMMAND_H_

#include "reconstruction/experiment.h"
#include "tools/options.h"

namespace simbench::tools {

// `arguments` is the command as given, for the folder's manifest and page, and for
// simbench-reconstruct, which this process becomes where `run` is null (like simbench-mpi:
// tools/mpi_launch.h).
void add_reconstruct_command(CLI::App& app, Action& action, std::vector<std::string> arguments,
                             reconstruction::RunReconstruction run);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_RECONSTRUCT_COMMAND_H_

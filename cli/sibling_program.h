// Programs that lie beside this one and are the same command line with more in it: simbench-mpi,
// simbench-reconstruct. So their libraries are needed, and loaded, by those who use them only.
#ifndef SIMBENCH_CLI_SIBLING_PROGRAM_H_
#define SIMBENCH_CLI_SIBLING_PROGRAM_H_

#include <filesystem>
#include <string>
#include <vector>

namespace simbench::cli {

std::filesystem::path sibling_program(const std::string& name);

// Goes on as that program, with these arguments (argv, its own name included), and returns only
// where it cannot be started: the error number that says why.
int become_sibling(const std::string& name, std::vector<std::string> arguments);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_SIBLING_PROGRAM_H_

// The `simbench` command as a function, so that a program with algorithms of its own is the same
// command: register them (algorithms/registry.h), then pass the arguments of main().
//
//   int main(int argc, char** argv) {
//     simbench::register_algorithm<simbench::DeviceTimeEntry>({...});
//     return simbench::run_command_line(argc, argv);
//   }
//
// Help and messages name the program by argv[0].
//
// Standard output carries the result and nothing else; messages go to standard error. Never throws;
// returns the exit status (cli/messages.h). One call per process: it handles SIGINT while it
// runs.
#pragma once

#include <string>

namespace simbench {

namespace evaluation {
class TaskFarm;
}
namespace reconstruction {
struct Reconstruction;
}

// Optional parts that only some programs are built with.
struct CommandLineExtras {
  // Works on the runs of `simbench sweep`; null: the cores of this machine, and under mpirun
  // simbench-mpi in place of this program.
  evaluation::TaskFarm* farm = nullptr;
  // For `simbench reconstruct` (reconstruction/experiment.h); null: simbench-reconstruct in place
  // of this program.
  const reconstruction::Reconstruction* reconstruction = nullptr;
  // For `--python FILE`: registers the algorithms of that file; throws scenarios::InputError. Null:
  // the Python package simbench in place of this program (python/).
  void (*import_algorithms)(const std::string& file) = nullptr;
};

int run_command_line(int argc, char** argv, const CommandLineExtras& extras = {});

}  // namespace simbench

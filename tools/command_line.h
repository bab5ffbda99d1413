// The `simbench` command as a function, so that a program with algorithms of its own is the same
// command: register them (algorithms/registry.h), then hand over the arguments of main().
//
//   int main(int argc, char** argv) {
//     simbench::register_device_time({...});
//     return simbench::run_command_line(argc, argv);
//   }
//
// Standard output carries the result and nothing else; messages go to standard error. Never throws;
// returns the exit status (tools/exit_status.h). One call per process: it handles SIGINT while it
// runs.
#ifndef SIMBENCH_TOOLS_COMMAND_LINE_H_
#define SIMBENCH_TOOLS_COMMAND_LINE_H_

namespace simbench {

namespace evaluation {
class TaskFarm;
}

// `farm` works on the runs of `simbench sweep`; null: the cores of this machine, and under mpirun
// simbench-mpi in place of this program.
int run_command_line(int argc, char** argv, evaluation::TaskFarm* farm = nullptr);

}  // namespace simbench

#endif  // SIMBENCH_TOOLS_COMMAND_LINE_H_

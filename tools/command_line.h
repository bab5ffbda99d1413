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

int run_command_line(int argc, char** argv);

}  // namespace simbench

#endif  // SIMBENCH_TOOLS_COMMAND_LINE_H_

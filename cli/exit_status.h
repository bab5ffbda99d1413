// What the command's exit status means; part of its interface, scripts rely on it.
#ifndef SIMBENCH_CLI_EXIT_STATUS_H_
#define SIMBENCH_CLI_EXIT_STATUS_H_

namespace simbench::cli {

enum ExitStatus : int {
  kOk = 0,
  kInternalError = 1,
  kBadInput = 2,  // of the command line, of a file, of an output folder
  kGateFailed = 3,
  kBaselineMissing = 4,
  kInterrupted = 130,
};

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_EXIT_STATUS_H_

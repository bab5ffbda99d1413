// simbench-reconstruct: the command line with Embree and Open3D in it, which `simbench reconstruct`
// becomes. Its libraries are needed by those who use it only.
#include "cli/command_line.h"
#include "cli/process.h"
#include "reconstruction/experiment.h"

int main(int argc, char** argv) {
  simbench::cli::keep_freed_memory();
  return simbench::run_command_line(
      argc, argv, {.run_reconstruction = &simbench::reconstruction::run_reconstruction});
}

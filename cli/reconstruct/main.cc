// simbench-reconstruct: the command line with Embree and Open3D, as which `simbench reconstruct`
// goes on. Only its users need these libraries.
#include "cli/command_line.h"
#include "cli/process.h"
#include "reconstruction/experiment.h"

int main(int argc, char** argv) {
  simbench::cli::keep_freed_memory();
  const simbench::reconstruction::Reconstruction reconstruction{
      &simbench::reconstruction::run_reconstruction};
  return simbench::run_command_line(argc, argv, {.reconstruction = &reconstruction});
}

// simbench-reconstruct: the command line with Embree and Open3D in it, which `simbench reconstruct`
// becomes. Its libraries are needed by those who use it only.
#include "reconstruction/experiment.h"
#include "tools/command_line.h"
#include "tools/freed_memory.h"

int main(int argc, char** argv) {
  simbench::tools::keep_freed_memory();
  return simbench::run_command_line(
      argc, argv, {.run_reconstruction = &simbench::reconstruction::run_reconstruction});
}

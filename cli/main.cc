#include "cli/command_line.h"
#include "cli/process.h"

int main(int argc, char** argv) {
  simbench::cli::keep_freed_memory();
  return simbench::run_command_line(argc, argv);
}

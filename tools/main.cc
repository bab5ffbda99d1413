#include "tools/command_line.h"
#include "tools/freed_memory.h"

int main(int argc, char** argv) {
  simbench::tools::keep_freed_memory();
  return simbench::run_command_line(argc, argv);
}

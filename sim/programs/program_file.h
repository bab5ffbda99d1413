// Whether a file is a program that the preloaded library can reach.
//
// The library gets into programs that load libraries as they start, of this machine's architecture
// and C library. What it cannot reach is refused before a run:
//
//   static programs         they load no libraries
//   Go                      calls the kernel without libc, also where it loads libraries
//   set-uid, set-gid, file capabilities: the loader then ignores preloaded libraries
//   other architectures, other C libraries than glibc, what is no program
//
// A script is run by its interpreter, which is what is looked at: program_command() returns the
// interpreter, its argument and the script. `#!/usr/bin/env python3` is looked up as
// find_program() does (sim/programs/find_program.h), since env would have to start another program.
//
// Go is recognised by the sections that its linker writes; a program from which these were taken
// is found out as it runs (processes/confinement.h).
//
// Errors: ProgramError, one line that begins with the file's name.
//
//   const std::vector<std::string> words = program_command("/srv/daemon.py");
//   print(words[0]);  // "/usr/bin/python3"
//
// Source: elf(5), execve(2), ld.so(8).
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace simbench::sim {

class ProgramError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The words that stand for an absolute path at the beginning of a command: itself, or its
// interpreter and it.
std::vector<std::string> program_command(const std::string& path);

}  // namespace simbench::sim

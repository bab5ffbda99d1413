// How this program is started again, and where the library is that is preloaded into real programs.
//
// A program finds both by its own file. One that is a module of an interpreter says so, once and
// before anything runs.
//
//   set_own_program({.words = {"/usr/bin/python3", "-m", "simbench"}, .library_folder = "/opt"});
#pragma once

#include <string>
#include <vector>

namespace simbench::app {

struct OwnProgram {
  // A path, and what comes before the arguments.
  std::vector<std::string> words = {"/proc/self/exe"};
  // Empty: ../lib or ../lib/simbench, from the program's own folder.
  std::string library_folder{};
};

void set_own_program(OwnProgram program);
const OwnProgram& own_program();

}  // namespace simbench::app

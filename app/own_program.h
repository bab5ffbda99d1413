// How this program is started again, and where the library is that is preloaded into real programs.
//
// A program finds both by its own file. One that is a module of an interpreter says so, once and
// before anything runs.
//
//   set_own_program({.path = "/usr/bin/python3", .leading = {"-m", "simbench"},
//                    .library_folder = "/opt"});
#pragma once

#include <string>
#include <vector>

namespace simbench::app {

struct OwnProgram {
  std::string path = "/proc/self/exe";
  std::vector<std::string> leading{};  // words before the arguments, as an interpreter needs them
  // Empty: ../lib or ../lib/simbench, from the program's own folder.
  std::string library_folder{};
};

void set_own_program(OwnProgram program);
const OwnProgram& own_program();

}  // namespace simbench::app

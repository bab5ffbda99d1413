// Where a program is, by the first word of a command.
//
// A word with a slash is an absolute path. A bare name is looked for in these folders, in order:
//
//   those of the environment variable SIMBENCH_PROGRAMS (absolute, separated by colons)
//   usr/local/sbin ... lib/systemd of the folder of unpacked packages, if there is one, and of its
//   folder apart/NAME
//   /usr/local/sbin, /usr/local/bin, /usr/sbin, /usr/bin, /sbin, /bin, /lib/systemd
//
// PATH is not among them: a run is to be the same for whoever starts it. The program is then looked
// at (sim/programs/program_file.h).
//
// Errors: ProgramError, one line; for programs that are known it names their Debian package.
//
//   const FoundProgram chronyd = find_program("chronyd", "/opt/packages");
//   print(chronyd.words[0]);  // "/opt/packages/usr/sbin/chronyd"
#pragma once

#include <string>
#include <vector>

namespace simbench::sim {

struct FoundProgram {
  std::vector<std::string> words;  // in place of the command's first one
  std::string library_path;        // for LD_LIBRARY_PATH; empty: none
};

inline constexpr char kProgramsVariable[] = "SIMBENCH_PROGRAMS";

// The file's path; the file is not looked at. `packages` is the root of unpacked packages ("":
// none).
std::string program_path(const std::string& word, const std::string& packages = "");

FoundProgram find_program(const std::string& word, const std::string& packages = "");

}  // namespace simbench::sim

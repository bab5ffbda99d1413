// Completion of simbench's command lines in a shell, as a script of that shell's own.
//
// Commands, options and fixed words are in the script; names of scenarios are asked for when they
// are wanted (`simbench list scenarios --format names`), so that a scenario needs no new script.
// Whatever else has a value gets files, or folders, or nothing (numbers). `simbench --scenario S`
// is completed as `simbench run --scenario S`.
#ifndef SIMBENCH_CLI_COMPLETION_H_
#define SIMBENCH_CLI_COMPLETION_H_

#include <string>

#include "cli/command_table.h"

namespace simbench::cli {

std::string bash_completion(const CommandTable& table);
std::string zsh_completion(const CommandTable& table);
std::string fish_completion(const CommandTable& table);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMPLETION_H_

// Man pages, from the same table that the parser is: troff with the man(7) macros, section 1.
//
//   simbench manual run | man -l -
//
// A footer of a command is divided: what begins with "Example" becomes EXAMPLES, what begins with
// "Exit status:" EXIT STATUS, the rest part of the DESCRIPTION.
#ifndef SIMBENCH_CLI_MANUAL_H_
#define SIMBENCH_CLI_MANUAL_H_

#include <string>

#include "cli/command_table.h"

namespace simbench::cli {

// The page of simbench itself, which lists the commands; simbench(1).
std::string manual_page(const CommandTable& table);

// The page of one of table.commands; simbench-NAME(1).
std::string manual_page(const CommandTable& table, const CommandEntry& command);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_MANUAL_H_

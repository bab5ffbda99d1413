// What this program is called in texts that tell its user to run it again. A program of a user's
// own (cli/command_line.h) has another name than the texts of this one.
//
//   set_program_name("my_bench");                     // run_command_line() does
//   in_this_program("see `simbench list`");           // "see `my_bench list`"
#pragma once

#include <string>

namespace simbench::reports {

// "simbench" until it is set. Not while another thread prints.
void set_program_name(const std::string& name);
const std::string& program_name();

// `text` with the program's name in each command that it cites: where "simbench " begins the text
// or a line, or follows a backquote or two blanks.
std::string in_this_program(const std::string& text);

}  // namespace simbench::reports

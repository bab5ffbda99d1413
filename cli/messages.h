// What a command says beside its result, on standard error: as text for people, or, with --json, as
// JSON lines for scripts. One object a line:
//
//   {"event":"warning","text":"..."}      also "note"
//   {"event":"error","text":"...","next":"simbench run --help"}    "next" where it is known
//   {"event":"start","unit":"runs"}       and "progress", "end", "interrupt": see cli/progress.h
//
// Text: "warning: ...", "note: ...", "error: ...\nSee: ...".
//
// Not thread-safe, and one setting for the process: so is standard error.
#ifndef SIMBENCH_CLI_MESSAGES_H_
#define SIMBENCH_CLI_MESSAGES_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace simbench::cli {

// True once the arguments of the command line have --json (before any "--"): so that also a message
// about the arguments themselves is JSON.
void choose_message_format(const std::vector<std::string>& arguments);
bool messages_are_json();

void print_warnings(const std::vector<std::string>& warnings);
void print_note(const std::string& text);
// `next`: the command that tells more, if there is one.
void print_error(const std::string& text, const std::string& next = "");

// An error that is the program's own: the event is "internal error".
void print_internal_error(const std::string& text);

// The event as a line of JSON, ended by '\n'. Bytes that are no UTF-8 are replaced.
std::string event_line(const nlohmann::ordered_json& event);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_MESSAGES_H_

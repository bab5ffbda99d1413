// The output of a command: the result on standard output, the exit status, and everything else on
// standard error, as text for people or, with --json, as JSON lines for scripts. One object a line:
//
//   {"event":"warning","text":"..."}      also "note"
//   {"event":"error","text":"...","next":"simbench run --help"}    "next" where it is known
//   {"event":"start","unit":"runs"}       and "progress", "end", "interrupt": see cli/progress.h
//
// Text: "warning: ...", "note: ...", "error: ...\nSee: ...".
//
// Commands in texts ("see `simbench list`") name the running program
// (reports/text/program_name.h).
//
// Not thread-safe; one setting for the process.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace simbench::cli {

// The exit statuses, part of the command's interface: scripts rely on them.
enum ExitStatus : int {
  kOk = 0,
  kInternalError = 1,
  kBadInput = 2,  // of the command line, of a file, of an output folder
  kGateFailed = 3,
  kBaselineMissing = 4,
  kProgramFailed = 5,  // a pipeline of real programs, in every seed; there are results all the same
  kInterrupted = 130,
};

// Writes the result to standard output. Throws reports::OutputError if that fails (a full disk, a
// closed descriptor).
void print_result(const std::string& text);

// Writes the result in this format, of which `text_in` makes the text. A program around the command
// line (cli/embedding.h) gets it in all formats that it wants: those of --format, and "html", a
// part of a page, where the result is a reports::Document.
void print_result_in(const std::string& format,
                     const std::function<std::string(const std::string& format)>& text_in);

// The stream of print_result(), for results that are not to be in memory as a text: standard
// output, or the kept output of an embedded command. Whoever writes to it checks it.
std::ostream& result_stream();

// Chooses JSON if the arguments have --json (before any "--"), so that also messages about the
// arguments are JSON.
void choose_message_format(const std::vector<std::string>& arguments);
bool messages_are_json();

void print_warnings(const std::vector<std::string>& warnings);
void print_note(const std::string& text);
// `next`: the command that explains more, if there is one.
void print_error(const std::string& text, const std::string& next = "");

// An error of the program itself: the event is "internal error".
void print_internal_error(const std::string& text);

// The event as a line of JSON with its '\n'. Bytes that are no UTF-8 are replaced.
std::string event_line(const nlohmann::ordered_json& event);

// The width of text on standard output, in columns: COLUMNS if it is a number of at least
// kNarrowest, else the terminal's width, also where it goes through a pipe (`simbench run | less`)
// and standard error is the terminal; std::nullopt (no limit) for a file, and for a pipe of a
// script whose standard error is none.
inline constexpr std::size_t kNarrowest = 20;
std::optional<std::size_t> width_of_output();

// Whether a terminal takes escape sequences: TERM is set and not "dumb".
bool takes_escapes();

// Whether colour is wanted: neither NO_COLOR (no-color.org) nor CLICOLOR=0 (bixense.com/clicolors).
bool wants_colour();

// Whether standard output is a terminal that is to show colour.
bool colours_output();

}  // namespace simbench::cli

// The command line as a part of another program, such as the Python package: a command without the
// process.
//
// What a command would write to standard output and standard error is kept here, its progress goes
// to a callback, and nothing is done that belongs to the owner of a process: signals keep their
// handlers (to interrupt, app::InterruptHandler::set(true)), work that goes on after an
// interruption is waited for, and no other program takes the place of this one. What a command
// refuses is thrown: scenarios::InputError and the others of app/bad_input.h.
//
// A result may be wanted in more formats than one, which are made of the same work.
//
//   Embedding within;
//   within.formats = {"json", "table"};
//   const int status = run_embedded({"simbench", "gate", "now", "--baseline", "b.json"}, within);
//   if (status == kOk) use(within.results["json"], within.results["table"]);
//
// One at a time for the process: messages, the width of a page and the interruption are its own.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "evaluation/run/evaluate.h"

namespace simbench::cli {

struct EmbeddedMessage {
  std::string kind{};  // "warning", "note", "error"
  std::string text{};
};

struct Embedding {
  // What is wanted.
  std::vector<std::string> formats{};    // those of print_result_in() (cli/messages.h)
  std::optional<std::size_t> columns{};  // the width of text; nothing: as wide as it is
  evaluation::Progress progress{};       // told how far the work is; may be empty

  // What the command gave.
  std::map<std::string, std::string> results{};  // of a command with print_result_in(), by format
  std::ostringstream output{};                   // what would be on standard output
  std::vector<EmbeddedMessage> messages{};       // in order
};

// What the running command is a part of; null: it has the process.
Embedding* embedding();

// While it lives, the command that runs is a part of `within`.
class EmbeddingScope {
 public:
  explicit EmbeddingScope(Embedding& within);
  ~EmbeddingScope();
  EmbeddingScope(const EmbeddingScope&) = delete;
  EmbeddingScope& operator=(const EmbeddingScope&) = delete;
};

// Runs a command line (argv, with the program's name) and returns its exit status
// (cli/messages.h). Throws what a command throws.
int run_embedded(const std::vector<std::string>& arguments, Embedding& within,
                 const CommandLineExtras& extras = {});

}  // namespace simbench::cli

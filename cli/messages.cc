#include "cli/messages.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "cli/embedding.h"
#include "recording/number_in.h"
#include "recording/text_fields.h"
#include "reports/text/output_file.h"
#include "reports/text/plain_text.h"
#include "reports/text/program_name.h"

namespace simbench::cli {
namespace {

using Json = nlohmann::ordered_json;

bool json_messages = false;

void print_line(const char* kind, const std::string& words) {
  const std::string text = reports::in_this_program(words);
  if (Embedding* const within = embedding()) {
    within->messages.push_back({kind, text});
  } else if (json_messages) {
    std::cerr << event_line({{"event", kind}, {"text", text}}) << std::flush;
  } else {
    // It may name a file or a camera, whose name may hold anything.
    std::cerr << kind << ": " << printable_lines(text) << '\n';
  }
}

std::optional<std::size_t> terminal_width(int descriptor) {
  winsize size = {};
  if (ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return std::nullopt;
  return std::max<std::size_t>(size.ws_col, kNarrowest);
}

bool is_pipe(int descriptor) {
  struct stat status = {};
  return fstat(descriptor, &status) == 0 && S_ISFIFO(status.st_mode);
}

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

void print_result(const std::string& text) {
  errno = 0;
  std::ostream& out = result_stream();
  out << reports::printable_page(text) << std::flush;
  if (!out) {
    throw reports::OutputError(
        fmt::format("standard output: cannot be written: {}", reports::system_reason()));
  }
}

void print_result_in(const std::string& format,
                     const std::function<std::string(const std::string& format)>& text_in) {
  Embedding* const within = embedding();
  if (within == nullptr) return print_result(text_in(format));
  for (const std::string& wanted : within->formats) {
    within->results[wanted] = reports::printable_page(text_in(wanted));
  }
}

std::ostream& result_stream() {
  if (Embedding* const within = embedding()) return within->output;
  return std::cout;
}

void choose_message_format(const std::vector<std::string>& arguments) {
  const auto end = std::find(arguments.begin(), arguments.end(), "--");
  json_messages = std::find(arguments.begin(), end, "--json") != end;
}

bool messages_are_json() { return json_messages; }

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_line("warning", warning);
}

void print_note(const std::string& text) { print_line("note", text); }

void print_error(const std::string& words, const std::string& next_command) {
  if (next_command.empty() || embedding() != nullptr) return print_line("error", words);
  const std::string text = reports::in_this_program(words);
  const std::string next = reports::in_this_program(next_command);
  if (json_messages) {
    std::cerr << event_line({{"event", "error"}, {"text", text}, {"next", next}}) << std::flush;
  } else {
    std::cerr << "error: " << printable_lines(text) << "\nSee: " << next << '\n';
  }
}

void print_internal_error(const std::string& text) { print_line("internal error", text); }

std::string event_line(const Json& event) {
  return printable_json(event.dump(-1, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::optional<std::size_t> width_of_output() {
  const auto columns = number_in<std::size_t>(variable("COLUMNS"));
  if (columns && *columns >= kNarrowest) return columns;
  if (const auto own = terminal_width(STDOUT_FILENO)) return own;
  return is_pipe(STDOUT_FILENO) ? terminal_width(STDERR_FILENO) : std::nullopt;
}

bool takes_escapes() {
  const std::string_view term = variable("TERM");
  return !term.empty() && term != "dumb";
}

bool colours_output() { return isatty(STDOUT_FILENO) != 0 && takes_escapes() && wants_colour(); }

bool wants_colour() { return variable("NO_COLOR").empty() && variable("CLICOLOR") != "0"; }

}  // namespace simbench::cli

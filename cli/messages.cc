#include "cli/messages.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

namespace simbench::cli {
namespace {

using Json = nlohmann::ordered_json;

bool json_messages = false;

void print_line(const char* kind, const std::string& text) {
  if (json_messages) {
    std::cerr << event_line({{"event", kind}, {"text", text}}) << std::flush;
  } else {
    std::cerr << kind << ": " << text << '\n';
  }
}

}  // namespace

void choose_message_format(const std::vector<std::string>& arguments) {
  const auto end = std::find(arguments.begin(), arguments.end(), "--");
  json_messages = std::find(arguments.begin(), end, "--json") != end;
}

bool messages_are_json() { return json_messages; }

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_line("warning", warning);
}

void print_note(const std::string& text) { print_line("note", text); }

void print_error(const std::string& text, const std::string& next) {
  if (next.empty()) {
    print_line("error", text);
  } else if (json_messages) {
    std::cerr << event_line({{"event", "error"}, {"text", text}, {"next", next}}) << std::flush;
  } else {
    std::cerr << "error: " << text << "\nSee: " << next << '\n';
  }
}

void print_internal_error(const std::string& text) { print_line("internal error", text); }

std::string event_line(const Json& event) {
  return event.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace simbench::cli

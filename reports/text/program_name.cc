#include "reports/text/program_name.h"

#include <string_view>

namespace simbench::reports {
namespace {

constexpr std::string_view kCited = "simbench ";

std::string& name_of_program() {
  static std::string name = "simbench";
  return name;
}

bool begins_command(std::string_view before) {
  return before.empty() || before.ends_with('\n') || before.ends_with('`') ||
         before.ends_with("  ") || before.ends_with("<(") || before == "Usage: " ||
         before.ends_with("\nUsage: ");
}

}  // namespace

void set_program_name(const std::string& name) { name_of_program() = name; }

const std::string& program_name() { return name_of_program(); }

std::string in_this_program(const std::string& text) {
  std::string named;
  std::size_t done = 0;
  for (std::size_t at = text.find(kCited); at != std::string::npos;
       at = text.find(kCited, at + kCited.size())) {
    if (!begins_command(std::string_view{text}.substr(0, at))) continue;
    named.append(text, done, at - done).append(program_name()).append(" ");
    done = at + kCited.size();
  }
  return named + text.substr(done);
}

}  // namespace simbench::reports

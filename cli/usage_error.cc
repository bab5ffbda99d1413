#include "cli/usage_error.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/command_table.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

std::string suggestion(const std::string& found, const std::vector<std::string>& known) {
  const std::vector<std::string> similar = scenarios::nearest(found, known);
  return similar.empty() ? "" : fmt::format(" did you mean {}?", fmt::join(similar, " or "));
}

std::vector<std::string> names_of(const std::vector<OptionEntry>& options) {
  std::vector<std::string> names;
  names.reserve(options.size());
  for (const OptionEntry& option : options) names.push_back(option.names.back());
  return names;
}

// The entry of the command that was parsed, else of simbench.
CommandEntry used_command(CLI::App& app) {
  const CommandTable table = command_table(app);
  const std::vector<CLI::App*> used = app.get_subcommands();
  for (const CommandEntry& command : table.commands) {
    if (!used.empty() && command.name == used.front()->get_name()) return command;
  }
  return table.program;
}

std::string called(const CommandEntry& command) {
  return command.name.empty() ? "simbench" : "simbench " + command.name;
}

std::string unexpected(const CommandEntry& command, const std::string& found) {
  if (!found.starts_with("-")) {
    return fmt::format(
        "found '{}', but `{}` takes {}", found, called(command),
        command.arguments.empty()
            ? "options only"
            : fmt::format("no more than {}", fmt::join(names_of(command.arguments), " ")));
  }
  // "--seed=3" is the option "--seed".
  const std::string name = found.substr(0, found.find('='));
  const std::vector<std::string> known = names_of(command.options);
  const std::string similar = suggestion(name, known);
  return fmt::format("found '{}', which `{}` does not know;{} allowed: {}", name, called(command),
                     similar, fmt::join(known, ", "));
}

// CLI11 says "--scenario is required".
std::string missing(const CommandEntry& command, const std::string& text) {
  for (const std::vector<OptionEntry>* entries : {&command.options, &command.arguments}) {
    for (const OptionEntry& entry : *entries) {
      if (!entry.required || entry.value != ValueKind::kScenario) continue;
      return text + ": a scenario's name (see `simbench list`) or file";
    }
  }
  return text;
}

}  // namespace

std::optional<std::string> unknown_command(CLI::App& app,
                                           const std::vector<std::string>& arguments) {
  std::vector<std::string> known;
  for (const CommandEntry& command : command_table(app).commands) known.push_back(command.name);
  if (arguments.size() < 2) {
    return fmt::format("a command is required, allowed: {}", fmt::join(known, ", "));
  }
  const std::string& found = arguments[1];
  if (found.starts_with("-")) return std::nullopt;
  if (std::find(known.begin(), known.end(), found) != known.end()) return std::nullopt;
  return fmt::format("found '{}',{} allowed: {}", found, suggestion(found, known),
                     fmt::join(known, ", "));
}

std::string usage_error(CLI::App& app, const CLI::ParseError& error) {
  const CommandEntry command = used_command(app);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    const std::vector<std::string> extras = app.remaining(true);
    if (!extras.empty()) return unexpected(command, extras.front());
  }
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
    return missing(command, error.what());
  }
  return error.what();
}

}  // namespace simbench::cli

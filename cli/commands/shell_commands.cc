#include "cli/commands/shell_commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <vector>

#include "cli/command_table.h"
#include "cli/completion.h"
#include "cli/exit_status.h"
#include "cli/manual.h"

namespace simbench::cli {
namespace {

constexpr const char* kCompletionExamples = R"(
`cmake --install` puts the scripts where the shells look for them. Without it:

Examples:
  source <(simbench completion bash)                                  in ~/.bashrc
  simbench completion zsh > ~/.zfunc/_simbench                        a folder of $fpath
  simbench completion fish > ~/.config/fish/completions/simbench.fish)";

constexpr const char* kManualExamples = R"(
`cmake --install` puts the pages where man(1) looks for them. Without it:

Examples:
  simbench manual | man -l -
  simbench manual run | man -l -
  simbench manual --names                  the commands that have a page, one a line)";

std::string script(CLI::App& app, const std::string& shell) {
  const CommandTable table = command_table(app);
  if (shell == "bash") return bash_completion(table);
  if (shell == "zsh") return zsh_completion(table);
  return fish_completion(table);
}

std::vector<std::string> names_of(CLI::App& app) {
  std::vector<std::string> names;
  for (const CommandEntry& command : command_table(app).commands) names.push_back(command.name);
  return names;
}

std::string page(const CommandTable& table, const std::string& name) {
  for (const CommandEntry& command : table.commands) {
    if (command.name == name) return manual_page(table, command);
  }
  return manual_page(table);
}

struct ManualOptions {
  std::string command;
  bool names = false;
};

}  // namespace

void add_completion_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("completion", "Print a script that completes command lines in a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "One of: bash, zsh, fish")
      ->type_name("SHELL")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}));
  command->footer(kCompletionExamples);
  command->callback([shell, &app, &action] {
    action = [shell, &app] {
      print_result(script(app, *shell));
      return static_cast<int>(kOk);
    };
  });
}

void add_manual_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("manual", "Print the man page of simbench or of a command");
  auto options = std::make_shared<ManualOptions>();
  command->add_option("command", options->command, "The command. Default: simbench itself")
      ->type_name("COMMAND")
      ->check(one_of(names_of(app)));
  command->add_flag("--names", options->names, "Instead of a page, the names that have one");
  command->footer(kManualExamples);
  command->callback([options, &app, &action] {
    action = [options, &app] {
      print_result(options->names ? fmt::format("{}\n", fmt::join(names_of(app), "\n"))
                                  : page(command_table(app), options->command));
      return static_cast<int>(kOk);
    };
  });
}

}  // namespace simbench::cli

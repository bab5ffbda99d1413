#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/command_table.h"
#include "cli/commands/commands.h"
#include "cli/help.h"

namespace simbench::cli {
namespace {

constexpr const char* kHelpExamples = R"(
Examples:
  simbench help
  simbench help run                                                   as simbench run --help)";

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
  simbench manual --names                  the commands with a page, one a line)";

std::string script(CLI::App& app, const std::string& shell) {
  const CommandTable table = command_table(app);
  if (shell == "bash") return bash_completion(table);
  if (shell == "zsh") return zsh_completion(table);
  return fish_completion(table);
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

void add_help_command(CommandLine& line) {
  auto name = std::make_shared<std::string>();
  Command command(line, "help", "Print the help of simbench or of a command");
  command.text("command", "COMMAND", *name, "The command. Default: simbench itself");
  command.footer(kHelpExamples);
  command.runs([name, &app = line.parser]() -> int {
    if (!name->empty() && !is_command(app, *name)) {
      print_error(unknown_command(app, *name), "simbench help");
      return kBadInput;
    }
    print_result(help_text(app, *name));
    return kOk;
  });
}

void add_completion_command(CommandLine& line) {
  auto shell = std::make_shared<std::string>();
  Command command(line, "completion", "Print a script that completes command lines in a shell");
  command.word("shell", "SHELL", *shell, {"bash", "zsh", "fish"}, "One of: bash, zsh, fish")
      .required();
  command.footer(kCompletionExamples);
  command.runs([shell, &app = line.parser] {
    print_result(script(app, *shell));
    return kOk;
  });
}

void add_manual_command(CommandLine& line) {
  auto options = std::make_shared<ManualOptions>();
  Command command(line, "manual", "Print the man page of simbench or of a command");
  command.word("command", "COMMAND", options->command, command_names(line.parser),
               "The command. Default: simbench itself");
  command.flag("--names", options->names, "Instead of a page, print the commands that have one");
  command.footer(kManualExamples);
  command.runs([options, &app = line.parser] {
    print_result(options->names ? fmt::format("{}\n", fmt::join(command_names(app), "\n"))
                                : page(command_table(app), options->command));
    return kOk;
  });
}

}  // namespace simbench::cli

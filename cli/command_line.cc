#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/bad_input.h"
#include "app/program_pipelines.h"
#include "cli/command.h"
#include "cli/command_table.h"
#include "cli/commands/commands.h"
#include "cli/embedding.h"
#include "cli/help.h"
#include "cli/process.h"
#include "recording/version.h"
#include "reports/text/plain_text.h"
#include "reports/text/program_name.h"
#include "scenarios/loader.h"

namespace simbench {
namespace {

using cli::ExitStatus;

constexpr const char* kProgramExamples = R"(
Start here:
  simbench 18cam_6host_45fps      a scenario: `simbench run --scenario ...`
  simbench list                   scenarios and algorithms
  simbench help run               options, with examples: `simbench run --help`

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 3 gate failed, 4 baseline missing,
5 a program of yours failed in every seed, 130 interrupted.)";

bool names_scenario(const std::string& word) {
  if (word.ends_with(".json")) return true;
  return std::ranges::count(scenarios::builtin_scenarios(), word,
                            &scenarios::BuiltinScenario::name) > 0;
}

// Whether the command takes a scenario by its option alone.
bool has_scenario_option(const CLI::App& command) {
  const std::vector<const CLI::Option*> options = command.get_options({});
  return command.get_option_no_throw("--scenario") != nullptr &&
         std::ranges::none_of(options, &CLI::Option::get_positional);
}

// `simbench --scenario S` and `simbench S` mean `simbench run --scenario S`, and `simbench trace S`
// means `simbench trace --scenario S`. There is a first word.
std::vector<std::string> with_implied_words(CLI::App& app, std::vector<std::string> arguments) {
  const std::string first = arguments[1];
  if (first.starts_with("-")) {
    const bool about_simbench = first == "-h" || first == "--help" || first == "--version";
    if (!about_simbench) arguments.insert(arguments.begin() + 1, cli::kDefaultCommand);
    return arguments;
  }
  if (!cli::is_command(app, first)) {
    if (names_scenario(first)) {
      arguments.insert(arguments.begin() + 1, {cli::kDefaultCommand, "--scenario"});
    }
    return arguments;
  }
  if (arguments.size() > 2 && names_scenario(arguments[2]) &&
      std::ranges::count(arguments, "--scenario") == 0 &&
      has_scenario_option(*app.get_subcommand(first))) {
    arguments.insert(arguments.begin() + 2, "--scenario");
  }
  return arguments;
}

// CLI11's own exit() would choose the status and the stream.
int explain(CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    // A request for help or the version, not an error.
    cli::print_result(error.get_name() == "CallForVersion" ? std::string(error.what()) + "\n"
                                                           : app.help());
    return ExitStatus::kOk;
  }
  if (cli::embedding() != nullptr) throw scenarios::InputError(cli::usage_error(app, error));
  const auto used = app.get_subcommands();
  cli::print_error(
      cli::usage_error(app, error),
      used.empty() ? "simbench --help" : fmt::format("simbench {} --help", used[0]->get_name()));
  return ExitStatus::kBadInput;
}

struct CommandGroup {
  const char* heading;
  std::vector<void (*)(cli::CommandLine&)> commands;
};

// All commands, as the help lists them.
const std::vector<CommandGroup>& command_groups() {
  static const std::vector<CommandGroup> groups = {
      {"Run",
       {cli::add_run_command, cli::add_sweep_command, cli::add_clocks_command,
        cli::add_reconstruct_command, cli::add_paper_command, cli::add_advise_command}},
      {"Look at results",
       {cli::add_explore_command, cli::add_report_command, cli::add_trace_command,
        cli::add_figure_command}},
      {"Compare results", {cli::add_compare_command, cli::add_gate_command}},
      {"Recordings",
       {cli::add_inspect_command, cli::add_record_command, cli::add_replay_command,
        cli::add_diagnose_command, cli::add_watch_command, cli::add_certify_command,
        cli::add_export_command, cli::add_stability_command, cli::add_fit_command,
        cli::add_convert_ibl_command}},
      {"Real rigs",
       {cli::add_keygen_command, cli::add_node_command, cli::add_validate_model_command,
        cli::add_reality_command, cli::add_relay_command}},
      {"Scenarios and algorithms",
       {cli::add_list_command, cli::add_describe_command, cli::add_validate_command,
        cli::add_code_command}},
      // Last: `manual` lists the commands before it.
      {"The command line itself",
       {cli::add_help_command, cli::add_completion_command, cli::add_manual_command}}};
  return groups;
}

int parse_and_run(const std::vector<std::string>& arguments, const CommandLineExtras& extras) {
  CLI::App app(cli::kProgramSummary);
  app.name(reports::program_name());
  app.set_version_flag("--version", fmt::format("simbench {} ({})", version(), commit()));
  app.require_subcommand(1);
  app.footer(kProgramExamples);
  cli::format_help(app);
  cli::CommandLine line{.parser = app, .arguments = arguments, .extras = extras};
  for (const CommandGroup& group : command_groups()) {
    for (const auto add : group.commands) add(line);
    cli::group_commands(app, group.heading);
  }

  if (arguments.size() < 2) {
    cli::print_result(cli::start_page());
    return ExitStatus::kOk;
  }
  const std::vector<std::string> all = with_implied_words(app, arguments);
  if (!all[1].starts_with("-") && !cli::is_command(app, all[1])) {
    cli::print_error(cli::unknown_command(app, all[1]), "simbench help");
    return ExitStatus::kBadInput;
  }
  // CLI11 takes the arguments last first, without the program's name.
  std::vector<std::string> reversed(all.rbegin(), all.rend() - 1);
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  }
  return line.action();
}

}  // namespace

namespace cli {

int run_embedded(const std::vector<std::string>& arguments, Embedding& within,
                 const CommandLineExtras& extras) {
  const EmbeddingScope scope(within);
  const reports::FilePage page;
  reports::set_page_width(within.columns);
  app::use_programs();
  return parse_and_run(arguments, extras);
}

}  // namespace cli

int run_command_line(int argc, char** argv, const CommandLineExtras& extras) {
  const std::vector<std::string> arguments(argv, argv + argc);
  cli::hold_standard_descriptors();
  cli::choose_message_format(arguments);
  reports::set_page_width(cli::width_of_output());
  reports::set_page_colour(cli::colours_output());
  if (argc > 0) {
    reports::set_program_name(std::filesystem::path(arguments[0]).filename().string());
  }
  app::use_programs();
  try {
    if (extras.farm == nullptr) cli::become_mpi_program(arguments);
    return parse_and_run(arguments, extras);
  } catch (const std::exception& error) {
    if (const std::optional<std::string> text = app::bad_input(error)) {
      cli::print_error(*text);
      return ExitStatus::kBadInput;
    }
    cli::print_internal_error(
        fmt::format("{}\n(simbench {}, commit {})", error.what(), version(), commit()));
    return ExitStatus::kInternalError;
  }
}

}  // namespace simbench

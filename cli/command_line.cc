#include "cli/command_line.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "cli/commands/compare_command.h"
#include "cli/commands/convert_ibl_command.h"
#include "cli/commands/describe_command.h"
#include "cli/commands/diagnose_command.h"
#include "cli/commands/figure_command.h"
#include "cli/commands/fit_command.h"
#include "cli/commands/gate_command.h"
#include "cli/commands/keygen_command.h"
#include "cli/commands/list_command.h"
#include "cli/commands/node_command.h"
#include "cli/commands/reconstruct_command.h"
#include "cli/commands/record_command.h"
#include "cli/commands/relay_command.h"
#include "cli/commands/replay_command.h"
#include "cli/commands/report_command.h"
#include "cli/commands/run_command.h"
#include "cli/commands/shell_commands.h"
#include "cli/commands/sweep_command.h"
#include "cli/commands/trace_command.h"
#include "cli/commands/validate_command.h"
#include "cli/commands/validate_model_command.h"
#include "cli/exit_status.h"
#include "cli/help_format.h"
#include "cli/messages.h"
#include "cli/mpi_launch.h"
#include "cli/terminal.h"
#include "cli/usage_error.h"
#include "recording/recording_folder.h"
#include "recording/rs_csv.h"
#include "recording/version.h"
#include "reports/text/output_folder.h"
#include "reports/text/plain_text.h"
#include "scenarios/loader.h"

namespace simbench {
namespace {

using cli::ExitStatus;

constexpr const char* kProgramExamples = R"(
Start here:
  simbench --scenario 18cam_6host_45fps     the same as: simbench run --scenario ...
  simbench list                             scenarios and algorithms
  simbench run --help                       options, with examples

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 3 gate failed, 4 baseline missing,
130 interrupted.)";

// `simbench --scenario S` means `simbench run --scenario S`.
std::vector<std::string> with_default_command(std::vector<std::string> arguments) {
  if (arguments.size() < 2) return arguments;
  const std::string& first = arguments[1];
  const bool option = first.starts_with("-");
  const bool about_simbench = first == "-h" || first == "--help" || first == "--version";
  if (option && !about_simbench) arguments.insert(arguments.begin() + 1, "run");
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
  const auto used = app.get_subcommands();
  cli::print_error(
      cli::usage_error(app, error),
      used.empty() ? "simbench --help" : fmt::format("simbench {} --help", used[0]->get_name()));
  return ExitStatus::kBadInput;
}

// The one place where commands are added; the help lists them in this order and under these
// headings, completion and man pages follow.
void add_commands(CLI::App& app, cli::Action& action, const std::vector<std::string>& arguments,
                  const CommandLineExtras& extras) {
  cli::add_run_command(app, action, arguments);
  cli::add_sweep_command(app, action, extras.farm);
  cli::add_reconstruct_command(app, action, arguments, extras.run_reconstruction);
  cli::group_commands(app, "Run");
  cli::add_report_command(app, action, arguments);
  cli::add_trace_command(app, action);
  cli::add_figure_command(app, action);
  cli::group_commands(app, "Look at results");
  cli::add_compare_command(app, action);
  cli::add_gate_command(app, action);
  cli::group_commands(app, "Compare results");
  cli::add_record_command(app, action);
  cli::add_replay_command(app, action, arguments);
  cli::add_diagnose_command(app, action);
  cli::add_fit_command(app, action);
  cli::add_convert_ibl_command(app, action);
  cli::group_commands(app, "Recordings");
  cli::add_keygen_command(app, action);
  cli::add_node_command(app, action);
  cli::add_validate_model_command(app, action);
  cli::add_relay_command(app, action);
  cli::group_commands(app, "Real rigs");
  cli::add_list_command(app, action);
  cli::add_describe_command(app, action);
  cli::add_validate_command(app, action);
  cli::group_commands(app, "Scenarios and algorithms");
  cli::add_completion_command(app, action);
  cli::add_manual_command(app, action);  // last: it knows those before it
  cli::group_commands(app, "The command line itself");
}

int parse_and_run(const std::vector<std::string>& arguments, const CommandLineExtras& extras) {
  CLI::App app("How well will these cameras, on these hosts, be synchronised?");
  app.name("simbench");
  app.set_version_flag("--version", fmt::format("simbench {} ({})", version(), commit()));
  app.require_subcommand(1);
  app.footer(kProgramExamples);
  app.formatter(std::make_shared<cli::HelpFormat>());
  cli::Action action;
  add_commands(app, action, arguments, extras);

  const std::vector<std::string> all = with_default_command(arguments);
  if (const auto problem = cli::unknown_command(app, all)) {
    cli::print_error(*problem, "simbench --help");
    return ExitStatus::kBadInput;
  }
  // CLI11 takes the arguments last first, without the program's name.
  std::vector<std::string> reversed(all.rbegin(), all.rend() - (all.empty() ? 0 : 1));
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  }
  return action();
}

int bad_input(const std::exception& error) {
  cli::print_error(error.what());
  return ExitStatus::kBadInput;
}

}  // namespace

int run_command_line(int argc, char** argv, const CommandLineExtras& extras) {
  const std::vector<std::string> arguments(argv, argv + argc);
  cli::choose_message_format(arguments);
  reports::set_page_width(cli::width_of_output());
  try {
    if (extras.farm == nullptr) cli::become_mpi_program(arguments);
    return parse_and_run(arguments, extras);
  } catch (const scenarios::InputError& error) {
    return bad_input(error);
  } catch (const reports::OutputError& error) {
    return bad_input(error);
  } catch (const CsvError& error) {
    return bad_input(error);
  } catch (const RecordingFolderError& error) {
    return bad_input(error);
  } catch (const std::exception& error) {
    cli::print_internal_error(
        fmt::format("{}\n(simbench {}, commit {})", error.what(), version(), commit()));
    return ExitStatus::kInternalError;
  }
}

}  // namespace simbench

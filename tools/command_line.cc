#include "tools/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "recording/rs_csv.h"
#include "recording/version.h"
#include "reports/output_folder.h"
#include "scenarios/loader.h"
#include "tools/compare_command.h"
#include "tools/convert_ibl_command.h"
#include "tools/describe_command.h"
#include "tools/diagnose_command.h"
#include "tools/exit_status.h"
#include "tools/list_command.h"
#include "tools/replay_command.h"
#include "tools/run_command.h"
#include "tools/validate_command.h"

namespace simbench {
namespace {

using tools::ExitStatus;

constexpr const char* kExamples = R"(
Start here:
  simbench --scenario 18cam_6host_45fps     the same as: simbench run --scenario ...
  simbench list                             scenarios and algorithms
  simbench run --help                       options, with examples

Exit status: 0 ok, 1 internal error, 2 bad usage or input, 130 interrupted.)";

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
int explain(const CLI::App& app, const CLI::ParseError& error, const std::string& command) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    // A request for help or the version, not an error.
    tools::print_result(error.get_name() == "CallForVersion" ? std::string(error.what()) + "\n"
                                                             : app.help());
    return ExitStatus::kOk;
  }
  std::cerr << "error: " << error.what() << "\nSee: " << command << " --help\n";
  return ExitStatus::kBadInput;
}

// The first word of the command line, if it is no command: CLI11 would only say that one is
// missing.
std::optional<std::string> unknown_command(const CLI::App& app,
                                           const std::vector<std::string>& arguments) {
  if (arguments.size() < 2 || arguments[1].starts_with("-")) return std::nullopt;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (std::find(known.begin(), known.end(), arguments[1]) != known.end()) return std::nullopt;
  return fmt::format("found '{}', allowed: {}", arguments[1], fmt::join(known, ", "));
}

int parse_and_run(const std::vector<std::string>& arguments) {
  CLI::App app("simbench: how well will these cameras, on these hosts, be synchronised?");
  app.name("simbench");
  app.set_version_flag("--version", fmt::format("simbench {} ({})", version(), commit()));
  app.require_subcommand(1);
  app.footer(kExamples);
  tools::Action action;
  tools::add_run_command(app, action, arguments);
  tools::add_list_command(app, action);
  tools::add_describe_command(app, action);
  tools::add_validate_command(app, action);
  tools::add_replay_command(app, action, arguments);
  tools::add_diagnose_command(app, action);
  tools::add_compare_command(app, action);
  tools::add_convert_ibl_command(app, action);

  const std::vector<std::string> all = with_default_command(arguments);
  if (const auto problem = unknown_command(app, all)) {
    std::cerr << "error: " << *problem << "\nSee: simbench --help\n";
    return ExitStatus::kBadInput;
  }
  // CLI11 takes the arguments last first, without the program's name.
  std::vector<std::string> reversed(all.rbegin(), all.rend() - (all.empty() ? 0 : 1));
  try {
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    const auto used = app.get_subcommands();
    return explain(app, error, used.empty() ? "simbench" : "simbench " + used[0]->get_name());
  }
  return action();
}

int bad_input(const std::exception& error) {
  std::cerr << "error: " << error.what() << '\n';
  return ExitStatus::kBadInput;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  try {
    return parse_and_run(std::vector<std::string>(argv, argv + argc));
  } catch (const scenarios::InputError& error) {
    return bad_input(error);
  } catch (const reports::OutputError& error) {
    return bad_input(error);
  } catch (const CsvError& error) {
    return bad_input(error);
  } catch (const std::exception& error) {
    std::cerr << fmt::format("internal error: {}\n(simbench {}, commit {})\n", error.what(),
                             version(), commit());
    return ExitStatus::kInternalError;
  }
}

}  // namespace simbench

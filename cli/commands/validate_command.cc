#include "cli/commands/validate_command.h"

#include <fmt/format.h>

#include <memory>

#include "cli/exit_status.h"
#include "evaluation/run/evaluate.h"

namespace simbench::cli {
namespace {

constexpr const char* kValidateExamples = R"(
Examples:
  simbench validate my_rig.json
  simbench validate rigs/*.json      checks every one; exit status 2 if any is wrong)";

// True if the file is a scenario that could be run.
bool validate(const std::string& file) {
  try {
    const scenarios::Scenario scenario = scenarios::load_scenario(file);
    evaluation::check_pipelines(scenario);
    print_warnings(scenarios::warnings(scenario));
  } catch (const scenarios::InputError& error) {
    print_error(error.what());
    return false;
  }
  print_result(fmt::format("{}: ok\n", file));
  return true;
}

int validate_all(const std::vector<std::string>& files) {
  int status = kOk;
  for (const std::string& file : files) {
    if (!validate(file)) status = kBadInput;
  }
  return status;
}

}  // namespace

void add_validate_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("validate", "Check scenario files without running them");
  auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("files", *files, "Scenario files")->type_name("FILE...")->required();
  command->footer(kValidateExamples);
  command->callback([files, &action] { action = [files] { return validate_all(*files); }; });
}

}  // namespace simbench::cli

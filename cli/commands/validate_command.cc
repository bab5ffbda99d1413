#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "evaluation/run/evaluate.h"

namespace simbench::cli {
namespace {

constexpr const char* kValidateExamples = R"(
Examples:
  simbench validate my_rig.json
  simbench validate rigs/*.json      checks each file; exit status 2 if any is wrong)";

// True if the file is a valid scenario.
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

void add_validate_command(CommandLine& line) {
  auto files = std::make_shared<std::vector<std::string>>();
  Command command(line, "validate", "Check scenario files without running them");
  command.texts("files", "FILE...", *files, "Scenario files").required();
  command.python();
  command.footer(kValidateExamples);
  command.runs([files] { return validate_all(*files); });
}

}  // namespace simbench::cli

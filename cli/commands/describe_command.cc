#include <memory>

#include "cli/command.h"
#include "cli/commands/commands.h"
#include "reports/text/block.h"
#include "reports/text/plain_text.h"

namespace simbench::cli {
namespace {

constexpr const char* kDescribeExamples = R"(
Examples:
  simbench describe 18cam_6host_45fps
  simbench describe my_rig.json --set /trigger/rate_hz=30
  simbench describe 18cam_6host_45fps --format json > my_rig.json    a start for your own)";

struct DescribeOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::string format;
};

// Shortens a long text or list, which --format json has in full.
std::string shortened(const std::string& value) {
  constexpr std::size_t kLongest = 40;
  return value.size() <= kLongest ? value : value.substr(0, kLongest - 3) + "...";
}

std::string parameters_text(const scenarios::Scenario& scenario) {
  using reports::Align;
  reports::Table table({{"parameter", Align::kLeft},
                        {"value"},
                        {"unit", Align::kLeft},
                        {"meaning", Align::kLeft},
                        {"source", Align::kLeft}});
  for (const scenarios::ParameterLine& line : scenarios::describe(scenario)) {
    table.add({line.pointer, shortened(line.value), line.unit, line.meaning, line.source});
  }
  std::string head = reports::wrapped(scenarios::named(scenario.name, scenario.derivation) + ": " +
                                      scenario.summary);
  for (const std::string& line : scenarios::derivation_lines(scenario.derivation)) {
    head += reports::wrapped(line);
  }
  return head + "\n" + plain(table);
}

int describe(const DescribeOptions& options) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(options.scenario, overrides_of(options.sets));
  print_warnings(scenarios::warnings(scenario));
  print_result(options.format == "json" ? scenario.resolved_json() + "\n"
                                        : parameters_text(scenario));
  return kOk;
}

}  // namespace

void add_describe_command(CommandLine& line) {
  auto options = std::make_shared<DescribeOptions>();
  Command command(line, "describe",
                  "Print every parameter of a scenario with value, unit, meaning and source");
  command
      .text("scenario", "SCENARIO", options->scenario,
            "Name of a scenario or path of a scenario file")
      .required();
  command.sets(options->sets);
  command.format(options->format, {"table", "json"});
  command.footer(kDescribeExamples);
  command.runs([options] { return describe(*options); });
}

}  // namespace simbench::cli

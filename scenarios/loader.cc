#include "scenarios/loader.h"

#include <utility>

#include "scenarios/builtin_files.h"
#include "scenarios/checks.h"
#include "scenarios/fields.h"
#include "scenarios/resolve.h"
#include "scenarios/schema.h"

namespace simbench::scenarios {
namespace {

Scenario load(Source source, const std::vector<Override>& overrides) {
  Resolved resolved = resolve(std::move(source), overrides);
  auto scenario = resolved.document.get<Scenario>();
  scenario.resolved_json = in_schema_order(resolved.document).dump(2) + '\n';
  scenario.origin = std::move(resolved.places);
  check(scenario);
  return scenario;
}

}  // namespace

Scenario load_scenario(const std::string& name_or_path, const std::vector<Override>& overrides) {
  return load(find_source(name_or_path), overrides);
}

Scenario load_scenario_text(const std::string& text, const std::string& file_name,
                            const std::vector<Override>& overrides) {
  return load(Source{file_name, text, false}, overrides);
}

std::vector<BuiltinScenario> builtin_scenarios() {
  std::vector<BuiltinScenario> scenarios;
  for (const BuiltinFile& file : builtin_files()) {
    const auto document = nlohmann::json::parse(file.text);
    scenarios.push_back({std::string(file.name), document.at("summary").get<std::string>()});
  }
  return scenarios;
}

void fail_at(const Scenario& scenario, const std::string& pointer, const std::string& problem) {
  throw InputError(scenario.origin->describe(pointer) + ": " + problem);
}

}  // namespace simbench::scenarios

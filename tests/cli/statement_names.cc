#include "tests/cli/statement_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "algorithms/ports/stage.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/claims.h"
#include "evaluation/scoring/metrics.h"
#include "reports/figures/figure.h"
#include "scenarios/loader.h"
#include "scenarios/schema.h"

namespace simbench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kRoot = SIMBENCH_SOURCE_DIR;

std::string content_of(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Adds the tests that a source defines: TEST(Suite, Case), TEST_F and TEST_P.
void add_tests(const std::string& source, std::set<std::string>& tests) {
  for (std::size_t at = source.find("\nTEST"); at != std::string::npos;
       at = source.find("\nTEST", at + 1)) {
    const std::size_t open = source.find('(', at);
    const std::size_t comma = source.find(',', open);
    const std::size_t close = source.find(')', open);
    if (comma == std::string::npos || comma > close) continue;
    const std::size_t name = source.find_first_not_of(" \n", comma + 1);
    tests.insert(source.substr(open + 1, comma - open - 1) + "." +
                 source.substr(name, close - name));
  }
}

std::set<std::string> all_tests() {
  std::set<std::string> tests;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(kRoot / "tests")) {
    if (file.path().extension() == ".cc") add_tests(content_of(file.path()), tests);
  }
  return tests;
}

std::set<std::string> all_words() {
  std::set<std::string> words;
  for (const evaluation::Claim& claim : evaluation::check_claims({}, 45)) words.insert(claim.id);
  for (const reports::FigureEntry& entry : reports::figure_catalogue()) {
    words.insert(entry.id);
    words.insert(entry.aliases.begin(), entry.aliases.end());
  }
  for (const StageInfo& stage : kPipelineStages) {
    for (const AlgorithmInfo* info : algorithms_of(stage.id)) words.insert(info->name);
  }
  for (const evaluation::Metric& metric : evaluation::metrics()) words.emplace(metric.id);
  for (const scenarios::BuiltinScenario& builtin : scenarios::builtin_scenarios()) {
    words.insert(builtin.name);
  }
  return words;
}

bool is_scenario(const std::string& name) {
  return std::ranges::count(scenarios::builtin_scenarios(), name,
                            &scenarios::BuiltinScenario::name) > 0;
}

std::vector<std::string> command_words(const std::string& text) {
  std::istringstream words(text);
  std::vector<std::string> found;
  for (std::string word; words >> word;) found.push_back(word);
  return found;
}

std::vector<std::string> keys_of(const std::string& pointer) {
  std::istringstream keys(pointer.substr(1));
  std::vector<std::string> found;
  for (std::string key; std::getline(keys, key, '/');) found.push_back(key);
  return found;
}

// Algorithms state their parameters themselves, so the schema takes any.
bool is_parameter(const std::string& family, const std::string& name) {
  for (const StageInfo& stage : kPipelineStages) {
    for (const AlgorithmInfo* info : algorithms_of(stage.id)) {
      if (info->family == family &&
          std::ranges::count(info->parameters, name, &ParameterSpec::name))
        return true;
    }
  }
  return false;
}

bool is_member(const std::string& pointer) {
  const std::vector<std::string> keys = keys_of(pointer);
  if (keys.size() == 3 && keys[0] == "algorithms") return is_parameter(keys[1], keys[2]);
  const nlohmann::ordered_json* node = &scenarios::ordered_schema();
  for (const std::string& key : keys) {
    node = scenarios::schema_of_child(*node, key);
    if (node == nullptr) return false;
  }
  return true;
}

}  // namespace

StatementNames::StatementNames(Help help)
    : help_(std::move(help)), tests_(all_tests()), words_(all_words()) {}

std::string StatementNames::problem_of_place(const std::string& name) {
  const std::size_t pointer = name.find(" /");
  const std::size_t equals = name.find(" = ");
  if (name.starts_with("simbench ")) return problem_of_command(name);
  if (pointer != std::string::npos && equals != std::string::npos && pointer < equals) {
    return problem_of_value(name.substr(0, pointer), name.substr(pointer + 1, equals - pointer - 1),
                            name.substr(equals + 3));
  }
  if (name.starts_with("/")) return is_member(name) ? "" : "no scenario has " + name;
  if (name.find('/') != std::string::npos) {
    return fs::exists(kRoot / name) ? "" : "there is no file " + name;
  }
  return words_.contains(name) ? "" : "simbench knows no " + name;
}

std::string StatementNames::problem_of_test(const std::string& name) {
  if (name.starts_with("simbench ")) return problem_of_command(name);
  return tests_.contains(name) ? "" : "there is no test " + name;
}

std::string StatementNames::problem_of_value(const std::string& file, const std::string& pointer,
                                             const std::string& value) {
  try {
    const json& found = document(file).at(json::json_pointer(pointer));
    json expected = json::parse(value, nullptr, /*allow_exceptions=*/false);
    if (expected.is_discarded()) expected = value;
    if (found == expected) return "";
    return fmt::format("{} {}: found {}, not {}", file, pointer, found.dump(), value);
  } catch (const std::exception& error) {
    return fmt::format("{} {}: {}", file, pointer, error.what());
  }
}

std::string StatementNames::problem_of_command(const std::string& command) {
  const std::vector<std::string> words = command_words(command);
  const std::string& help = help_of(words.at(1));
  if (help.empty()) return "simbench has no command " + words[1];
  for (std::size_t i = 2; i < words.size(); ++i) {
    if (words[i].starts_with("--")) {
      if (help.find(words[i]) == std::string::npos) {
        return fmt::format("{} has no option {}", words[1], words[i]);
      }
      continue;
    }
    const std::string problem = problem_of_argument(words[i - 1], words[i]);
    if (!problem.empty()) return fmt::format("{}: {}", command, problem);
  }
  return "";
}

std::string StatementNames::problem_of_argument(const std::string& before,
                                                const std::string& argument) {
  if (argument.starts_with("/")) {
    const std::string pointer = argument.substr(0, argument.find('='));
    return is_member(pointer) ? "" : "no scenario has " + pointer;
  }
  if (before == "--scenario" || before == "describe") {
    return is_scenario(argument) ? "" : "no scenario " + argument;
  }
  if (before == "figure") {
    return reports::find_figure(argument) != nullptr ? "" : "no figure " + argument;
  }
  if (before == "--study") {
    return fs::exists(kRoot / "scenarios/studies" / (argument + ".json")) ? ""
                                                                          : "no study " + argument;
  }
  return "";
}

const json& StatementNames::document(const std::string& file) {
  const auto known = documents_.find(file);
  if (known != documents_.end()) return known->second;
  const std::string text =
      is_scenario(file) ? scenarios::load_scenario(file).resolved_json() : content_of(kRoot / file);
  return documents_.emplace(file, json::parse(text)).first->second;
}

const std::string& StatementNames::help_of(const std::string& command) {
  const auto known = helps_.find(command);
  if (known != helps_.end()) return known->second;
  return helps_.emplace(command, help_(command)).first->second;
}

}  // namespace simbench

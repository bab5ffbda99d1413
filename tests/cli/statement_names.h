// What the lines of docs/reference/paper_statements.md may name, and whether it exists: files,
// members of scenarios and their values, commands, claims, figures, algorithms, metrics, tests.
//
//   `scenarios/d455.json`                       a file of the project
//   `18cam_6host_45fps /cameras/count = 18`     a value in a scenario, or in a JSON file
//   `/cameras/count`                            a member of every scenario
//   `simbench figure fig8 --output f.svg`       a command with its options
//   `C5`, `fig8`, `yoon2021_both`, `amd_ms`     a claim, figure, algorithm, metric, scenario
//   `TriggerTree.StartsLate`                    a test
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace simbench {

class StatementNames {
 public:
  // What `simbench help COMMAND` prints; empty if there is no such command.
  using Help = std::function<std::string(const std::string& command)>;

  explicit StatementNames(Help help);

  // What is wrong with a name in the column "in simbench"; empty if nothing.
  std::string problem_of_place(const std::string& name);
  // What is wrong with a name in the column "test"; empty if nothing.
  std::string problem_of_test(const std::string& name);

 private:
  std::string problem_of_value(const std::string& file, const std::string& pointer,
                               const std::string& value);
  std::string problem_of_command(const std::string& command);
  std::string problem_of_argument(const std::string& before, const std::string& argument);
  const nlohmann::json& document(const std::string& file);
  const std::string& help_of(const std::string& command);

  Help help_;
  std::set<std::string> tests_;  // Suite.Case
  std::set<std::string> words_;  // claims, figures, algorithms, metrics
  std::map<std::string, nlohmann::json> documents_;
  std::map<std::string, std::string> helps_;
};

}  // namespace simbench

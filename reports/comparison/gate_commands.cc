#include "reports/comparison/gate_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace simbench::reports {
namespace {

bool is_plain(char letter) {
  constexpr std::string_view kPlain = "_-./=,:+@%";
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
         kPlain.find(letter) != std::string_view::npos;
}

std::string shell_quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string text = "'";
  for (const char letter : word) {
    if (letter == '\'') {
      text += "'\\''";
    } else {
      text += letter;
    }
  }
  text += '\'';
  return text;
}

std::vector<std::string> run_command(const Archive& result) {
  if (!result.command.empty()) {
    std::vector<std::string> command = result.command;
    command[0] = "simbench";  // wherever it lay
    return command;
  }
  std::vector<std::string> names;
  for (const evaluation::Row& row : result.results.rows) names.push_back(row.pipeline);
  return {"simbench",     "run",
          "--scenario",   result.results.scenario,
          "--first-seed", fmt::format("{}", result.results.first_seed),
          "--seeds",      fmt::format("{}", result.results.seed_count),
          "--pipelines",  fmt::format("{}", fmt::join(names, ",")),
          "--output",     "results"};
}

}  // namespace

std::string shell_line(const std::vector<std::string>& words) {
  std::vector<std::string> all;
  all.reserve(words.size());
  for (const std::string& word : words) all.push_back(shell_quoted(word));
  return fmt::format("{}", fmt::join(all, " "));
}

std::vector<std::string> gate_commands(const Archive& result, const Baseline& baseline,
                                       GateMode mode) {
  const std::string archive = result.command.empty() ? "results" : result.path;
  std::vector<std::string> judge = {"simbench", "gate", archive, "--baseline", baseline.path};
  if (mode == GateMode::kStatistical) judge.insert(judge.end(), {"--mode", "statistical"});
  return {shell_line(run_command(result)), shell_line(judge)};
}

}  // namespace simbench::reports

#include "app/fitted_ranking.h"

#include <fmt/format.h>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

constexpr const char* kLeaderboard = "leaderboard_lan";

// Why the pipeline cannot run in this world; empty if it can.
std::string problem_of(const scenarios::Scenario& world, const scenarios::Pipeline& pipeline) {
  scenarios::Scenario alone = world;
  alone.pipelines = {pipeline};
  try {
    evaluation::check_pipelines(alone);
    return "";
  } catch (const scenarios::InputError& error) {
    const std::string text = error.what();
    const std::size_t needs = text.find("which needs ");
    return needs == std::string::npos ? text : text.substr(needs + 6);
  }
}

}  // namespace

FittedRanking ranking_of(const scenarios::Scenario& fitted) {
  const scenarios::Scenario leaderboard = scenarios::load_scenario(kLeaderboard);
  const bool one_host = fitted.cameras.count <= fitted.cameras.cameras_per_host;
  FittedRanking ranking{.scenario = fitted};
  ranking.scenario.evaluation.table = scenarios::TableKind::kLeaderboard;
  ranking.scenario.pipelines.clear();
  for (const scenarios::Pipeline& pipeline : leaderboard.pipelines) {
    if (one_host && pipeline.name.starts_with("host.")) continue;
    const std::string problem = problem_of(fitted, pipeline);
    if (problem.empty()) {
      ranking.scenario.pipelines.push_back(pipeline);
    } else {
      ranking.left_out.push_back(fmt::format("{}: {}", pipeline.name, problem));
    }
  }
  return ranking;
}

}  // namespace simbench::app

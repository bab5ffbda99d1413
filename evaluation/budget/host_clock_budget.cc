#include "evaluation/budget/host_clock_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithms/ports/host_sync.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/program_failures.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"
#include "scenarios/ideal.h"

namespace simbench::evaluation {
namespace {

using scenarios::Pipeline;
using scenarios::Scenario;

// Why the error of this pipeline's host clocks is not divided; empty if it can be.
std::string undivided(const Scenario& scenario, const PipelineChoice& choice) {
  if (!choice.problem.empty()) return choice.problem;
  if (scenario.hosts.count == 1) return "there is one host, whose clock is the reference";
  const std::string& name = choice.pipeline.host_sync;
  if (std::ranges::count(choice.host_sync.info().needs, Need::kFrames) > 0) {
    return fmt::format("{} looks at frames, whose way over USB is no message's", name);
  }
  if (choice.host_sync.make()->is_idle()) {
    return fmt::format("{} sends nothing and sets no clock", name);
  }
  return "";
}

// The host clocks do not depend on the stages behind them.
Pipeline with_cheap_stages(Pipeline pipeline) {
  pipeline.device_time = "raw_arrival";
  pipeline.gathering = "oracle";
  return pipeline;
}

// The errors of one pipeline.
struct ErrorsByWorld {
  std::vector<std::vector<double>> by_world;  // then by seed, ms
  std::string first_note;                     // of any world
  std::string failed;                         // the first program that ended in any of them
};

void add_world(const Scenario& world, const WorldFactory& make_world,
               const EvaluationOptions& options, const Progress& progress,
               std::vector<ErrorsByWorld>& errors) {
  EvaluationOptions of_world = options;
  of_world.pipelines.clear();
  of_world.keep_pulses = false;
  of_world.share_captures = true;
  const Results results = evaluate(
      world, [&] { return make_world(world); }, of_world, progress);
  for (std::size_t i = 0; i < results.rows.size(); ++i) {
    const Row& row = results.rows[i];
    errors[i].by_world.push_back(row.host_error_ms.values);
    if (errors[i].failed.empty()) errors[i].failed = program_failure_text(row);
    if (errors[i].first_note.empty() && !row.notes.empty()) {
      errors[i].first_note = row.notes.front();
    }
  }
}

// A seed without an error in one world has none in all. Returns how many those are.
std::size_t drop_incomplete_seeds(std::vector<std::vector<double>>& by_world) {
  std::size_t dropped = 0;
  for (std::size_t seed = 0; seed < by_world.front().size(); ++seed) {
    const bool is_complete = std::ranges::none_of(
        by_world, [seed](const std::vector<double>& world) { return std::isnan(world[seed]); });
    if (is_complete) continue;
    for (std::vector<double>& world : by_world) world[seed] = kNan;
    ++dropped;
  }
  return dropped;
}

void divide_host_clock(ErrorsByWorld& errors, HostClockBudget& budget) {
  if (!errors.failed.empty()) {
    budget.note = errors.failed;
    return;
  }
  const std::size_t seeds = errors.by_world.front().size();
  const std::size_t dropped = drop_incomplete_seeds(errors.by_world);
  if (dropped > 0) {
    budget.note =
        fmt::format("{} of {} seeds have no host clock error in one of the worlds{}{}", dropped,
                    seeds, errors.first_note.empty() ? "" : ": ", errors.first_note);
  }
  budget.is_divided = dropped < seeds;
  if (!budget.is_divided) return;
  DividedError divided = divide_error(errors.by_world);
  budget.total = std::move(divided.total);
  std::ranges::move(divided.players, budget.parts.begin());
  budget.algorithm = std::move(divided.remainder);
}

}  // namespace

Scenario without_causes(const Scenario& scenario, std::size_t ideal) {
  std::vector<std::string_view> causes;
  for (std::size_t cause = 0; cause < kHostClockCauseCount; ++cause) {
    if ((ideal >> cause & 1U) != 0) causes.push_back(kHostClockParts[cause].cause);
  }
  Scenario world = scenarios::with_ideal_stages(scenario, causes);
  world.published.clear();
  const std::vector<double>& table_ms = scenario.network.latency_quantiles_ms;
  // A world that has lost the table has its least value as the constant latency.
  if (world.network.latency_quantiles_ms.size() < table_ms.size()) {
    world.network.latency_fixed_ms = table_ms.front();
  }
  return world;
}

std::vector<HostClockBudget> host_clock_budgets(const Scenario& scenario,
                                                const std::vector<Pipeline>& pipelines,
                                                const WorldFactory& make_world,
                                                const EvaluationOptions& options,
                                                const Progress& progress) {
  Scenario divided = scenario;
  divided.pipelines = pipelines;
  const std::vector<PipelineChoice> choices = choose_pipelines(divided, {});
  std::vector<HostClockBudget> budgets;
  budgets.reserve(choices.size());
  std::vector<std::size_t> places;  // of those to divide
  divided.pipelines.clear();
  for (const PipelineChoice& choice : choices) {
    budgets.push_back({.pipeline = choice.pipeline.name, .note = undivided(scenario, choice)});
    if (!budgets.back().note.empty()) continue;
    places.push_back(budgets.size() - 1);
    divided.pipelines.push_back(with_cheap_stages(choice.pipeline));
  }
  if (places.empty()) return budgets;
  const std::uint64_t runs = places.size() * options.seeds;
  std::vector<ErrorsByWorld> errors(places.size());
  for (std::size_t ideal = 0; ideal < kHostClockWorlds; ++ideal) {
    add_world(
        without_causes(divided, ideal), make_world, options,
        [&](std::uint64_t done, std::uint64_t) {
          if (progress) progress(ideal * runs + done, kHostClockWorlds * runs);
        },
        errors);
  }
  for (std::size_t i = 0; i < places.size(); ++i) divide_host_clock(errors[i], budgets[places[i]]);
  return budgets;
}

}  // namespace simbench::evaluation

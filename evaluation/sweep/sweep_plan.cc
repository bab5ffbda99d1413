#include "evaluation/sweep/sweep_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mutex>
#include <set>

#include "evaluation/run/jobs.h"
#include "evaluation/run/pipeline_choice.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using scenarios::Scenario;

void check_pointers(const SweepPlan& plan) {
  std::set<std::string> seen;
  for (const std::string& pointer : plan.pointers()) {
    if (!seen.insert(pointer).second) {
      throw InputError(fmt::format("--sweep {}: the pointer is swept twice", pointer));
    }
  }
}

void check_size(const SweepPlan& plan) {
  double runs = static_cast<double>(plan.pipelines.size()) * static_cast<double>(plan.seeds);
  for (const SweepAxis& axis : plan.axes) runs *= static_cast<double>(axis.steps());
  if (runs <= static_cast<double>(kMostRuns)) return;
  throw InputError(
      fmt::format("--sweep: {:.3g} runs in all, allowed: at most {}; take fewer values or seeds",
                  runs, kMostRuns));
}

// The loader speaks of --set, by which it was told the point's values.
std::string as_sweep(std::string message) {
  if (message.starts_with("--set ")) message.replace(0, 5, "--sweep");
  return message;
}

// The warnings of the scenario at a point. Throws InputError if the point is refused.
std::vector<std::string> check_point(const SweepPlan& plan, const SweepRequest& request,
                                     std::size_t point) {
  try {
    std::vector<scenarios::Override> overrides = request.overrides;
    const std::vector<scenarios::Override> swept = plan.overrides(point);
    overrides.insert(overrides.end(), swept.begin(), swept.end());
    const Scenario scenario = scenarios::load_scenario(request.scenario, overrides);
    choose_pipelines(scenario, plan.pipelines);
    return scenarios::warnings(scenario);
  } catch (const InputError& error) {
    throw InputError(fmt::format("point {} of {} of the sweep ({}) is refused: {}", point + 1,
                                 plan.points(), plan.point_text(point), as_sweep(error.what())));
  }
}

}  // namespace

std::size_t SweepPlan::points() const {
  std::size_t points = 1;
  for (const SweepAxis& axis : axes) points *= axis.steps();
  return points;
}

SweepRun SweepPlan::run(std::size_t index) const {
  const std::size_t row = index / seeds;
  return {.point = row / pipelines.size(),
          .pipeline = row % pipelines.size(),
          .seed = first_seed + index % seeds};
}

std::vector<std::size_t> SweepPlan::steps(std::size_t point) const {
  std::vector<std::size_t> steps(axes.size());
  for (std::size_t axis = axes.size(); axis-- > 0;) {
    steps[axis] = point % axes[axis].steps();
    point /= axes[axis].steps();
  }
  return steps;
}

std::vector<std::string> SweepPlan::pointers() const {
  std::vector<std::string> pointers;
  for (const SweepAxis& axis : axes) {
    pointers.insert(pointers.end(), axis.pointers.begin(), axis.pointers.end());
  }
  return pointers;
}

std::vector<std::string> SweepPlan::values(std::size_t point) const {
  const std::vector<std::size_t> at = steps(point);
  std::vector<std::string> values;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for (const auto& steps_of_pointer : axes[axis].values) {
      values.push_back(steps_of_pointer[at[axis]]);
    }
  }
  return values;
}

std::vector<scenarios::Override> SweepPlan::overrides(std::size_t point) const {
  const std::vector<std::string> names = pointers();
  const std::vector<std::string> at = values(point);
  std::vector<scenarios::Override> overrides;
  for (std::size_t i = 0; i < names.size(); ++i) overrides.push_back({names[i], at[i]});
  return overrides;
}

std::string SweepPlan::point_text(std::size_t point) const {
  std::vector<std::string> texts;
  for (const scenarios::Override& value : overrides(point)) {
    texts.push_back(fmt::format("{}={}", value.pointer, value.value));
  }
  return texts.empty() ? "as it is" : fmt::format("{}", fmt::join(texts, ", "));
}

SweepPlan make_plan(const SweepRequest& request) {
  SweepPlan plan;
  plan.first_seed = request.first_seed;
  plan.seeds = request.seeds;
  for (const std::string& axis : request.axes) plan.axes.push_back(parse_axis(axis));
  check_pointers(plan);
  const Scenario scenario = scenarios::load_scenario(request.scenario, request.overrides);
  plan.scenario = scenario.name;
  plan.scenario_json = scenario.resolved_json;
  for (const PipelineChoice& choice : choose_pipelines(scenario, request.pipelines)) {
    plan.pipelines.push_back(choice.pipeline.name);
  }
  check_size(plan);
  return plan;
}

std::vector<std::string> check_points(const SweepPlan& plan, const SweepRequest& request,
                                      unsigned threads) {
  std::mutex mutex;
  std::set<std::string> texts;
  run_jobs(plan.points(), {.threads = threads}, [&](std::size_t point) {
    const std::vector<std::string> warnings = check_point(plan, request, point);
    const std::lock_guard lock(mutex);
    texts.insert(warnings.begin(), warnings.end());
  });
  return {texts.begin(), texts.end()};
}

}  // namespace simbench::evaluation

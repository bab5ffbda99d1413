#include "evaluation/sweep/sweep_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <thread>

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

// Many threads look for the first point that is refused.
class PointCheck {
 public:
  PointCheck(const SweepPlan& plan, const SweepRequest& request)
      : plan_(plan), request_(request), refused_(plan.points()) {}

  void work() {
    for (std::size_t point = next_++; point < refused_; point = next_++) check(point);
  }

  std::vector<std::string> finish() const {
    if (refused_ < plan_.points()) {
      throw InputError(fmt::format("point {} of {} of the sweep ({}) is refused: {}", refused_ + 1,
                                   plan_.points(), plan_.point_text(refused_), problem_));
    }
    return {warnings_.begin(), warnings_.end()};
  }

 private:
  void check(std::size_t point) {
    try {
      std::vector<scenarios::Override> overrides = request_.overrides;
      const std::vector<scenarios::Override> swept = plan_.overrides(point);
      overrides.insert(overrides.end(), swept.begin(), swept.end());
      const Scenario scenario = scenarios::load_scenario(request_.scenario, overrides);
      choose_pipelines(scenario, plan_.pipelines);
      const std::vector<std::string> warnings = scenarios::warnings(scenario);
      const std::lock_guard lock(mutex_);
      warnings_.insert(warnings.begin(), warnings.end());
    } catch (const InputError& error) {
      const std::lock_guard lock(mutex_);
      if (point >= refused_) return;
      refused_ = point;
      problem_ = as_sweep(error.what());
    }
  }

  const SweepPlan& plan_;
  const SweepRequest& request_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;                  // guards what follows, and writing refused_
  std::atomic<std::size_t> refused_;  // the first; points beyond need no look
  std::string problem_;
  std::set<std::string> warnings_;
};

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
  PointCheck check(plan, request);
  const unsigned workers =
      threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min<std::size_t>(workers, plan.points()); ++i) {
      others.emplace_back([&] { check.work(); });
    }
    check.work();
  }
  return check.finish();
}

}  // namespace simbench::evaluation

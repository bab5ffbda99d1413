#include "evaluation/sweep/task_farm.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/run/capture_groups.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/sweep/sweep_score.h"

namespace simbench::evaluation {
namespace {

using nlohmann::json;
using scenarios::Scenario;

constexpr char kEndOfRun = '\n';  // in an answer

// The period in a setup; none of captures.
std::optional<ClockPeriod> clock_period_in(const json& setup) {
  const auto clocks = setup.find("clocks");
  if (clocks == setup.end()) return std::nullopt;
  return ClockPeriod{.from_s = clocks->at("from_s"), .duration_s = clocks->at("duration_s")};
}

class SweepWorker {
 public:
  SweepWorker(const json& setup, WorldFactory make_world, ClockWorldFactory make_clocks)
      : name_(setup.at("name")),
        scenario_json_(setup.at("scenario")),
        clock_period_(clock_period_in(setup)),
        make_world_(std::move(make_world)),
        make_clocks_(std::move(make_clocks)) {}

  // Returns a line for each run.
  std::string work(const std::string& text) {
    const json task = json::parse(text);
    const json& runs = task.at("runs");
    const std::uint64_t seed = task.at("seed");
    if (runs.size() > 1) {
      if (const std::optional<std::string> all = work_together(runs, seed)) return *all;
    }
    std::string all;
    for (const json& run : runs) all += work_alone(run, seed);
    return all;
  }

 private:
  // Nothing if one of the runs fails: alone it names itself.
  std::optional<std::string> work_together(const json& runs, std::uint64_t seed) {
    try {
      return scores(runs, seed);
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

  std::string work_alone(const json& run, std::uint64_t seed) {
    try {
      return clock_period_ ? clock_score(run, seed) : scores(json::array({run}), seed);
    } catch (const scenarios::InputError& error) {
      std::throw_with_nested(scenarios::InputError(with_place(run, seed, error)));
    } catch (const std::exception& error) {
      throw std::runtime_error(with_place(run, seed, error));
    }
  }

  std::string with_place(json run, std::uint64_t seed, const std::exception& error) const {
    run["seed"] = seed;
    return fmt::format("{} {}: {}", name_, run.dump(), error.what());
  }

  std::string scores(const json& runs, std::uint64_t seed) {
    prepare(runs);
    const Scenario& world = *choices_.front().scored_in;
    const Results results = evaluate_choices(
        world, choices_, [&] { return make_world_(world); },
        {.first_seed = seed, .seeds = 1, .jobs = 1, .share_captures = true}, nullptr);
    std::string texts;
    for (const Row& row : results.rows) texts += text_of(sweep_score(row)) + kEndOfRun;
    return texts;
  }

  std::string clock_score(const json& run, std::uint64_t seed) {
    const std::shared_ptr<const Scenario> scenario = load(run.at("values"));
    const ClockOptions options = {.duration_s = clock_period_->duration_s,
                                  .from_s = clock_period_->from_s,
                                  .first_seed = seed,
                                  .seeds = 1,
                                  .jobs = 1,
                                  .pipelines = {run.at("pipeline")}};
    const ClockResults all = evaluate_clocks(
        *scenario, [&] { return make_clocks_(*scenario); }, options, nullptr);
    return text_of(sweep_score(all.results.rows.front(), ResultKind::kClockRuns)) + kEndOfRun;
  }

  // Chooses the pipelines of these runs, unless they are those of the last task.
  void prepare(const json& runs) {
    if (runs == prepared_) return;
    prepared_ = nullptr;
    choices_.clear();
    for (std::size_t run = 0; run < runs.size();) {
      const json& values = runs[run].at("values");
      std::vector<std::string> pipelines;
      for (; run < runs.size() && runs[run].at("values") == values; ++run) {
        pipelines.push_back(runs[run].at("pipeline"));
      }
      const std::shared_ptr<const Scenario> scenario = load(values);
      for (PipelineChoice& choice : choose_pipelines(*scenario, pipelines)) {
        choice.scores_offline = false;  // no column of a sweep
        choice.scored_in = scenario;
        choices_.push_back(std::move(choice));
      }
    }
    prepared_ = runs;
  }

  std::shared_ptr<const Scenario> load(const json& values) {
    if (loaded_ && values == loaded_values_) return loaded_;
    std::vector<scenarios::Override> overrides;
    for (const json& value : values) overrides.push_back({value.at(0), value.at(1)});
    loaded_ = std::make_shared<const Scenario>(
        scenarios::load_scenario_text(scenario_json_, name_, overrides));
    loaded_values_ = values;
    return loaded_;
  }

  std::string name_;
  std::string scenario_json_;
  std::optional<ClockPeriod> clock_period_;
  WorldFactory make_world_;
  ClockWorldFactory make_clocks_;
  std::shared_ptr<const Scenario> loaded_;  // the last one
  json loaded_values_;
  json prepared_;  // the runs of choices_
  std::vector<PipelineChoice> choices_;
};

// The points that differ from this one in scoring alone have the same world.
std::size_t world_of(const SweepPlan& plan, std::size_t point) {
  const std::vector<std::size_t> steps = plan.steps(point);
  std::size_t world = 0;
  for (std::size_t axis = 0; axis < steps.size(); ++axis) {
    const bool is_scoring = std::ranges::all_of(plan.axes[axis].pointers, is_scoring_alone);
    world = world * plan.axes[axis].steps() + (is_scoring ? 0 : steps[axis]);
  }
  return world;
}

}  // namespace

AnswerKeeper one_at_a_time(const AnswerKeeper& keep) {
  return
      [&keep, mutex = std::make_shared<std::mutex>()](std::size_t task, const std::string& answer) {
        const std::lock_guard lock(*mutex);
        keep(task, answer);
      };
}

WorkerFactory task_workers(const Tasks& tasks, const TaskWorkerFactory& make_worker,
                           const AnswerKeeper& keep) {
  return [&]() -> Job {
    return [&tasks, &keep, worker = make_worker(tasks.setup)](std::size_t task) {
      keep(task, worker(tasks.task(task)));
    };
  };
}

void ThreadFarm::run(const Tasks& tasks, const AnswerKeeper& keep) {
  const AnswerKeeper keep_safely = one_at_a_time(keep);
  run_jobs_with_workers(tasks.count, {.threads = tasks.threads},
                        task_workers(tasks, make_worker_, keep_safely));
}

SweepTasks::SweepTasks(const SweepPlan& plan, std::vector<std::size_t> runs)
    : plan_(plan), runs_(std::move(runs)) {
  std::vector<std::size_t> worlds(plan.points());
  for (std::size_t point = 0; point < worlds.size(); ++point) worlds[point] = world_of(plan, point);
  std::ranges::sort(runs_, {}, [&](std::size_t number) {
    const SweepRun run = plan.run(number);
    return std::tuple(worlds[run.point], run.seed, number);
  });
  const auto go_together = [&](std::size_t a, std::size_t b) {
    const SweepRun first = plan.run(runs_[a]);
    const SweepRun second = plan.run(runs_[b]);
    return plan.kind == ResultKind::kCaptures && first.seed == second.seed &&
           worlds[first.point] == worlds[second.point] &&
           (first.point == second.point || b - begins_.back() < kSharedRuns);
  };
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (i == 0 || !go_together(i - 1, i)) begins_.push_back(i);
  }
  begins_.push_back(runs_.size());
}

std::span<const std::size_t> SweepTasks::runs(std::size_t task) const {
  return std::span(runs_).subspan(begins_[task], begins_[task + 1] - begins_[task]);
}

Tasks SweepTasks::tasks() const {
  Tasks tasks;
  json setup = {{"name", plan_.scenario}, {"scenario", plan_.scenario_json}};
  if (plan_.kind == ResultKind::kClockRuns) {
    setup["clocks"] = {{"from_s", plan_.clock_period.from_s},
                       {"duration_s", plan_.clock_period.duration_s}};
  }
  tasks.setup = setup.dump();
  tasks.count = begins_.size() - 1;
  tasks.task = [this](std::size_t task) {
    json of_task = {{"runs", json::array()}};
    for (const std::size_t number : runs(task)) {
      const SweepRun run = plan_.run(number);
      json values = json::array();
      for (const scenarios::Override& value : plan_.overrides(run.point)) {
        values.push_back({value.pointer, value.value});
      }
      of_task["runs"].push_back({{"values", values}, {"pipeline", plan_.pipelines[run.pipeline]}});
      of_task["seed"] = run.seed;
    }
    return of_task.dump();
  };
  return tasks;
}

void SweepTasks::each_run(
    std::size_t task, const std::string& answer,
    const std::function<void(std::size_t run, const std::string& text)>& keep) const {
  std::size_t begin = 0;
  for (const std::size_t run : runs(task)) {
    const std::size_t end = answer.find(kEndOfRun, begin);
    SIMBENCH_ASSERT(end != std::string::npos, "a text for each run");
    keep(run, answer.substr(begin, end - begin));
    begin = end + 1;
  }
}

TaskWorkerFactory sweep_workers(WorldFactory make_world, ClockWorldFactory make_clocks) {
  return [make_world = std::move(make_world),
          make_clocks = std::move(make_clocks)](const std::string& setup) -> TaskWorker {
    // Shared: std::function copies what it holds.
    auto worker = std::make_shared<SweepWorker>(json::parse(setup), make_world, make_clocks);
    return [worker](const std::string& task) { return worker->work(task); };
  };
}

}  // namespace simbench::evaluation

#include "evaluation/sweep/task_farm.h"

#include <fmt/format.h>

#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "evaluation/sweep/sweep_score.h"

namespace simbench::evaluation {
namespace {

using nlohmann::json;
using scenarios::Scenario;

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

  std::string work(const std::string& text) {
    const json task = json::parse(text);
    try {
      const Scenario& scenario = load(task.at("values"));
      return text_of(clock_period_ ? score_of_clocks(scenario, task) : score(scenario, task));
    } catch (const scenarios::InputError& error) {
      throw scenarios::InputError(with_place(task, error));
    } catch (const std::exception& error) {
      throw std::runtime_error(with_place(task, error));
    }
  }

 private:
  std::string with_place(const json& task, const std::exception& error) const {
    return fmt::format("{} {}: {}", name_, task.dump(), error.what());
  }

  SweepScore score(const Scenario& scenario, const json& task) {
    EvaluationOptions options;
    options.first_seed = task.at("seed");
    options.seeds = 1;
    options.jobs = 1;
    options.pipelines = {task.at("pipeline")};
    const Results results = evaluate(
        scenario, [&] { return make_world_(scenario); }, options, nullptr);
    return sweep_score(results.rows.front());
  }

  SweepScore score_of_clocks(const Scenario& scenario, const json& task) {
    const ClockOptions options = {.duration_s = clock_period_->duration_s,
                                  .from_s = clock_period_->from_s,
                                  .first_seed = task.at("seed"),
                                  .seeds = 1,
                                  .jobs = 1,
                                  .pipelines = {task.at("pipeline")}};
    const ClockResults all = evaluate_clocks(
        scenario, [&] { return make_clocks_(scenario); }, options, nullptr);
    return sweep_score(all.results.rows.front(), ResultKind::kClockRuns);
  }

  const Scenario& load(const json& values) {
    if (scenario_ && values == values_) return *scenario_;
    std::vector<scenarios::Override> overrides;
    for (const json& value : values) overrides.push_back({value.at(0), value.at(1)});
    scenario_ = scenarios::load_scenario_text(scenario_json_, name_, overrides);
    values_ = values;
    return *scenario_;
  }

  std::string name_;
  std::string scenario_json_;
  std::optional<ClockPeriod> clock_period_;
  WorldFactory make_world_;
  ClockWorldFactory make_clocks_;
  std::optional<Scenario> scenario_;
  json values_;
};

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

Tasks sweep_tasks(const SweepPlan& plan, const std::vector<std::size_t>& runs) {
  Tasks tasks;
  json setup = {{"name", plan.scenario}, {"scenario", plan.scenario_json}};
  if (plan.kind == ResultKind::kClockRuns) {
    setup["clocks"] = {{"from_s", plan.clock_period.from_s},
                       {"duration_s", plan.clock_period.duration_s}};
  }
  tasks.setup = setup.dump();
  tasks.count = runs.size();
  tasks.task = [&plan, &runs](std::size_t task) {
    const SweepRun run = plan.run(runs[task]);
    json values = json::array();
    for (const scenarios::Override& value : plan.overrides(run.point)) {
      values.push_back({value.pointer, value.value});
    }
    return json{{"values", values}, {"pipeline", plan.pipelines[run.pipeline]}, {"seed", run.seed}}
        .dump();
  };
  return tasks;
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

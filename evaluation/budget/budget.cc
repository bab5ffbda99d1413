#include "evaluation/budget/budget.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/program_failures.h"
#include "recording/forwarding_sink.h"
#include "scenarios/ideal.h"

namespace simbench::evaluation {
namespace {

constexpr const char* kOracle = "oracle";

bool is_steered(const scenarios::Pipeline& pipeline) { return !pipeline.capture_alignment.empty(); }

bool has_polls(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline) {
  const auto* const device_time =
      find_algorithm<DeviceTimeEntry>(parse_device_time_name(pipeline.device_time).base);
  return scenario.cameras.clock_poll.is_on() && device_time != nullptr &&
         std::ranges::count(device_time->info.needs, Need::kPolls) > 0;
}

// The stages that one of the pipelines has.
StageSet present_stages_of(const scenarios::Scenario& scenario,
                           const std::vector<scenarios::Pipeline>& pipelines) {
  StageSet stages((std::size_t{1} << kCommonStages) - 1);
  for (const scenarios::Pipeline& pipeline : pipelines) {
    if (is_steered(pipeline)) stages = stages.with(BudgetStage::kGranularity);
    if (has_polls(scenario, pipeline)) stages = stages.with(BudgetStage::kPolls);
  }
  return stages;
}

template <class Time>
Time floored(Time time, Nanoseconds quantum) {
  if (quantum.count() == 0) return time;
  const std::int64_t rest_ns = time.time_since_epoch().count() % quantum.count();
  const Nanoseconds above{rest_ns < 0 ? rest_ns + quantum.count() : rest_ns};
  return time - above;
}

// Forwards everything, frames as if they had arrived in the middle of their exposure.
class IdealDelivery final : public ForwardingSink {
 public:
  IdealDelivery(RecordingSink& sink, Nanoseconds quantum)
      : ForwardingSink(sink), quantum_(quantum) {}
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    if (truths.size() != frames.size()) {
      throw std::runtime_error("an ideal delivery needs the truth, which only a simulation has");
    }
    ideal_.assign(frames.begin(), frames.end());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ideal_[i].backend = floored(truths[i].own_host, quantum_);
      ideal_[i].arrival = ideal_[i].backend;
      ideal_[i].arrival_steady = floored(truths[i].own_steady, quantum_);
      ideal_[i].exposure_us = 0;  // no part of it lies between the stamp and the arrival
    }
    sink().on_frames(ideal_, truths);
  }

 private:
  Nanoseconds quantum_;
  std::vector<FrameRecord> ideal_;  // scratch
};

// Whether an ideal delivery leaves the world as it is. It takes away the delays that a user
// measured, which the stages under test alone use; drawn errors of them are part of the world.
bool delivery_is_scoring_alone(const scenarios::CalibrationError& errors) {
  return errors.delay_error_sigma_ms == 0 && errors.camera_delay_error_sigma_ms == 0;
}

// All sets of ideal stages, by world: those that change the pipeline or its scoring alone go
// together, so that they share what they can of the world of the first.
std::vector<std::vector<StageSet>> sets_by_world(const scenarios::Scenario& scenario,
                                                 StageSet all) {
  std::vector<BudgetStage> within = {BudgetStage::kGathering, BudgetStage::kHostClock};
  if (delivery_is_scoring_alone(scenario.cameras.calibration)) {
    within.push_back(BudgetStage::kUsbDelivery);
  }
  std::vector<std::vector<StageSet>> worlds;
  for (std::size_t bits = 0; bits < StageSet::kSets; ++bits) {
    const StageSet first(bits);
    if (first.among(all).bits() != bits) continue;
    if (std::ranges::any_of(within, [&](BudgetStage stage) { return first.has(stage); })) continue;
    std::vector<StageSet>& sets = worlds.emplace_back(1, first);
    for (const BudgetStage stage : within) {
      for (std::size_t i = 0, count = sets.size(); i < count; ++i) {
        sets.push_back(sets[i].with(stage));
      }
    }
  }
  return worlds;
}

scenarios::Pipeline ideal_pipeline(scenarios::Pipeline pipeline, StageSet ideal) {
  if (ideal.has(BudgetStage::kHostClock)) {
    pipeline.host_sync = kOracle;
    pipeline.programs.reset();
  }
  if (ideal.has(BudgetStage::kGathering)) pipeline.gathering = kOracle;
  if (ideal.has(BudgetStage::kTrigger) && is_steered(pipeline))
    pipeline.capture_alignment = kOracle;
  return pipeline;
}

void see_ideal_delivery(const scenarios::Scenario& world, PipelineChoice& choice) {
  const Nanoseconds quantum = from_ms(world.hosts.clock.arrival_quantum_ms);
  choice.view = [quantum](RecordingSink& sink) {
    return std::make_unique<IdealDelivery>(sink, quantum);
  };
}

// The pipelines with sets that go together, set by set; sets with one delivery are neighbours.
std::vector<PipelineChoice> choices_of(const scenarios::Scenario& scenario,
                                       const std::vector<scenarios::Pipeline>& pipelines,
                                       std::span<const StageSet> sets) {
  std::vector<PipelineChoice> choices;
  while (!sets.empty()) {
    const bool ideal = sets.front().has(BudgetStage::kUsbDelivery);
    scenarios::Scenario world = ideal_scenario(scenario, pipelines.front(), sets.front());
    world.pipelines.clear();
    for (; !sets.empty() && sets.front().has(BudgetStage::kUsbDelivery) == ideal;
         sets = sets.subspan(1)) {
      for (const scenarios::Pipeline& pipeline : pipelines) {
        world.pipelines.push_back(ideal_pipeline(pipeline, sets.front()));
      }
    }
    for (PipelineChoice& choice : choose_pipelines(world, {})) {
      choice.scores_offline = false;  // no part of a budget
      if (ideal) see_ideal_delivery(world, choice);
      choices.push_back(std::move(choice));
    }
  }
  return choices;
}

// The scores by world, then by seed.
struct WorldScores {
  using BySeed = std::vector<std::vector<double>>;
  BySeed set_amd_ms = BySeed(StageSet::kSets);
  BySeed amd_ms = BySeed(StageSet::kSets);
  BySeed set_absolute_error_ms = BySeed(StageSet::kSets);
  BySeed absolute_error_ms = BySeed(StageSet::kSets);
  BySeed physical_ms = BySeed(StageSet::kSets);
  std::string failed{};  // the first program that ended in any of the worlds
};

// Stages that are not `present` make no difference.
void repeat_without_absent(StageSet present, WorldScores& scores) {
  for (WorldScores::BySeed* values :
       {&scores.set_amd_ms, &scores.amd_ms, &scores.set_absolute_error_ms,
        &scores.absolute_error_ms, &scores.physical_ms}) {
    for (std::size_t bits = 0; bits < StageSet::kSets; ++bits) {
      const std::size_t same = StageSet(bits).among(present).bits();
      if (same != bits) (*values)[bits] = (*values)[same];
    }
  }
}

void set_scores(StageSet ideal, const Row& row, WorldScores& scores) {
  const std::size_t world = ideal.bits();
  if (scores.failed.empty()) scores.failed = program_failure_text(row);
  for (const SeedScore& seed : row.seeds) {
    scores.set_amd_ms[world].push_back(seed.set_amd_ms);
    scores.set_absolute_error_ms[world].push_back(seed.set_absolute_error_ms);
  }
  scores.amd_ms[world] = row.amd_ms.values;
  scores.absolute_error_ms[world] = row.absolute_error_ms.values;
  scores.physical_ms[world] = row.exposure_spread_ms.values;
}

bool all_exist(const std::vector<std::vector<double>>& values) {
  return std::all_of(values.begin(), values.end(), [](const std::vector<double>& world) {
    return std::none_of(world.begin(), world.end(), [](double value) { return std::isnan(value); });
  });
}

ErrorParts divide(const std::vector<std::vector<double>>& by_world) {
  DividedError divided = divide_error(by_world);
  ErrorParts parts;
  parts.total = std::move(divided.total);
  parts.remainder = std::move(divided.remainder);
  std::ranges::move(divided.players, parts.stages.begin());
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    std::vector<double> won = by_world.front();
    const std::vector<double>& without = by_world[std::size_t{1} << stage];
    for (std::size_t seed = 0; seed < won.size(); ++seed) won[seed] -= without[seed];
    parts.alone[stage] = budget_part(std::move(won));
  }
  return parts;
}

Budget budget_of(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline,
                 const WorldScores& scores) {
  Budget budget;
  budget.pipeline = pipeline.name;
  budget.is_steered = is_steered(pipeline);
  budget.has_polls = has_polls(scenario, pipeline);
  budget.failed = scores.failed;
  if (!budget.failed.empty()) return budget;
  budget.amd_of_sets = all_exist(scores.set_absolute_error_ms);  // of one camera too
  budget.amd_ms = divide(budget.amd_of_sets ? scores.set_amd_ms : scores.amd_ms);
  budget.absolute_error_ms =
      divide(budget.amd_of_sets ? scores.set_absolute_error_ms : scores.absolute_error_ms);
  budget.physical_ms = divide(scores.physical_ms);
  return budget;
}

}  // namespace

scenarios::Scenario ideal_scenario(const scenarios::Scenario& scenario,
                                   const scenarios::Pipeline& pipeline, StageSet ideal) {
  std::vector<std::string_view> stages;
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    if (ideal.has(static_cast<BudgetStage>(stage))) stages.push_back(kStageNames[stage]);
  }
  scenarios::Scenario world = scenarios::with_ideal_stages(scenario, stages);
  world.pipelines = {ideal_pipeline(pipeline, ideal)};
  world.published.clear();
  return world;
}

std::vector<BudgetStage> budget_stages(const Budget& budget) {
  std::vector<BudgetStage> stages;
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    const auto each = static_cast<BudgetStage>(stage);
    const bool is_absent = (each == BudgetStage::kGranularity && !budget.is_steered) ||
                           (each == BudgetStage::kPolls && !budget.has_polls);
    if (!is_absent) stages.push_back(each);
  }
  return stages;
}

std::string_view stage_name(const Budget& budget, BudgetStage stage) {
  if (stage == BudgetStage::kTrigger && budget.is_steered) return "phase";
  return kStageNames[static_cast<std::size_t>(stage)];
}

std::size_t stage_sets(const scenarios::Scenario& scenario,
                       const std::vector<scenarios::Pipeline>& pipelines) {
  return std::size_t{1} << std::popcount(present_stages_of(scenario, pipelines).bits());
}

std::vector<Budget> error_budgets(const scenarios::Scenario& scenario,
                                  const std::vector<scenarios::Pipeline>& pipelines,
                                  const WorldFactory& make_world, const EvaluationOptions& options,
                                  const Progress& progress) {
  if (pipelines.empty()) return {};
  EvaluationOptions of_worlds = options;
  of_worlds.keep_pulses = false;
  of_worlds.share_captures = true;
  const StageSet present = present_stages_of(scenario, pipelines);
  const std::uint64_t total = stage_sets(scenario, pipelines) * pipelines.size() * options.seeds;
  std::vector<WorldScores> scores(pipelines.size());
  std::uint64_t done_before = 0;
  for (const std::vector<StageSet>& sets : sets_by_world(scenario, present)) {
    const scenarios::Scenario world = ideal_scenario(scenario, pipelines.front(), sets.front());
    const Results results = evaluate_choices(
        world, choices_of(scenario, pipelines, sets), [&] { return make_world(world); }, of_worlds,
        [&](std::uint64_t done, std::uint64_t) {
          if (progress) progress(done_before + done, total);
        });
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
      set_scores(sets[i / pipelines.size()], results.rows[i], scores[i % pipelines.size()]);
    }
    done_before += results.rows.size() * options.seeds;
  }
  std::vector<Budget> budgets;
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    repeat_without_absent(present, scores[i]);
    budgets.push_back(budget_of(scenario, pipelines[i], scores[i]));
  }
  return budgets;
}

}  // namespace simbench::evaluation

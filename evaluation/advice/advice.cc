#include "evaluation/advice/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/budget/budget.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using scenarios::Pipeline;
using scenarios::Scenario;

bool meets_all(const std::vector<Requirement>& requirements, const SeedScore& seed) {
  return seed.recorded && std::ranges::all_of(requirements, [&](const Requirement& requirement) {
           return requirement.is_met_by(requirement.metric->of_seed(seed));
         });
}

PipelineAdvice judged(const Pipeline& pipeline, const Row& row,
                      const std::vector<Requirement>& requirements) {
  PipelineAdvice advice{.pipeline = pipeline,
                        .seeds = static_cast<std::int64_t>(row.seeds.size()),
                        .frames_dropped = row.frames.dropped};
  advice.met = std::ranges::count_if(
      row.seeds, [&](const SeedScore& seed) { return meets_all(requirements, seed); });
  for (const Requirement& requirement : requirements) {
    const Series& series = requirement.metric->series(row);
    const double bad = requirement.bad_quantile(series.values, kWantedShare);
    advice.median.push_back(series.median);
    advice.bad_quantile.push_back(bad);
    const double margin = requirement.margin_of(bad);
    if (std::isnan(advice.margin) || margin < advice.margin) advice.margin = margin;
  }
  return advice;
}

// Fit ones first, in their order; of the others the one that comes nearest.
void sort_by_merit(std::vector<PipelineAdvice>& pipelines) {
  std::ranges::stable_sort(pipelines, [](const PipelineAdvice& a, const PipelineAdvice& b) {
    if (a.is_fit() || b.is_fit()) return a.is_fit() && !b.is_fit();
    if (a.met * b.seeds != b.met * a.seeds) return a.met * b.seeds > b.met * a.seeds;
    return a.margin > b.margin;
  });
}

class Adviser {
 public:
  Adviser(const AdviceRequest& request, const WorldFactory& make_world,
          const AdviceOptions& options, const Progress& progress)
      : make_world_(make_world),
        progress_(progress),
        advice_{.request = request, .options_of_run = options} {
    AdviceOptions& run = advice_.options_of_run;
    run.screening_seeds = std::min(run.screening_seeds, run.seeds);
  }

  Advice run() {
    std::vector<RigOption> options = rig_options(advice_.request.rig);
    // Screening, some settled, the budget.
    total_ = options.size() + kWantedOptions + 1;
    for (RigOption& option : options) {
      advice_.options.push_back({.option = std::move(option)});
      OptionAdvice& added = advice_.options.back();
      evaluate_option(added, candidate_pipelines(added.option, advice_.request),
                      advice_.options_of_run.screening_seeds);
    }
    settle();
    find_what_fails_first();
    done_ = total_ - 1;
    count();
    return std::move(advice_);
  }

 private:
  void count() {
    ++done_;
    if (progress_) progress_(std::min(done_, total_), total_);
  }

  void evaluate_option(OptionAdvice& option, const std::vector<Pipeline>& pipelines,
                       std::uint64_t seeds) {
    const Scenario scenario = scenario_of(option.option, advice_.request.rig, pipelines);
    const AdviceOptions& options = advice_.options_of_run;
    const Results results = evaluate(
        scenario, [&] { return make_world_(scenario); },
        {.first_seed = options.first_seed,
         .seeds = seeds,
         .jobs = options.jobs,
         .share_captures = true,
         .cancel = options.cancel},
        nullptr);
    option.pipelines.clear();
    for (std::size_t i = 0; i < pipelines.size(); ++i) {
      option.pipelines.push_back(
          judged(pipelines[i], results.rows[i], advice_.request.requirements));
    }
    sort_by_merit(option.pipelines);
    option.is_settled = seeds >= options.seeds;
    count();
  }

  // From the cheapest on: all seeds for what may meet the requirements.
  void settle() {
    std::size_t wanted = kWantedOptions;
    for (std::size_t i = 0; i < advice_.options.size() && wanted > 0; ++i) {
      OptionAdvice& option = advice_.options[i];
      const std::vector<Pipeline> promising = promising_pipelines(option);
      if (promising.empty()) continue;
      if (!option.is_settled) evaluate_option(option, promising, advice_.options_of_run.seeds);
      if (!option.best().is_fit()) continue;
      if (!advice_.recommended) advice_.recommended = i;
      --wanted;
    }
  }

  // Those whose screening does not speak against 95 %, in their order of preference.
  std::vector<Pipeline> promising_pipelines(const OptionAdvice& option) const {
    std::vector<Pipeline> promising;
    for (const Pipeline& pipeline : candidate_pipelines(option.option, advice_.request)) {
      const auto found = std::ranges::find_if(option.pipelines, [&](const PipelineAdvice& each) {
        return each.pipeline.name == pipeline.name;
      });
      if (found->may_be_fit()) {
        promising.push_back(pipeline);
      }
    }
    return promising;
  }

  void find_what_fails_first() {
    if (!advice_.recommended) return;
    const OptionAdvice& option = advice_.options[*advice_.recommended];
    const Pipeline& pipeline = option.best().pipeline;
    const Scenario scenario = scenario_of(option.option, advice_.request.rig, {pipeline});
    const AdviceOptions& options = advice_.options_of_run;
    const Budget budget = error_budgets(scenario, {pipeline}, make_world_,
                                        {.first_seed = options.first_seed,
                                         .seeds = kBudgetSeeds,
                                         .jobs = options.jobs,
                                         .cancel = options.cancel},
                                        nullptr)
                              .front();
    // AMD but where another is asked for, or there is a single camera.
    const std::string_view asked = advice_.request.requirements.front().metric->id;
    const bool is_error = std::isnan(budget.amd_ms.total.mean) || asked == "absolute_error_ms";
    const bool is_spread = asked.starts_with("exposure_spread");
    const ErrorParts& parts = is_error    ? budget.absolute_error_ms
                              : is_spread ? budget.physical_ms
                                          : budget.amd_ms;
    const auto largest = std::ranges::max_element(parts.stages, {}, &BudgetPart::mean);
    advice_.fails_first = {.metric = is_error    ? "absolute error"
                                     : is_spread ? "exposure spread"
                                                 : "AMD",
                           .stage = std::string(stage_name(
                               budget, static_cast<BudgetStage>(largest - parts.stages.begin()))),
                           .share = largest->mean / parts.total.mean};
  }

  const WorldFactory& make_world_;
  const Progress& progress_;
  Advice advice_;
  std::uint64_t done_ = 0;
  std::uint64_t total_ = 0;
};

void check_request(const AdviceRequest& request) {
  if (request.rig.cameras > 1) return;
  for (const Requirement& requirement : request.requirements) {
    const std::string_view id = requirement.metric->id;
    if (id == "amd_ms" || id == "rmdv_ms" || id == "set_amd_ms" || id == "exposure_spread_ms") {
      throw scenarios::InputError(
          fmt::format("--require: found '{}' of a single camera, allowed what does not compare "
                      "cameras; {} does",
                      requirement.text, requirement.metric->title));
    }
  }
}

}  // namespace

std::vector<Pipeline> candidate_pipelines(const RigOption& option, const AdviceRequest& request) {
  std::vector<Pipeline> pipelines;
  const scenarios::Part& camera = option.camera;
  const std::vector<std::string> alignments =
      camera.capture_alignment.empty() ? std::vector<std::string>{""} : camera.capture_alignment;
  for (const std::string& host_sync : option.host_sync()) {
    for (const std::string& alignment : alignments) {
      for (const std::string& device_time : camera.device_time) {
        for (const std::string& gathering : advice_gatherings(request.requirements)) {
          Pipeline& pipeline = pipelines.emplace_back(Pipeline{.name = "",
                                                               .host_sync = host_sync,
                                                               .device_time = device_time,
                                                               .gathering = gathering,
                                                               .capture_alignment = alignment});
          pipeline.name = joined_stages(pipeline, ".");
        }
      }
    }
  }
  return pipelines;
}

std::vector<std::string> advice_gatherings(const std::vector<Requirement>& requirements) {
  const bool is_about_sets = std::ranges::any_of(requirements, [](const Requirement& each) {
    return each.metric->needs == Needs::kVerifiedSets ||
           std::string_view(each.metric->json_in) == kInGathering;
  });
  if (!is_about_sets) return {"yoon2021"};
  return {"yoon2021", "approximate_time_bounded", "epsilon"};
}

Advice advise(const AdviceRequest& request, const WorldFactory& make_world,
              const AdviceOptions& options, const Progress& progress) {
  check_request(request);
  return Adviser(request, make_world, options, progress).run();
}

}  // namespace simbench::evaluation

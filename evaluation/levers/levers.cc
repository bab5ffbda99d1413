#include "evaluation/levers/levers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "evaluation/answer/standing.h"
#include "evaluation/levers/rig_changes.h"
#include "evaluation/run/ad_hoc_pipelines.h"

namespace simbench::evaluation {
namespace {

using scenarios::Override;
using scenarios::Pipeline;
using scenarios::Scenario;

constexpr std::size_t kMostVerifiedChanges = 3;
constexpr std::size_t kSecondRound = 3;  // of a stage

// Something to try: a pipeline in the world that `sets` make.
struct Trial {
  std::string what;
  Pipeline pipeline;
  std::vector<Override> sets{};
  bool calibrates = false;
};

// What a row is judged by.
struct Value {
  double ranked = kNan;
  double missing = kNan;
};

Value value_of(const Row& row, RankedBy ranked_by) {
  return {ranked_series(row, ranked_by).median, missing_share(row)};
}

// Whether a screened row is worth a verification.
bool is_promising(const Value& value, const Value& before) {
  return value.missing < before.missing * (1 - kSmallestGain) ||
         (value.ranked < before.ranked * (1 - kSmallestGain) && !(value.missing > before.missing));
}

// The order of what is promising: pulses first, then what is ranked.
bool is_better(const Value& a, const Value& b) {
  const double a_missing = std::isnan(a.missing) ? 0 : a.missing;
  const double b_missing = std::isnan(b.missing) ? 0 : b.missing;
  return a_missing != b_missing ? a_missing < b_missing : a.ranked < b.ranked;
}

// A calibration and the SDK's stamps stay as `as` has them: a user cannot do without the second,
// and the first is a lever of its own.
std::vector<std::string> variants_of(const std::string& base, const DeviceTimeName& as) {
  std::vector<std::string> names;
  const std::string end = std::string(as.sdk ? "_sdk" : "") + (as.calibrated ? "_calibrated" : "");
  for (const char* steady : {"", "_steady"}) {
    if (as.sdk && *steady != '\0') continue;
    for (const char* exposure : {"", "_exposure_corrected"}) {
      if (as.calibrated && *exposure != '\0') continue;
      names.push_back(fmt::format("{}{}{}{}", base, steady, exposure, end));
    }
  }
  return names;
}

bool has_calibration(const Pipeline& pipeline) {
  return parse_device_time_name(pipeline.device_time).calibrated;
}

// A base with its variants and, where the best has no calibration, with one.
std::vector<std::string> all_variants_of(const std::string& base, const Pipeline& best) {
  DeviceTimeName as = parse_device_time_name(best.device_time);
  std::vector<std::string> names = variants_of(base, as);
  if (!as.calibrated) {
    as.calibrated = true;
    std::ranges::move(variants_of(base, as), std::back_inserter(names));
  }
  return names;
}

Trial trial_of(PipelineStage stage, const std::string& name, const Pipeline& best) {
  Trial trial{.what = std::string(name_of(stage)) + " " + name, .pipeline = best};
  at_stage(trial.pipeline, stage) = name;
  trial.calibrates = has_calibration(trial.pipeline) != has_calibration(best);
  if (trial.calibrates) trial.what += " (delays measured once)";
  return trial;
}

// Each algorithm in its place, device_time with the suffixes of the best.
std::vector<Trial> algorithm_trials(const Pipeline& best, bool needs_pulses) {
  std::vector<Trial> trials;
  const DeviceTimeName device_time = parse_device_time_name(best.device_time);
  const std::string suffixes = best.device_time.substr(device_time.base.size());
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& now = at_stage(best, stage.id);
    if (now.empty() || (stage.id == PipelineStage::kGathering && !needs_pulses)) continue;
    for (const AlgorithmInfo* info : own_algorithms_of(stage.id)) {
      const bool has_suffixes = stage.id == PipelineStage::kDeviceTime;
      const std::string name = info->name + (has_suffixes ? suffixes : "");
      if (name != now) trials.push_back(trial_of(stage.id, name, best));
    }
  }
  return trials;
}

const StageInfo& stage_that_differs(const Pipeline& a, const Pipeline& b) {
  return *std::ranges::find_if(kPipelineStages, [&](const StageInfo& stage) {
    return at_stage(a, stage.id) != at_stage(b, stage.id);
  });
}

// A search for the levers of one pipeline.
class LeverSearch {
 public:
  LeverSearch(const Scenario& scenario, const Results& results, const Row& best,
              const WorldFactory& make_world, const LeverOptions& options, const Progress& progress)
      : scenario_(scenario),
        results_(results),
        best_(best),
        ranked_by_(ranking_of(results)),
        make_world_(make_world),
        options_(options),
        caller_(progress),
        changes_(rig_changes(scenario)) {}

  std::optional<Levers> run() {
    const auto found = std::ranges::find(scenario_.pipelines, best_.pipeline, &Pipeline::name);
    if (found == scenario_.pipelines.end() || found->programs) return std::nullopt;
    if (!plan_seeds()) return std::nullopt;
    all_ = expected_runs();
    screen_algorithms(*found);
    screen_changes(*found);
    verify();
    if (caller_) caller_(all_, all_);
    return std::move(levers_);
  }

 private:
  struct Screened {
    Trial trial;
    Value value;
  };

  // As many seeds as are cheap, going by the events of a mean run; false: not even one is.
  bool plan_seeds() {
    const std::uint64_t runs = results_.rows.size() * results_.seed_count;
    if (runs == 0 || results_.performance.events == 0) return false;
    const double of_run =
        static_cast<double>(results_.performance.events) / static_cast<double>(runs);
    // Screened host synchronisations have captures of their own.
    const auto captures = static_cast<double>(own_algorithms_of(PipelineStage::kHostSync).size()) +
                          static_cast<double>(rig_changes(scenario_).size());
    screening_seeds_ = kScreeningLeverSeeds;
    while (screening_seeds_ > 0 &&
           static_cast<double>(screening_seeds_) * captures * of_run > options_.most_events / 2) {
      --screening_seeds_;
    }
    const double affordable =
        options_.most_events / 2 / of_run / static_cast<double>(kMostVerified);
    levers_.seeds = std::min({kMostLeverSeeds, results_.seed_count,
                              static_cast<std::uint64_t>(std::min(affordable, 1e6))});
    return screening_seeds_ > 0 && levers_.seeds > 0;
  }

  EvaluationOptions screening() const {
    return {.first_seed = results_.first_seed + results_.seed_count,
            .seeds = screening_seeds_,
            .jobs = options_.jobs,
            .share_captures = true};
  }

  // About as many as there will be.
  std::uint64_t expected_runs() const {
    std::uint64_t algorithms = 0;
    for (const StageInfo& stage : kPipelineStages) algorithms += own_algorithms_of(stage.id).size();
    constexpr std::uint64_t kOfSecondRound = 30;
    return algorithms + screening_seeds_ * (kOfSecondRound + changes_.size()) +
           levers_.seeds * kMostVerified;
  }

  Progress progress() const {
    if (!caller_) return {};
    return
        [this](std::uint64_t done, std::uint64_t) { caller_(std::min(done_ + done, all_), all_); };
  }

  // The row may have failed, or be one that a rig cannot run (or not while it captures).
  bool is_comparable(const Row& row) const {
    return standing_of(row, ranked_by_).is == RowStanding::kRanked &&
           (best_.offline || !row.offline);
  }

  // A smaller spread does not count if the stamps or the clocks are worse for it.
  static bool is_sound(const Row& row, const Row& before) {
    const double most = 1 + kSmallestGain;
    return !(row.absolute_error_ms.median > most * before.absolute_error_ms.median) &&
           !(row.host_error_ms.median > most * before.host_error_ms.median);
  }

  // Chooses what this world can run; all have the name, and so the load, of the best.
  std::vector<PipelineChoice> choices_of(const Pipeline& best, std::vector<Trial>& trials) const {
    Scenario world = scenario_;
    world.pipelines = {best};
    std::vector<PipelineChoice> choices = choose_pipelines(world, {});
    std::erase_if(trials, [&](const Trial& trial) {
      world.pipelines = {trial.pipeline};
      try {
        choices.push_back(std::move(choose_pipelines(world, {}).front()));
        return false;
      } catch (const scenarios::InputError&) {
        return true;
      }
    });
    for (PipelineChoice& choice : choices) choice.scores_offline = false;
    return choices;
  }

  // The rows of trials in the world as it is, those that can be compared, the best first. The value
  // of the best pipeline over these seeds is then before_.
  std::vector<Screened> screened(const Pipeline& best, std::vector<Trial> trials,
                                 const EvaluationOptions& options) {
    std::vector<PipelineChoice> choices = choices_of(best, trials);
    const Results results = evaluate_choices(
        scenario_, std::move(choices), [this] { return make_world_(scenario_); }, options,
        progress());
    done_ += options.seeds * results.rows.size();
    before_row_ = results.rows.front();
    before_ = value_of(before_row_, ranked_by_);
    std::vector<Screened> rows;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      tried_.insert(joined_stages(trials[i].pipeline, "+"));
      const Row& row = results.rows[i + 1];
      if (!is_comparable(row) || !is_sound(row, before_row_)) continue;
      rows.push_back({std::move(trials[i]), value_of(row, ranked_by_)});
    }
    std::ranges::stable_sort(rows, is_better, &Screened::value);
    return rows;
  }

  // All algorithms at one seed, then the first of each stage, device_time with its variants, at
  // more.
  void screen_algorithms(const Pipeline& best) {
    EvaluationOptions one = screening();
    one.seeds = 1;
    const bool needs_pulses = missing_share(best_) > 0;
    std::vector<Screened> first = screened(best, algorithm_trials(best, needs_pulses), one);
    std::vector<Screened> promising = screened(best, second_round(best, first), screening());
    std::erase_if(promising,
                  [this](const Screened& each) { return !is_promising(each.value, before_); });
    levers_.algorithms = tried_.size();
    keep_best_of_each(best, std::move(promising));
  }

  static std::vector<Trial> second_round(const Pipeline& best, const std::vector<Screened>& first) {
    std::map<PipelineStage, std::size_t> kept;
    std::set<std::string> bases = {parse_device_time_name(best.device_time).base};
    std::vector<Trial> trials;
    for (const Screened& each : first) {
      const StageInfo& stage = stage_that_differs(each.trial.pipeline, best);
      if (++kept[stage.id] > kSecondRound) continue;
      if (stage.id == PipelineStage::kDeviceTime) {
        bases.insert(parse_device_time_name(each.trial.pipeline.device_time).base);
      } else {
        trials.push_back(each.trial);
      }
    }
    for (const std::string& base : bases) {
      for (const std::string& name : all_variants_of(base, best)) {
        if (name != best.device_time) {
          trials.push_back(trial_of(PipelineStage::kDeviceTime, name, best));
        }
      }
    }
    return trials;
  }

  // The best of each stage, a calibrated one if it is better than all without, and the first two
  // together.
  void keep_best_of_each(const Pipeline& best, std::vector<Screened> promising) {
    std::map<PipelineStage, Value> kept;
    for (Screened& each : promising) {
      if (each.trial.calibrates) continue;
      const PipelineStage stage = stage_that_differs(each.trial.pipeline, best).id;
      if (kept.emplace(stage, each.value).second) to_verify_.push_back(std::move(each.trial));
    }
    add_both(best);
    const Value& uncalibrated = kept.emplace(PipelineStage::kDeviceTime, before_).first->second;
    const auto calibrated =
        std::ranges::find_if(promising, [](const Screened& each) { return each.trial.calibrates; });
    if (calibrated != promising.end() && is_promising(calibrated->value, uncalibrated)) {
      to_verify_.push_back(std::move(calibrated->trial));
    }
  }

  // The best host_sync and the best uncalibrated device_time together.
  void add_both(const Pipeline& best) {
    const Trial* host_sync = nullptr;
    const Trial* device_time = nullptr;
    for (const Trial& each : to_verify_) {
      if (each.pipeline.host_sync != best.host_sync) host_sync = &each;
      if (each.pipeline.device_time != best.device_time && !each.calibrates) device_time = &each;
    }
    if (host_sync == nullptr || device_time == nullptr) return;
    Trial both{.what = host_sync->what + " and " + device_time->what, .pipeline = best};
    both.pipeline.host_sync = host_sync->pipeline.host_sync;
    both.pipeline.device_time = device_time->pipeline.device_time;
    to_verify_.push_back(std::move(both));
  }

  static std::vector<Trial> trials_of(const RigChange& change, const Pipeline& best) {
    std::vector<Trial> trials;
    for (const std::string& host_sync : change.host_sync) {
      Trial& trial = trials.emplace_back(Trial{.what = change.what + " with host_sync " + host_sync,
                                               .pipeline = best,
                                               .sets = change.sets});
      trial.pipeline.host_sync = host_sync;
    }
    if (trials.empty()) trials = {{.what = change.what, .pipeline = best, .sets = change.sets}};
    return trials;
  }

  void screen_changes(const Pipeline& best) {
    std::vector<Screened> promising;
    for (const RigChange& change : changes_) {
      bool is_tried = false;
      for (Trial& trial : trials_of(change, best)) {
        const std::optional<Row> row = row_of(trial, screening(), /*keeps_name=*/true);
        if (!row) continue;
        is_tried = true;
        const Value value = value_of(*row, ranked_by_);
        if (!is_comparable(*row) || !is_sound(*row, before_row_) || !is_promising(value, before_)) {
          continue;
        }
        promising.push_back({std::move(trial), value});
      }
      if (is_tried) ++levers_.changes;
    }
    std::ranges::stable_sort(promising, is_better, &Screened::value);
    promising.resize(std::min(promising.size(), kMostVerifiedChanges));
    for (Screened& each : promising) to_verify_.push_back(std::move(each.trial));
  }

  // A user's run of the change. Nothing if the world forbids it.
  std::optional<Row> row_of(Trial& trial, EvaluationOptions options, bool keeps_name) {
    const bool is_as_before = joined_stages(best_, "+") == joined_stages(trial.pipeline, "+");
    std::vector<Override> sets = trial.sets;
    if (!is_as_before) {
      if (!keeps_name) trial.pipeline.name = joined_stages(trial.pipeline, "+");
      sets.push_back(
          keeps_name ? Override{"/pipelines", fmt::format("[{}]", pipeline_json(trial.pipeline))}
                     : Override{"/pipelines/-", pipeline_json(trial.pipeline)});
    }
    options.pipelines = {trial.pipeline.name};
    try {
      const Scenario world =
          scenarios::load_scenario_text(scenario_.resolved_json(), scenario_.name, sets);
      Results results = evaluate(
          world, [&] { return make_world_(world); }, options, progress());
      done_ += options.seeds;
      return std::move(results.rows.front());
    } catch (const scenarios::InputError&) {
      return std::nullopt;
    }
  }

  void verify() {
    EvaluationOptions options = screening();
    options.first_seed = results_.first_seed;
    options.seeds = levers_.seeds;
    std::vector<double> before = ranked_series(best_, ranked_by_).values;
    before.resize(levers_.seeds);
    std::vector<Lever> levers;
    std::vector<ComparisonTask> tasks;
    for (Trial& trial : to_verify_) {
      const std::optional<Row> row = row_of(trial, options, /*keeps_name=*/false);
      if (!row || !is_comparable(*row) || !is_sound(*row, best_)) continue;
      const Series& after = ranked_series(*row, ranked_by_);
      tasks.push_back({pair_up(before, after.values), {}});
      levers.push_back({.what = trial.what,
                        .pipeline = trial.pipeline.name,
                        .sets = trial.sets,
                        .from = make_series(before).median,
                        .to = after.median,
                        .missing_from = missing_share(best_),
                        .missing_to = missing_share(*row)});
    }
    const std::vector<PairedComparison> effects = compare_together(tasks);
    for (std::size_t i = 0; i < levers.size(); ++i) levers[i].effect = effects[i];
    keep_effective(std::move(levers));
  }

  void keep_effective(std::vector<Lever> levers) {
    std::erase_if(levers, [](const Lever& lever) {
      const bool is_closer =
          lever.effect.verdict == Verdict::kBetter && lever.to < lever.from * (1 - kSmallestGain);
      return !lever.finds_pulses() && (!is_closer || lever.missing_to > lever.missing_from);
    });
    std::ranges::stable_sort(levers, [](const Lever& a, const Lever& b) {
      return is_better({a.to, a.missing_to}, {b.to, b.missing_to});
    });
    levers_.effective = std::move(levers);
  }

  const Scenario& scenario_;
  const Results& results_;
  const Row& best_;
  const RankedBy ranked_by_;
  const WorldFactory& make_world_;
  const LeverOptions& options_;
  const Progress& caller_;
  const std::vector<RigChange> changes_;
  std::uint64_t screening_seeds_ = 0;
  std::uint64_t done_ = 0;  // runs before those that are under way
  std::uint64_t all_ = 0;   // runs, about
  Row before_row_;          // the best over the screening seeds
  Value before_;
  std::set<std::string> tried_;
  std::vector<Trial> to_verify_;
  Levers levers_;
};

}  // namespace

double missing_share(const Row& row) {
  if (!row.verified() || row.sets.due_pulses == 0) return kNan;
  return 1 - static_cast<double>(row.sets.pure) / static_cast<double>(row.sets.due_pulses);
}

std::optional<Levers> find_levers(const Scenario& scenario, const Results& results, const Row& best,
                                  const WorldFactory& make_world, const LeverOptions& options,
                                  const Progress& progress) {
  try {
    return LeverSearch(scenario, results, best, make_world, options, progress).run();
  } catch (const EvaluationCancelled&) {
    throw;
  } catch (const EvaluationFailed& failure) {
    return Levers{.problem = failure.what()};
  } catch (const scenarios::InputError& error) {
    return Levers{.problem = error.what()};
  }
}

}  // namespace simbench::evaluation

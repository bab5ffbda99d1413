#include "evaluation/clock_run/clock_evaluation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "algorithms/ports/host_sync.h"
#include "evaluation/run/jobs.h"
#include "evaluation/run/part_progress.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/program_failures.h"
#include "evaluation/scoring/rows.h"
#include "evaluation/statistics/statistics.h"
#include "scenarios/loader.h"
#include "scenarios/reality.h"

namespace simbench::evaluation {
namespace {

using scenarios::Scenario;

constexpr std::uint64_t kFewestReadings = 4;

// What the host_sync needs that hosts without cameras do not have; null if nothing.
const char* lacking_world(const PipelineChoice& choice) {
  for (const Need need : choice.host_sync.info().needs) {
    if (need == Need::kFrames) return "the frames of cameras";
    if (need == Need::kTriggerLine) return "the trigger's pulses";
  }
  return nullptr;
}

struct Chosen {
  std::vector<PipelineChoice> choices{};
  std::vector<std::string> left_out{};           // notes on these
  std::vector<std::string> programs_left_out{};  // names of those of programs
};

Chosen choose_clock_runs(const Scenario& scenario, const std::vector<std::string>& names) {
  Chosen chosen;
  for (PipelineChoice& choice : choose_pipelines(scenario, names)) {
    const bool is_known =
        std::any_of(chosen.choices.begin(), chosen.choices.end(), [&](const PipelineChoice& other) {
          return other.pipeline.host_sync == choice.pipeline.host_sync &&
                 other.pipeline.programs == choice.pipeline.programs;
        });
    if (names.empty() && is_known) continue;
    if (!choice.problem.empty()) {
      chosen.left_out.push_back(
          fmt::format("pipeline {}: {}; left out", choice.pipeline.name, choice.problem));
      chosen.programs_left_out.push_back(choice.pipeline.name);
      continue;
    }
    if (const char* what = lacking_world(choice)) {
      const std::string problem = fmt::format(
          "pipeline {}: host_sync \"{}\" needs {}, which a run of the clocks alone does "
          "not have",
          choice.pipeline.name, choice.pipeline.host_sync, what);
      if (!names.empty()) throw scenarios::InputError("--pipelines: " + problem);
      chosen.left_out.push_back(problem + "; left out");
      continue;
    }
    chosen.choices.push_back(std::move(choice));
  }
  return chosen;
}

ClockSpan span_of(const Scenario& scenario, const ClockOptions& options) {
  return {.duration = std::chrono::seconds(options.duration_s),
          .from = std::chrono::seconds(options.from_s),
          .hosts = static_cast<std::size_t>(scenario.hosts.count),
          .pairs_with = options.pairs_with};
}

HostTe median_te_of(const std::vector<HostTe>& seeds) {
  const auto median_te = [&seeds](double HostTe::*value) {
    std::vector<double> values;
    values.reserve(seeds.size());
    for (const HostTe& seed : seeds) values.push_back(seed.*value);
    return median(std::move(values));
  };
  return {.median_ms = median_te(&HostTe::median_ms),
          .median_abs_ms = median_te(&HostTe::median_abs_ms),
          .p95_abs_ms = median_te(&HostTe::p95_abs_ms),
          .sd_ms = median_te(&HostTe::sd_ms)};
}

class ClockEvaluation {
 public:
  ClockEvaluation(const Scenario& scenario, const ClockSourceFactory& make_source,
                  const ClockOptions& options, const Progress& progress)
      : scenario_(scenario),
        make_source_(make_source),
        options_(options),
        progress_(progress),
        chosen_(choose_clock_runs(scenario, options.pipelines)),
        order_(programs_first(of_programs())),
        parts_(progress, part_plan(of_programs(), options.seeds, worker_count(options.jobs))),
        jobs_(chosen_.choices.size() * options.seeds) {}

  ClockResults run() {
    const auto begin = std::chrono::steady_clock::now();
    bool finished = false;
    try {
      finished = run_jobs_with_workers(
          jobs_.size(), {.threads = options_.jobs, .cancel = options_.cancel}, [this]() -> Job {
            return [this,
                    worker = std::make_shared<TimedWorker<ClockSource>>(cpu_time_, make_source_)](
                       std::size_t job) { run_job(job, *worker->source); };
          });
    } catch (const RecordingCancelled&) {
      finished = false;
    } catch (const JobFailed& error) {
      throw EvaluationFailed(error.what(), {});
    }
    if (!finished) throw EvaluationCancelled("cancelled", {});
    ClockResults all = results();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    Performance& performance = all.results.performance;
    performance.cpu_seconds = cpu_time_.seconds();
    performance.wall_seconds = wall.count();
    performance.events_per_second = static_cast<double>(performance.events) / wall.count();
    performance.simulated_seconds_per_second = performance.simulated_seconds / wall.count();
    return all;
  }

 private:
  struct Scored {
    SeedScore seed;
    StabilityCurves curves;
    HostTimeErrors hosts;
    std::optional<ClockReadings> readings;  // of the first seed
  };

  std::vector<bool> of_programs() const {
    std::vector<bool> found;
    for (const PipelineChoice& choice : chosen_.choices) {
      found.push_back(choice.pipeline.programs.has_value());
    }
    return found;
  }

  void run_job(std::size_t job, ClockSource& source) {
    const std::size_t pipelines = chosen_.choices.size();
    const std::size_t place = order_[job % pipelines];
    const PipelineChoice& choice = chosen_.choices[place];
    const std::uint64_t seed = options_.first_seed + job / pipelines;
    parts_.begin(job);
    run_named({scenario_.name, choice.pipeline.name, seed}, [&] {
      jobs_[job / pipelines * pipelines + place] =
          score_of(choice, seed, source, parts_.share_of(job));
    });
    parts_.end(job);
    const std::lock_guard lock(mutex_);
    if (progress_) progress_(++done_, jobs_.size());
  }

  Scored score_of(const PipelineChoice& choice, std::uint64_t seed, ClockSource& source,
                  const ShareDone& share_done) const {
    const std::unique_ptr<HostSync> host_sync = choice.host_sync.make();
    const ClockSpan span = span_of(scenario_, options_);
    ClockScorer scorer(span);
    const ClockCost cost = source.run({.seed = seed,
                                       .pipeline = choice.pipeline.name,
                                       .host_sync = host_sync.get(),
                                       .duration = span.duration,
                                       .interval = kReadingInterval,
                                       .master_lost_for = lost_for(),
                                       .recovery = recovery(),
                                       .cancel = options_.cancel,
                                       .share_done = share_done},
                                      scorer);
    ClockScore score = scorer.finish(cost.messages);
    Scored scored;
    static_cast<MetricValues<double>&>(scored.seed) = score.values;
    scored.seed.seed = seed;
    scored.seed.host_errors_ms = std::move(score.host_errors_ms);
    scored.seed.failures = std::move(score.failures);
    scored.seed.program_failures = std::move(score.program_failures);
    scored.seed.cost = {.events = cost.events,
                        .simulated_seconds = to_seconds(span.duration + lost_for() + recovery()),
                        .trace_hash = cost.trace_hash,
                        .notes = host_sync->notes()};
    void_score(scored.seed);
    scored.curves = std::move(score.curves);
    scored.hosts = {.to_truth = std::move(score.to_truth), .pairs = std::move(score.pairs)};
    if (seed == options_.first_seed) scored.readings = std::move(score.readings);
    return scored;
  }

  Nanoseconds lost_for() const { return options_.loses_master ? kMasterLostFor : Nanoseconds(0); }
  Nanoseconds recovery() const { return options_.loses_master ? kRecovery : Nanoseconds(0); }

  ClockResults results() {
    ClockResults all;
    Results& results = all.results;
    results.kind = ResultKind::kClockRuns;
    results.ranked_by = RankedBy::kClockSpread;
    results.clock_period = {.from_s = options_.from_s, .duration_s = options_.duration_s};
    results.scenario = scenario_.name;
    results.derivation = scenario_.derivation;
    results.draws_load = scenario_.draws_load();
    results.first_seed = options_.first_seed;
    results.seed_count = options_.seeds;
    results.warnings = chosen_.left_out;
    results.programs_left_out = chosen_.programs_left_out;
    results.load_reality = scenarios::load_reality(scenario_);
    all.follows = scenario_.hosts.follows;
    RowSetting setting = row_setting(scenario_);
    setting.kind = ResultKind::kClockRuns;
    for (std::size_t pipeline = 0; pipeline < chosen_.choices.size(); ++pipeline) {
      std::vector<SeedScore> seeds;
      std::vector<StabilityCurves> curves;
      std::vector<HostTimeErrors> hosts;
      for (std::size_t job = pipeline; job < jobs_.size(); job += chosen_.choices.size()) {
        results.performance.events += jobs_[job].seed.cost.events;
        results.performance.simulated_seconds += jobs_[job].seed.cost.simulated_seconds;
        seeds.push_back(std::move(jobs_[job].seed));
        curves.push_back(std::move(jobs_[job].curves));
        hosts.push_back(std::move(jobs_[job].hosts));
      }
      all.readings.push_back(std::move(*jobs_[pipeline].readings));
      all.curves.push_back(pooled(curves));
      all.hosts.push_back(std::move(hosts));
      results.rows.push_back(
          make_row(chosen_.choices[pipeline].pipeline, std::move(seeds), setting));
    }
    return all;
  }

  const Scenario& scenario_;
  const ClockSourceFactory& make_source_;
  const ClockOptions& options_;
  const Progress& progress_;
  const Chosen chosen_;
  const std::vector<std::size_t> order_;  // in which the pipelines of a seed run
  PartProgress parts_;
  std::vector<Scored> jobs_;  // by seed, then pipeline; each written by one worker
  std::mutex mutex_;          // guards what follows
  std::uint64_t done_ = 0;
  CpuTime cpu_time_;
};

}  // namespace

HostTimeErrors host_medians(const std::vector<HostTimeErrors>& seeds) {
  HostTimeErrors medians;
  for (const auto list : {&HostTimeErrors::to_truth, &HostTimeErrors::pairs}) {
    for (std::size_t host = 0; host < (seeds.front().*list).size(); ++host) {
      std::vector<HostTe> of_host;
      of_host.reserve(seeds.size());
      for (const HostTimeErrors& seed : seeds) of_host.push_back((seed.*list)[host]);
      (medians.*list).push_back(median_te_of(of_host));
    }
  }
  return medians;
}

ClockResults evaluate_clocks(const Scenario& scenario, const ClockSourceFactory& make_source,
                             const ClockOptions& options, const Progress& progress) {
  check_clock_options(scenario, options);
  return ClockEvaluation(scenario, make_source, options, progress).run();
}

void check_clock_options(const Scenario& scenario, const ClockOptions& options) {
  if (options.duration_s > kLongestClockRunS) {
    throw scenarios::InputError(fmt::format("--duration-s: found {}, allowed: at most {}",
                                            options.duration_s, kLongestClockRunS));
  }
  if (options.from_s >= options.duration_s) {
    throw scenarios::InputError(
        fmt::format("--from-s: found {}, allowed: less than --duration-s, {}", options.from_s,
                    options.duration_s));
  }
  if (options.duration_s - options.from_s < kFewestReadings) {
    throw scenarios::InputError(
        fmt::format("--duration-s: found {}, allowed: at least {}, {} readings of a second behind "
                    "--from-s",
                    options.duration_s, options.from_s + kFewestReadings, kFewestReadings));
  }
  if (const Chosen chosen = choose_clock_runs(scenario, options.pipelines);
      chosen.choices.empty()) {
    throw scenarios::InputError(
        fmt::format("the scenario has no pipeline whose hosts run without cameras: {}",
                    fmt::join(chosen.left_out, "; ")));
  }
  if (scenario.hosts.count < 2) {
    throw scenarios::InputError(
        "/hosts/count: found 1, allowed with `clocks`: at least 2, a master "
        "and a slave");
  }
}

ClockPipelines clock_pipelines(const Scenario& scenario, const ClockOptions& options) {
  check_clock_options(scenario, options);
  Chosen chosen = choose_clock_runs(scenario, options.pipelines);
  ClockPipelines pipelines{.left_out = std::move(chosen.left_out)};
  for (const PipelineChoice& choice : chosen.choices) {
    pipelines.names.push_back(choice.pipeline.name);
  }
  return pipelines;
}

}  // namespace simbench::evaluation

#include "evaluation/run/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

#include "evaluation/run/capture_groups.h"
#include "evaluation/run/jobs.h"
#include "evaluation/run/part_progress.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/claims.h"
#include "evaluation/scoring/rows.h"
#include "recording/counted.h"
#include "scenarios/loader.h"
#include "scenarios/reality.h"

namespace simbench::evaluation {
namespace {

using scenarios::Scenario;

bool is_offline(const PipelineChoice& choice) {
  return choice.device_time.can_be_made() && choice.device_time.make()->offline();
}

// The sigma of the links' asymmetry where it is drawn for each of them alone, else 0.
double drawn_asymmetry_ms(const scenarios::Network& network) {
  const bool is_stated = std::ranges::any_of(
      network.links, [](const scenarios::Link& link) { return link.asymmetry_ms.has_value(); });
  return is_stated || network.port_asymmetry_sigma_ms > 0 ? 0 : network.asymmetry_sigma_ms;
}

}  // namespace

// The jobs of one evaluation and their results.
class EvaluationRun {
 public:
  EvaluationRun(const Scenario& scenario, std::vector<PipelineChoice> choices,
                const SourceFactory& make_source, const EvaluationOptions& options,
                const Progress& progress)
      : scenario_(scenario),
        make_source_(make_source),
        options_(options),
        progress_(progress),
        choices_(std::move(choices)),
        groups_(options.share_captures ? capture_groups(scenario, choices_)
                                       : single_captures(choices_)),
        order_(programs_first(groups_of_programs())) {}

  // Runs the seeds behind those that have run, until there are so many. Those that have run are in
  // `known`, with their pulses, or there are none.
  Results run_to(std::uint64_t seeds, Results known) {
    const std::uint64_t first = known.seed_count;
    take_back(std::move(known), seeds);
    whole_seeds_ = seeds_of_one_job(seeds - first);
    parts_.emplace(progress_,
                   part_plan(groups_of_programs(), seeds - first, worker_count(options_.jobs)));
    const auto begin = std::chrono::steady_clock::now();
    const auto wall_seconds = [begin] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    try {
      const bool finished = run_jobs_with_workers(
          whole_seeds_ + (seeds - first - whole_seeds_) * groups_.size(),
          {.threads = options_.jobs, .cancel = options_.cancel}, [this, first]() -> Job {
            return
                [this, first,
                 worker = std::make_shared<TimedWorker<RecordingSource>>(cpu_time_, make_source_)](
                    std::size_t job) { run_job(job, first, *worker->source); };
          });
      if (!finished) throw EvaluationCancelled("cancelled", results(wall_seconds()));
    } catch (const RecordingCancelled&) {
      throw EvaluationCancelled("cancelled", results(wall_seconds()));
    } catch (const JobFailed& failure) {
      throw EvaluationFailed(failure.what(), results(wall_seconds()));
    }
    Results all = results(wall_seconds());
    all.claims = check_claims(all.rows, scenario_.trigger.rate_hz);
    return all;
  }

 private:
  std::vector<bool> groups_of_programs() const {
    std::vector<bool> of_programs;
    for (const std::vector<std::size_t>& group : groups_) {
      of_programs.push_back(choices_[group.front()].pipeline.programs.has_value());
    }
    return of_programs;
  }

  // Makes room for the scores of so many seeds, the first of which are in `known`.
  void take_back(Results known, std::uint64_t seeds) {
    seeds_ = seeds;
    scores_.assign(choices_.size() * seeds, std::nullopt);
    for (std::size_t pipeline = 0; pipeline < known.rows.size(); ++pipeline) {
      for (SeedScore& score : known.rows[pipeline].seeds) {
        const std::uint64_t number = score.seed - options_.first_seed;
        scores_[number * choices_.size() + pipeline] = std::move(score);
      }
    }
    done_ = choices_.size() * known.seed_count;
  }

  // How many of these seeds, from the first on, are a job each. A source makes once for a seed what
  // its runs share, so one thread runs them all; the last seeds keep all threads busy until the
  // end. Runs of programs, which take long, are jobs of their own.
  std::uint64_t seeds_of_one_job(std::uint64_t seeds) const {
    const std::uint64_t shared_out = worker_count(options_.jobs);
    const std::vector<bool> of_programs = groups_of_programs();
    const bool has_programs = std::ranges::find(of_programs, true) != of_programs.end();
    return has_programs || seeds < shared_out ? 0 : seeds - shared_out;
  }

  // Runs are numbered seed by seed, from the seed number `first` on. Jobs begin in their order, so
  // that the remaining time follows from the elapsed time.
  void run_job(std::size_t job, std::uint64_t first, RecordingSource& source) {
    if (job >= whole_seeds_) {
      return run_group(whole_seeds_ * groups_.size() + job - whole_seeds_, first, source);
    }
    for (std::size_t group = 0; group < groups_.size(); ++group) {
      if (options_.cancel != nullptr && *options_.cancel) throw RecordingCancelled();
      run_group(job * groups_.size() + group, first, source);
    }
  }

  // A capture and the scores of its pipelines.
  void run_group(std::size_t number_of_run, std::uint64_t first, RecordingSource& source) {
    const std::vector<std::size_t>& group = groups_[order_[number_of_run % groups_.size()]];
    const std::uint64_t number = first + number_of_run / groups_.size();
    const std::uint64_t seed = options_.first_seed + number;
    SharedCapture capture(scenario_, choices_, group, seed, options_.certify);
    parts_->begin(number_of_run);
    capture.record(source, parts_->share_of(number_of_run));
    parts_->end(number_of_run);
    for (std::size_t member = 0; member < group.size(); ++member) {
      std::optional<SeedScore>& score = scores_[number * choices_.size() + group[member]];
      run_named({scenario_.name, choices_[group[member]].pipeline.name, seed}, [&] {
        try {
          score = capture.score(member);
        } catch (const RecordingFailed& failure) {
          score = missing_score(seed, failure.what());
        }
      });
      const std::lock_guard lock(mutex_);
      ++done_;
      if (progress_) progress_(done_, scores_.size());
    }
  }

  // Returns the results of the finished jobs, and moves their scores there.
  Results results(double wall_seconds) {
    Results results;
    results.scenario = scenario_.name;
    results.ranked_by = ranked_by(scenario_.evaluation.table);
    results.loss_reasons = loss_reasons(scenario_);
    results.load_reality = scenarios::load_reality(scenario_);
    results.derivation = scenario_.derivation;
    results.draws_load = scenario_.draws_load();
    results.first_seed = options_.first_seed;
    results.seed_count = seeds_;
    results.asymmetry_floor =
        asymmetry_floor(drawn_asymmetry_ms(scenario_.network), scenario_.hosts.count);
    for (std::size_t pipeline = 0; pipeline < choices_.size(); ++pipeline) {
      results.rows.push_back(row(pipeline));
    }
    results.published_figures = compare_figures(scenario_.published_figures, results.rows);
    for (const std::vector<std::size_t>& group : groups_) {
      add_cost(results.rows[group.front()], results.performance);
    }
    add_genlock_warning(results);
    Performance& performance = results.performance;
    performance.cpu_seconds = cpu_time_.seconds();
    performance.wall_seconds = wall_seconds;
    performance.events_per_second = static_cast<double>(performance.events) / wall_seconds;
    performance.simulated_seconds_per_second = performance.simulated_seconds / wall_seconds;
    return results;
  }

  Row row(std::size_t pipeline) {
    const RowSetting setting = row_setting(scoring_scenario(scenario_, choices_[pipeline]));
    std::vector<SeedScore> seeds;
    for (std::size_t at = pipeline; at < scores_.size(); at += choices_.size()) {
      if (scores_[at]) seeds.push_back(std::move(*scores_[at]));
    }
    Row row = make_row(choices_[pipeline].pipeline, std::move(seeds), setting);
    row.offline = is_offline(choices_[pipeline]);
    const auto published = scenario_.published.find(row.pipeline);
    if (published != scenario_.published.end()) {
      row.published = compare(published->second, row, setting);
    }
    for (SeedScore& seed : row.seeds) {
      if (!options_.keep_pulses) seed.pulses = {};
    }
    return row;
  }

  static void add_cost(const Row& row, Performance& performance) {
    for (const SeedScore& seed : row.seeds) {
      performance.events += seed.cost.events;
      performance.simulated_seconds += seed.cost.simulated_seconds;
    }
  }

  // One warning for all pipelines: they see the same frames.
  static void add_genlock_warning(Results& results) {
    std::int64_t errors = 0;
    std::vector<std::uint64_t> seeds;
    for (const Row& row : results.rows) {
      for (const SeedScore& seed : row.seeds) {
        if (seed.frames.dropped > 0) continue;
        errors = std::max(errors, seed.genlock_index_errors);
        if (seed.genlock_index_errors > 0) seeds.push_back(seed.seed);
      }
    }
    if (seeds.empty()) return;
    std::sort(seeds.begin(), seeds.end());
    seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
    results.warnings.push_back(fmt::format(
        "GenLock order differs from the pulses of up to {} a run, in {} of {}, "
        "though no evaluated frame was lost; did all cameras start with the same pulse?",
        counted(errors, "frame"), seeds.size(), counted(results.seed_count, "seed")));
  }

  const Scenario& scenario_;
  const SourceFactory& make_source_;
  const EvaluationOptions& options_;
  const Progress& progress_;
  const std::vector<PipelineChoice> choices_;
  const CaptureGroups groups_;
  const std::vector<std::size_t> order_;  // in which the groups of a seed run
  std::uint64_t whole_seeds_ = 0;         // that are a job each
  std::optional<PartProgress> parts_;
  std::uint64_t seeds_ = 0;  // of the rows
  // By seed, then by choice; each written by one worker.
  std::vector<std::optional<SeedScore>> scores_;
  std::mutex mutex_;  // guards what follows
  std::size_t done_ = 0;
  CpuTime cpu_time_;
};

Results evaluate(const Scenario& scenario, const SourceFactory& make_source,
                 const EvaluationOptions& options, const Progress& progress) {
  return evaluate_choices(scenario, choose_pipelines(scenario, options.pipelines), make_source,
                          options, progress);
}

Results evaluate_choices(const Scenario& scenario, std::vector<PipelineChoice> choices,
                         const SourceFactory& make_source, const EvaluationOptions& options,
                         const Progress& progress) {
  if (options.certify) check_certifiable(scenario);
  return EvaluationRun(scenario, std::move(choices), make_source, options, progress)
      .run_to(options.seeds, {});
}

GrowingEvaluation::GrowingEvaluation(const Scenario& scenario, SourceFactory make_source,
                                     EvaluationOptions options)
    : make_source_(std::move(make_source)), options_(std::move(options)) {
  options_.keep_pulses = true;
  run_ = std::make_unique<EvaluationRun>(scenario, choose_pipelines(scenario, options_.pipelines),
                                         make_source_, options_, progress_);
}
GrowingEvaluation::~GrowingEvaluation() = default;

const Results& GrowingEvaluation::up_to(std::uint64_t seeds) {
  if (seeds > results_.seed_count) results_ = run_->run_to(seeds, std::move(results_));
  return results_;
}

void check_pipelines(const Scenario& scenario) { choose_pipelines(scenario, {}); }

}  // namespace simbench::evaluation

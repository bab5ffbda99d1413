#include "evaluation/run/evaluate.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/claims.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "evaluation/scoring/rows.h"
#include "recording/version.h"

namespace simbench::evaluation {
namespace {

using scenarios::Scenario;

double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

bool is_offline(const PipelineChoice& choice) {
  return choice.device_time.make &&
         choice.device_time.make(choice.device_time_parameters)->offline();
}

// The jobs of one evaluation and what has come of them.
class Evaluation {
 public:
  Evaluation(const Scenario& scenario, const SourceFactory& make_source,
             const EvaluationOptions& options, const Progress& progress)
      : scenario_(scenario),
        make_source_(make_source),
        options_(options),
        progress_(progress),
        choices_(choose_pipelines(scenario, options.pipelines)),
        scores_(choices_.size() * options.seeds) {}

  Results run() {
    const auto begin = std::chrono::steady_clock::now();
    run_workers();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    if (source_error_) std::rethrow_exception(source_error_);
    if (!failure_.empty()) throw EvaluationFailed(failure_, results(wall.count()));
    if (done_ < scores_.size()) throw EvaluationCancelled("cancelled", results(wall.count()));
    Results all = results(wall.count());
    all.claims = check_claims(all.rows, scenario_.trigger.rate_hz);
    return all;
  }

 private:
  // Jobs of one seed are neighbours, so that the time left can be told from the time gone.
  std::size_t pipeline_of(std::size_t job) const { return job % choices_.size(); }
  std::uint64_t seed_of(std::size_t job) const {
    return options_.first_seed + job / choices_.size();
  }

  void run_workers() {
    unsigned workers = options_.jobs > 0 ? options_.jobs : std::thread::hardware_concurrency();
    workers = static_cast<unsigned>(
        std::clamp<std::size_t>(workers, 1, std::max<std::size_t>(scores_.size(), 1)));
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < workers; ++i) threads.emplace_back([this] { work(); });
    work();
  }

  void work() {
    const double begin = thread_cpu_seconds();
    try {
      const std::unique_ptr<RecordingSource> source = make_source_();
      for (std::size_t job = next(); job < scores_.size(); job = next()) run_job(job, *source);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      if (!source_error_) source_error_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    cpu_seconds_ += thread_cpu_seconds() - begin;
  }

  std::size_t next() {
    const bool cancelled = options_.cancel != nullptr && options_.cancel->load();
    return stop_ || cancelled ? scores_.size() : next_++;
  }

  void run_job(std::size_t job, RecordingSource& source) {
    const PipelineChoice& choice = choices_[pipeline_of(job)];
    const std::uint64_t seed = seed_of(job);
    try {
      scores_[job] = score_of(choice, seed, source);
    } catch (const RecordingFailed& failure) {
      scores_[job] = missing_score(seed, failure.what());
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      if (failure_.empty() || job < failed_job_) {
        failed_job_ = job;
        failure_ =
            fmt::format("{}, pipeline {}, seed {}: {} (simbench {}, commit {})", scenario_.name,
                        choice.pipeline.name, seed, error.what(), version(), commit());
      }
      return;
    }
    const std::lock_guard lock(mutex_);
    ++done_;
    if (progress_) progress_(done_, scores_.size());
  }

  SeedScore score_of(const PipelineChoice& choice, std::uint64_t seed,
                     RecordingSource& source) const {
    PipelineScorer scorer(scorer_setup(scenario_, choice));
    const std::unique_ptr<HostSync> host_sync = choice.host_sync.make(choice.host_sync_parameters);
    const RecordingCost cost = source.record(
        {.seed = seed, .pipeline = choice.pipeline.name, .host_sync = host_sync.get()}, scorer);
    SeedScore score = scorer.finish();
    score.seed = seed;
    score.cost = cost;
    return score;
  }

  // Of the jobs that are done; takes their scores.
  Results results(double wall_seconds) {
    Results results;
    results.scenario = scenario_.name;
    results.first_seed = options_.first_seed;
    results.seed_count = options_.seeds;
    results.asymmetry_floor =
        asymmetry_floor(scenario_.network.asymmetry_sigma_ms, scenario_.hosts.count);
    const RowSetting setting = row_setting(scenario_);
    for (std::size_t pipeline = 0; pipeline < choices_.size(); ++pipeline) {
      results.rows.push_back(row(pipeline, setting));
      add_cost(results.rows.back(), results.performance);
    }
    add_genlock_warning(results);
    Performance& performance = results.performance;
    performance.cpu_seconds = cpu_seconds_;
    performance.wall_seconds = wall_seconds;
    performance.events_per_second = static_cast<double>(performance.events) / wall_seconds;
    performance.simulated_seconds_per_second = performance.simulated_seconds / wall_seconds;
    return results;
  }

  Row row(std::size_t pipeline, const RowSetting& setting) {
    std::vector<SeedScore> seeds;
    for (std::size_t job = pipeline; job < scores_.size(); job += choices_.size()) {
      if (scores_[job]) seeds.push_back(std::move(*scores_[job]));
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
        "GenLock order differs from the pulses of up to {} frames a run, in {} of {} seeds, though "
        "no evaluated frame was lost; did all cameras start with the same pulse?",
        errors, seeds.size(), results.seed_count));
  }

  const Scenario& scenario_;
  const SourceFactory& make_source_;
  const EvaluationOptions& options_;
  const Progress& progress_;
  const std::vector<PipelineChoice> choices_;
  std::vector<std::optional<SeedScore>> scores_;  // by job; each written by one worker
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;  // guards what follows
  std::size_t done_ = 0;
  double cpu_seconds_ = 0;
  std::exception_ptr source_error_;
  std::size_t failed_job_ = 0;
  std::string failure_;
};

}  // namespace

Results evaluate(const Scenario& scenario, const SourceFactory& make_source,
                 const EvaluationOptions& options, const Progress& progress) {
  return Evaluation(scenario, make_source, options, progress).run();
}

void check_pipelines(const Scenario& scenario) { choose_pipelines(scenario, {}); }

}  // namespace simbench::evaluation

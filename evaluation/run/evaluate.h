// Many seeds, many pipelines, all cores: from a scenario and a backend to Results.
//
// Each (pipeline, seed) is one run: one recording, streamed into a scorer. In a simulated world
// pipelines whose captures would be the same (evaluation/run/capture_groups.h) can share one, and
// with it a run; Results::performance counts it once. Runs are jobs on `jobs` threads, those of a
// seed one job together while there are seeds enough for all threads; results do not depend on
// their number, nor on what is shared. A job that throws ends the evaluation after the
// running jobs have finished; the error holds the finished jobs (EvaluationFailed). A capture that
// could not be made (RecordingFailed) is no failure of the evaluation: its seed is missing from its
// row, whose notes have the reason and the notes of other captures (RecordingCost::notes).
//
// With one thread the source is called in order: every pipeline at the first seed, then at the
// next; of one seed, those of real programs first.
//
//   Results r = evaluate(scenario, [&] { return make_simulation(scenario); },
//                        {.seeds = 32, .share_captures = true}, nullptr);
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "evaluation/certificates/assumptions.h"
#include "evaluation/run/pipeline_choice.h"
#include "evaluation/scoring/results.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct EvaluationOptions {
  // The seed of the first run; the others count up from it.
  std::uint64_t first_seed = 1;
  // How many runs each pipeline has.
  std::uint64_t seeds = 32;
  // The number of threads; 0: as many as there are cores.
  unsigned jobs = 0;
  // The pipelines to run, by name and in this order; empty: all of the scenario.
  std::vector<std::string> pipelines{};
  // Whether rows keep SeedScore::pulses, which frames.csv needs.
  bool keep_pulses = false;
  // Whether pipelines that the source records alike share a capture.
  bool share_captures = false;
  // Under what each capture's sets are certified (SeedScore::certified_ms); empty: they are not,
  // which costs a quarter of a second for 20,000 frames.
  std::optional<Assumptions> certify{};
  // A flag that is polled before each run; once true, no further run begins. A signal handler may
  // set it.
  const std::atomic<bool>* cancel = nullptr;
};

// How far runs are, and how long the rest takes by the speed that was measured until then
// (part_progress.h).
struct PartDone {
  double done = 0;  // runs, those under way by the share of their time that is over
  std::uint64_t total = 0;
  double left_s = kNan;  // NaN: too little was measured
};

// Told how many runs are done. Called from worker threads, one call at a time; must not throw.
class ProgressCallback : public std::function<void(std::uint64_t done, std::uint64_t total)> {
 public:
  using function::function;
  // Also told in between, where real programs run: one run of theirs may take minutes. Empty:
  // nobody asks.
  std::function<void(const PartDone&)> on_part{};
};
using Progress = ProgressCallback;
// Makes the backend of one worker thread; called once per thread, from that thread.
using SourceFactory = std::function<std::unique_ptr<RecordingSource>()>;
// Makes the backend for a scenario, which outlives it; called from worker threads.
using WorldFactory = std::function<std::unique_ptr<RecordingSource>(const scenarios::Scenario&)>;

// An evaluation that did not finish, with its results until then.
class EvaluationFailed : public std::runtime_error {
 public:
  EvaluationFailed(const std::string& what, Results finished)
      : std::runtime_error(what), finished_(std::make_shared<const Results>(std::move(finished))) {}
  // Rows of the finished seeds; rows may have different seeds, and there are no claims.
  const Results& finished() const { return *finished_; }

 private:
  std::shared_ptr<const Results> finished_;
};

// An evaluation that EvaluationOptions::cancel ended.
class EvaluationCancelled final : public EvaluationFailed {
 public:
  using EvaluationFailed::EvaluationFailed;
};

// Throws scenarios::InputError for an unknown pipeline or algorithm, a parameter that its algorithm
// does not have or allow, or a world that its backend refuses; EvaluationCancelled;
// EvaluationFailed if a job failed, with scenario, pipeline, seed, version and commit in its
// message; and what make_source throws.
Results evaluate(const scenarios::Scenario& scenario, const SourceFactory& make_source,
                 const EvaluationOptions& options, const Progress& progress);

// Evaluates pipelines already chosen, possibly changed (PipelineChoice::view), in place of those
// that the options name.
Results evaluate_choices(const scenarios::Scenario& scenario, std::vector<PipelineChoice> choices,
                         const SourceFactory& make_source, const EvaluationOptions& options,
                         const Progress& progress);

// An evaluation that goes on: up_to(n) is what evaluate() with n seeds and their pulses is, but
// that it runs the seeds alone that it has not run yet. /performance is of the last call.
//
// Throws what evaluate() throws; after that it is of no use.
//
//   GrowingEvaluation growing(scenario, [&] { return make_simulation(scenario); }, {});
//   for (std::uint64_t seeds = 8; seeds < 100; seeds *= 2) use(growing.up_to(seeds));
class GrowingEvaluation {
 public:
  // `scenario` outlives it. EvaluationOptions::seeds and keep_pulses do not count.
  GrowingEvaluation(const scenarios::Scenario& scenario, SourceFactory make_source,
                    EvaluationOptions options);
  ~GrowingEvaluation();
  GrowingEvaluation(const GrowingEvaluation&) = delete;
  GrowingEvaluation& operator=(const GrowingEvaluation&) = delete;

  // Fewer seeds than before are as many as before. The results are valid until the next call.
  const Results& up_to(std::uint64_t seeds);

 private:
  SourceFactory make_source_;
  EvaluationOptions options_;
  Progress progress_;
  std::unique_ptr<class EvaluationRun> run_;
  Results results_;
};

// Checks that every pipeline of the scenario names known algorithms with allowed parameters.
void check_pipelines(const scenarios::Scenario& scenario);

}  // namespace simbench::evaluation

// Runs of the hosts' clocks alone, of many pipelines and seeds: `simbench clocks`.
//
// A row has the metrics of ResultKind::kClockRuns over the seeds, and the curves of stability
// pooled over slaves and seeds (clock_score.h). Without stated pipelines there is a row for each
// host_sync of the scenario, under the name of the first pipeline that has it; those that need
// frames or the trigger are left out, with a note.
//
// Results depend neither on the number of threads nor on other runs beside them.
//
// Errors: scenarios::InputError for what choose_pipelines() refuses, a span without four readings,
// an unknown pipeline, one that needs frames or the trigger; EvaluationFailed and
// EvaluationCancelled as of evaluate().
//
//   const ClockResults results = evaluate_clocks(
//       scenario, [&] { return sim::make_clock_simulation(scenario); },
//       {.duration_s = 36000, .from_s = 300, .seeds = 8}, nullptr);
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/clock_run/clock_cause.h"
#include "evaluation/clock_run/clock_score.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"
#include "recording/clock_source.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

// A year, the longest that the world runs, less what follows the loss of the master.
inline constexpr std::uint64_t kLongestClockRunS = 31'000'000;

struct ClockOptions {
  // The time from the cold start to the loss of the master.
  std::uint64_t duration_s = 36'000;
  // The time since the cold start from which spread, errors and stability count.
  std::uint64_t from_s = 300;
  // Whether the master is lost then, and what follows is simulated too. Without it there are
  // neither holdover nor recovery.
  bool loses_master = true;
  // The others are those of EvaluationOptions.
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 8;
  unsigned jobs = 0;
  std::vector<std::string> pipelines{};
  std::size_t pairs_with = 0;  // the host that HostTimeErrors::pairs are compared with
  const std::atomic<bool>* cancel = nullptr;
};

// By host, the master's first.
struct HostTimeErrors {
  std::vector<HostTe> to_truth{};
  std::vector<HostTe> pairs{};
};

struct ClockResults {
  Results results;                                   // of ResultKind::kClockRuns
  std::vector<StabilityCurves> curves{};             // by row
  std::vector<std::vector<HostTimeErrors>> hosts{};  // by row and seed; empty: of an archive
  std::vector<std::int64_t> follows{};    // whom each host follows; empty: all the master
  std::vector<ClockReadings> readings{};  // by row, of the first seed
  ClockCauses causes{};                   // of the best row, if somebody asked (clock_causes.h)
  std::string period_note{};              // who chose how long they run, a sentence; mostly empty
};

// Over the seeds, of which there is one at least.
HostTimeErrors host_medians(const std::vector<HostTimeErrors>& seeds);

using ClockSourceFactory = std::function<std::unique_ptr<ClockSource>()>;
// For a scenario, which outlives it; called from worker threads.
using ClockWorldFactory = std::function<std::unique_ptr<ClockSource>(const scenarios::Scenario&)>;

ClockResults evaluate_clocks(const scenarios::Scenario& scenario,
                             const ClockSourceFactory& make_source, const ClockOptions& options,
                             const Progress& progress);

// Refuses options as evaluate_clocks() does, before any work.
void check_clock_options(const scenarios::Scenario& scenario, const ClockOptions& options);

struct ClockPipelines {
  std::vector<std::string> names{};     // of the rows, in their order
  std::vector<std::string> left_out{};  // a note on each
};

// Which pipelines evaluate_clocks() runs. Throws as check_clock_options().
ClockPipelines clock_pipelines(const scenarios::Scenario& scenario, const ClockOptions& options);

}  // namespace simbench::evaluation

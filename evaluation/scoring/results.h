// What an evaluation found: a score per seed and pipeline, and the table made of them.
//
// Definitions: docs/design.md section 8. Units in the names. A quantity that does not exist (0/0,
// no truth, no evaluated frame, no recording) is NaN here and null in JSON; it is left out of
// medians and bands.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algorithms/gathering/gathering.h"
#include "evaluation/scoring/asymmetry_floor.h"
#include "evaluation/scoring/metrics.h"
#include "evaluation/scoring/published_figures.h"
#include "evaluation/scoring/ranked_by.h"
#include "recording/recording.h"
#include "scenarios/derivation.h"

namespace simbench::evaluation {

// The source of the knowledge which frames belong together.
enum class GroundTruth : std::uint8_t {
  kSimulation,    // frames came with their truth
  kGenlockOrder,  // the order of the sensor stamps in a genlock capture
  kNone,          // unknown: scores are over gathered sets (unverified_scores.h)
};

// One evaluated pulse, as in frames.csv; one set of an unverified capture.
struct PulseScore {
  std::int64_t pulse = 0;  // in an unverified capture the set's number
  // Max - min of the global stamps, this pulse's term of AMD, and that of RMDV. NaN of a single
  // camera.
  double spread_ms = kNan;
  double deviation_ms = kNan;
};

// One pipeline, one seed (on a real rig: one repetition).
struct SeedScore : MetricValues<double> {
  std::uint64_t seed = 0;
  // False: no capture could be made (cost.notes states why), and there is no score.
  bool recorded = true;
  GroundTruth ground_truth = GroundTruth::kSimulation;
  double emission_latency_max_ms = kNan;
  FrameCounts frames;
  SetCounts sets;
  // Frames whose place in GenLock order differs from their pulse; genlock only.
  std::int64_t genlock_index_errors = 0;
  std::vector<PulseScore> pulses;      // with EvaluationOptions::keep_pulses
  std::vector<double> host_errors_ms;  // signed mean over the evaluated pulses, per host
  std::vector<SyncOutcome> failures;   // of host synchronisation, only those not synchronised
  // Real programs that ended; where there is one the seed has no values (program_failures.h).
  std::vector<ProgramFailure> program_failures{};
  std::optional<PlaceSearch> search{};    // of a gatherer that looks for places in a code
  std::vector<SessionDelays> sessions{};  // the last pass of each slave that reported one, by host
  RecordingCost cost;
};

struct PublishedComparison {
  double amd_ms = 0;
  double rmdv_ms = 0;
  bool rmdv_attainable = false;  // rmdv_ms <= bound * amd_ms, the bound of eq. (4)
  Percentile amd_percentile;
  Percentile rmdv_percentile;
};

struct SeedProgramFailure {
  std::uint64_t seed = 0;
  ProgramFailure failure{};
};

// One pipeline over all seeds; metrics: evaluation/scoring/metrics.h.
struct Row : MetricValues<Series>, PooledValues, RunCounts {
  std::string pipeline;
  std::string host_sync;
  std::string capture_alignment;  // empty: none
  std::string device_time;
  std::string gathering;
  bool is_of_programs = false;  // its host_sync is real programs
  std::string model;            // then: the pipeline that models them; empty: none
  // In all seeds, in their order: the row has failed.
  std::vector<SeedProgramFailure> program_failures{};
  bool offline = false;  // device_time needs the whole recording
  // The weakest of the seeds that were recorded; kNone if none was.
  GroundTruth ground_truth = GroundTruth::kSimulation;
  bool verified() const { return ground_truth != GroundTruth::kNone; }
  FrameCounts frames;  // these and the sets: over all seeds
  SetCounts sets;
  std::optional<PlaceSearch> search{};  // of all seeds together
  std::optional<PublishedComparison> published;
  std::vector<std::string> notes;  // failures, a line each: "repetition 3: ..."
  std::vector<SeedScore> seeds;
};

inline std::vector<const Row*> pointers_to(const std::vector<Row>& rows) {
  std::vector<const Row*> pointers;
  pointers.reserve(rows.size());
  for (const Row& row : rows) pointers.push_back(&row);
  return pointers;
}

struct Claim {
  std::string id;                        // "C1" ... "C12", docs/reference/paper.md section 11
  std::string text;                      // with its threshold
  std::optional<double> holds_fraction;  // of seeds; nothing if it needs another scenario
  std::string needs;                     // then: which
  std::uint64_t decided_seeds = 0;       // those that have all its quantities
};

struct Performance {
  std::uint64_t events = 0;
  double simulated_seconds = 0;
  double cpu_seconds = 0;  // of all workers
  double wall_seconds = 0;
  double events_per_second = 0;  // of wall time, all workers together
  double simulated_seconds_per_second = 0;
};

// The row of a pipeline; null if there is none.
inline const Row* find_row(std::span<const Row> rows, std::string_view pipeline) {
  for (const Row& row : rows) {
    if (row.pipeline == pipeline) return &row;
  }
  return nullptr;
}

// What part of a clock run is measured.
struct ClockPeriod {
  std::uint64_t from_s = 0;
  std::uint64_t duration_s = 0;
  friend bool operator==(const ClockPeriod&, const ClockPeriod&) = default;
};

struct Results {
  ResultKind kind = ResultKind::kCaptures;
  RankedBy ranked_by = RankedBy::kAmd;  // ranking_of() has what is
  ClockPeriod clock_period{};           // of clock runs
  std::string scenario;
  scenarios::Derivation derivation{};  // of that scenario
  bool draws_load = false;             // of each pipeline, Scenario::draws_load()
  std::uint64_t first_seed = 1;
  std::uint64_t seed_count = 0;
  std::vector<Row> rows;
  std::vector<FigureComparison> published_figures{};
  std::vector<Claim> claims;
  std::optional<AsymmetryFloor> asymmetry_floor;  // if the scenario's links are asymmetric
  std::vector<std::string> warnings;
  // Pipelines of real programs that cannot run here and have no row; warnings say why.
  std::vector<std::string> programs_left_out{};
  std::vector<std::string> loss_reasons{};  // why pulses are lost: scenarios::loss_reasons()
  std::vector<std::string> load_reality{};  // scenarios::load_reality()
  Performance performance;
};

}  // namespace simbench::evaluation

// What an evaluation found: a score per seed and pipeline, and the table made of them.
//
// Definitions: docs/design.md section 8. Units in the names. A quantity that does not exist (0/0,
// no truth, no evaluated frame, no recording) is NaN here and null in JSON; it is left out of
// medians and bands.
#ifndef SIMBENCH_EVALUATION_SCORING_RESULTS_H_
#define SIMBENCH_EVALUATION_SCORING_RESULTS_H_

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/asymmetry_floor.h"
#include "recording/recording.h"

namespace simbench::evaluation {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// How it is known which frames belong together.
enum class GroundTruth : std::uint8_t {
  kSimulation,    // frames came with their truth
  kGenlockOrder,  // the order of the sensor stamps in a genlock capture
  kNone,          // not at all: scores are over gathered sets (unverified_scores.h)
};

// One evaluated pulse, as frames.csv has it; one set of an unverified capture.
struct PulseScore {
  std::int64_t pulse = 0;   // of an unverified capture: the set's number
  double spread_ms = 0;     // max - min of the global stamps: this pulse's term of AMD
  double deviation_ms = 0;  // this pulse's term of RMDV
};

struct FrameCounts {
  std::int64_t expected = 0;  // evaluated pulses x sources; unverified: by the cameras' counters
  std::int64_t delivered = 0;
  std::int64_t dropped = 0;
};

// Sets count if one of their members is among the evaluated pulses.
struct SetCounts {
  std::int64_t emitted = 0;          // complete sets
  std::int64_t pure = 0;             // of those, all members from one pulse
  std::int64_t complete_pulses = 0;  // evaluated pulses that all sources delivered
  std::int64_t discarded_frames = 0;
  std::int64_t partial = 0;       // sets that lack a source
  std::int64_t index_errors = 0;  // members of emitted sets that are not of most members' pulse
};

// One pipeline, one seed (on a real rig: one repetition).
struct SeedScore {
  std::uint64_t seed = 0;
  // False: no capture could be made (cost.notes says why), and there is no score at all.
  bool recorded = true;
  GroundTruth ground_truth = GroundTruth::kSimulation;
  double amd_ms = 0;
  double rmdv_ms = 0;
  double absolute_error_ms = 0;
  double bias_ms = 0;
  double host_error_ms = 0;
  double exposure_spread_ms = 0;
  // Over the complete sets that gathering emitted; NaN: it emitted none (or there is no truth).
  double set_amd_ms = kNan;  // mean range of a set's stamps
  double set_absolute_error_ms = kNan;
  // From the last member's arrival to that of the frame which made the gatherer emit.
  double emission_latency_ms = kNan;  // mean over these sets
  double emission_latency_max_ms = kNan;
  // Beyond the table; the paper's claims rest on these.
  double offline_amd_ms = 0;  // AMD of regression_offline over the same recording; NaN if not asked
  double spread_in_host_ms = 0;        // mean over pulses and hosts of the range inside one host
  double spread_between_hosts_ms = 0;  // mean over pulses of the range of the hosts' means
  double trend_ms = 0;                 // change of the spread over the recording, by least squares
  double share_below_half_period = 0;  // of evaluated pulses whose spread is under half a period
  FrameCounts frames;
  SetCounts sets;
  // Frames whose place in GenLock order is not that of the pulse that exposed them; genlock only.
  std::int64_t genlock_index_errors = 0;
  std::vector<PulseScore> pulses;      // if asked for
  std::vector<double> host_errors_ms;  // signed mean over the evaluated pulses, per host
  std::vector<SyncOutcome> failures;   // of host synchronisation, only those not synchronised
  RecordingCost cost;
};

// Values in seed order, with the median and the 5-95 % band of those that exist.
struct Series {
  std::vector<double> values;
  double median = 0;
  double p05 = 0;
  double p95 = 0;
};

// A fraction of seeds with its 95 % binomial interval (Clopper-Pearson).
struct Percentile {
  double percent = 0;
  double low = 0;
  double high = 0;
};

struct PublishedComparison {
  double amd_ms = 0;
  double rmdv_ms = 0;
  bool amd_inside = false;  // between the 5 % and the 95 % quantile of the seeds
  bool rmdv_inside = false;
  bool rmdv_attainable = false;  // rmdv_ms <= bound * amd_ms, the bound of eq. (4)
  Percentile amd_percentile;
  Percentile rmdv_percentile;
};

// One pipeline over all seeds.
struct Row {
  std::string pipeline;
  std::string host_sync;
  std::string device_time;
  std::string gathering;
  bool offline = false;  // device_time needs the whole recording
  // The weakest of the seeds that were recorded; kNone if none was.
  GroundTruth ground_truth = GroundTruth::kSimulation;
  bool verified() const { return ground_truth != GroundTruth::kNone; }
  Series amd_ms;
  Series rmdv_ms;
  Series absolute_error_ms;
  Series bias_ms;
  Series host_error_ms;
  Series exposure_spread_ms;
  double precision = 0;  // over all seeds
  double recall = 0;
  double margin_ms = 0;
  SetCounts sets;  // over all seeds
  Series seed_precision;
  Series seed_recall;
  Series set_amd_ms;
  Series set_absolute_error_ms;
  Series emission_latency_ms;
  double emission_latency_max_ms = kNan;  // of all seeds
  FrameCounts frames;
  std::int64_t evaluated_pulses = 0;      // that the scores rest on; unverified: sets
  std::int64_t unsynchronised_hosts = 0;  // over all seeds
  std::optional<PublishedComparison> published;
  std::vector<std::string> notes;  // what went wrong, a line each: "repetition 3: ..."
  std::vector<SeedScore> seeds;
};

struct Claim {
  std::string id;                        // "C1" ... "C10", docs/reference/paper.md section 11
  std::string text;                      // with the threshold that decides it
  std::optional<double> holds_fraction;  // of seeds; nothing if it needs another scenario
  std::string needs;                     // which, then
};

struct Performance {
  std::uint64_t events = 0;
  double simulated_seconds = 0;
  double cpu_seconds = 0;  // of all workers
  double wall_seconds = 0;
  double events_per_second = 0;  // of wall time, all workers together
  double simulated_seconds_per_second = 0;
};

struct Results {
  std::string scenario;
  std::uint64_t first_seed = 1;
  std::uint64_t seed_count = 0;
  std::vector<Row> rows;
  std::vector<Claim> claims;
  std::optional<AsymmetryFloor> asymmetry_floor;  // if the scenario's links are asymmetric
  std::vector<std::string> warnings;
  Performance performance;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_RESULTS_H_
